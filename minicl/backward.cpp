/* backward.cpp - the scalar kernels with the phases of work-groups walked in reverse: a race between items of
 * one phase shows as a difference between forward and backward, on the CPU alone. */
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <utility>

#define TANDEM_BACKWARD
#include "minicl/kernel_table.h"
#include "shared/platform.h"

namespace tandem::backward {
#include "shared/kernels.h"
#include "minicl/kernel_range.h"
} // namespace tandem::backward

namespace tandem::minicl {
#define FORM_ITEM(name) backward::run_items<&backward::name##_item>
#define FORM_LANES(name) backward::run_items<&backward::name##_item>
#define FORM_GROUP(name) backward::run_groups<&backward::name##_group>
#define FORM_HOST(name) nullptr
#define KERNEL(name, stage, form, items, feature, arguments) FORM_##form(name),
const KernelTable backward_kernels = {1,
                                      {
#include "shared/kernels.def"
                                      }};
} // namespace tandem::minicl
