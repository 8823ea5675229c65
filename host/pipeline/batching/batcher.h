/* batcher.h - the ways to batch contacts, one small file each: what `--batching NAME` picks.
 *
 * A batcher launches kernels that give each touching pair a colour: pair_color below COLOR_LIMIT, or COLOR_OVERFLOW. It
 * finds them at COLOR_NONE, the colours in use at each body cleared (but for those kept from the last step, if it asked
 * for them) and bids cleared. It leaves COUNT_UNCOLORED at 0, or too few rounds were launched and the step runs again
 * with more. Sorting by colour, and all that comes after, is the same for every batcher (host/pipeline/step.cpp).
 */
#pragma once

#include <cstdint>
#include <span>

#include "host/pipeline/step_launches.h"

namespace tandem {

struct BatcherRow {
  Batching choice;
  const char *name;
  /* Colours of the last step are kept. Only for a batcher that can add to colours it did not choose in this step; the
   * batches of the others follow from the contacts alone, so a step's batches do not hang on how it was reached. */
  bool keeps_colors;
  void (*launch)(StepLaunches &step);
};

std::span<const BatcherRow> batchers(); /* in the order of the enum */
const BatcherRow &row_of(Batching batching);

/* Each in the file of its name. */
void batch_by_coloring(StepLaunches &step);
void batch_in_sequence(StepLaunches &step);
void batch_in_single_group(StepLaunches &step);
void batch_by_iteration(StepLaunches &step);
void batch_in_two_stages(StepLaunches &step);

/* Proves the batches on the device: the verdict is in counts (shared/batching/check.h). */
void launch_check(StepLaunches &step);

/* Cells of a class for two-stage batching, a power of two: about one for each 512 bodies, as many as the bodies of
 * one. */
uint32_t batch_cells_for(uint32_t bodies);

} // namespace tandem
