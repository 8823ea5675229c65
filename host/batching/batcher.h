/* batcher.h - the ways to batch contacts, one small file each: what `--batching NAME` picks.
 *
 * A batcher launches kernels that give each touching pair a colour: pair_color below COLOR_LIMIT, or COLOR_TAIL. It finds
 * them at COLOR_NONE, the colours in use at each body cleared (but for those kept from the last step, if it asked for
 * them) and bids cleared. It leaves COUNT_UNCOLORED at 0, or too few rounds were launched and the step runs again with
 * more. Sorting by colour, and all that comes after, is the same for every batcher (host/step.cpp).
 */
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/launcher.h"
#include "host/step.h"

namespace tandem {

struct Batcher {
  const char *name;
  /* Colours of the last step are kept. Only for a batcher that can add to colours it did not choose in this step; the
   * batches of the others follow from the contacts alone, so a step's batches do not hang on how it was reached. */
  bool keeps_colors;
  void (*launch)(Launcher &launcher, const StepPlan &plan);
};

std::span<const Batcher> batchers(); /* default first */
const Batcher &batcher_named(const std::string &name); /* std::logic_error if there is none: settings are validated */

/* Each in the file of its name. */
void batch_by_coloring(Launcher &launcher, const StepPlan &plan);
void batch_in_sequence(Launcher &launcher, const StepPlan &plan);
void batch_in_single_group(Launcher &launcher, const StepPlan &plan);
void batch_by_iteration(Launcher &launcher, const StepPlan &plan);
void batch_in_two_stages(Launcher &launcher, const StepPlan &plan);

/* A kernel over the range of its row, sized by what is known. */
void launch_kernel(Launcher &launcher, const StepPlan &plan, Kernel kernel, const std::vector<uint32_t> &values = {});

/* Proves the batches on the device: the verdict is in counts (shared/batching/check.h). */
void check_batches(Launcher &launcher, const StepPlan &plan);

/* Cells of a class for two-stage batching, a power of two: about one for each 512 bodies, as many as the bodies of one. */
uint32_t batch_cells_for(uint32_t bodies);

} // namespace tandem
