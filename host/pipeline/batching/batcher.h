/* batcher.h - the ways to batch contacts, one small file each, of which `--batching NAME` selects one.
 *
 * A batcher launches kernels that give each touching pair a colour: pair_color below COLOR_LIMIT, or COLOR_OVERFLOW. At
 * its start all colours are COLOR_NONE, and the colours in use at each body (except those kept from the last step, if
 * the batcher keeps them) and the bids are cleared. It must leave COUNT_UNCOLORED at 0; otherwise too few rounds were
 * launched, and the step runs again with more. Sorting by colour and everything after it is the same for every batcher
 * (host/pipeline/step.cpp).
 */
#pragma once

#include <cstdint>
#include <span>

#include "host/pipeline/step_launches.h"

namespace tandem {

struct BatcherRow {
  Batching choice;
  const char *name;
  /* Whether the colours of the last step are kept, which is only for a batcher that can add to colours that it did not
   * choose in this step. The batches of the others follow from the contacts alone, and so do not depend on the history
   * of the simulation. */
  bool keeps_colors;
  void (*launch)(StepLaunches &step);
};

std::span<const BatcherRow> batchers(); /* in the order of the enum */
const BatcherRow &row_of(Batching batching);

/* Each is defined in the file of its name. */
void batch_by_coloring(StepLaunches &step);
void batch_in_sequence(StepLaunches &step);
void batch_in_single_group(StepLaunches &step);
void batch_by_iteration(StepLaunches &step);
void batch_in_two_stages(StepLaunches &step);

/* Checks the batches on the device and leaves the result in counts (shared/batching/check.h). */
void launch_check(StepLaunches &step);

/* The number of cells of a class for two-stage batching, a power of two: about one for every 512 bodies. */
uint32_t batch_cells_for(uint32_t bodies);

} // namespace tandem
