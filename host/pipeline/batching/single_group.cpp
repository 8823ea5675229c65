/* single_group.cpp - the talks' naive batching: one work-group computes the same batches as sequential.cpp
 * (shared/batching/single_group.h). */
#include "host/pipeline/batching/batcher.h"

namespace tandem {

void batch_in_single_group(StepLaunches &step) { step.run(Kernel::color_in_group, {step.plan().rounds}); }

} // namespace tandem
