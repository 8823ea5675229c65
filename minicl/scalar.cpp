/* scalar.cpp - the reference: every kernel one item at a time, as gdb steps it. */
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <utility>

#include "minicl/kernel_table.h"
#include "shared/platform.h"

namespace tandem::scalar {
#include "shared/kernels.h"
#include "minicl/kernel_range.h"
} // namespace tandem::scalar

namespace tandem::minicl {
#define FORM_ITEM(name) scalar::run_items<&scalar::name##_item>
#define FORM_LANES(name) scalar::run_items<&scalar::name##_item>
#define FORM_GROUP(name) scalar::run_groups<&scalar::name##_group>
#define FORM_HOST(name) nullptr
#define KERNEL(name, stage, form, items, feature, arguments) FORM_##form(name),
const KernelTable scalar_kernels = {1,
                                    {
#include "shared/kernels.def"
                                    }};
} // namespace tandem::minicl
