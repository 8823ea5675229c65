/* sequential.cpp - greedy colouring by one item in the order of the list, the reference for tests of the other batchers
 * (shared/batching/coloring.h). */
#include "host/pipeline/batching/batcher.h"

namespace tandem {

void batch_in_sequence(StepLaunches &step) { step.run(Kernel::color_in_order); }

} // namespace tandem
