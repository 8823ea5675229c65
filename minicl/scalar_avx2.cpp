/* scalar_avx2.cpp - every kernel one item at a time, for processors with AVX2: strips (shared/strip.h) are one
 * register. */
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <utility>

#include "minicl/kernel_table.h"
#include "shared/platform.h"

namespace tandem::scalar_avx2 {
#include "shared/kernels.h"
#include "minicl/kernel_range.h"
} // namespace tandem::scalar_avx2

namespace tandem::minicl {
#define FORM_ITEM(name) scalar_avx2::run_items<&scalar_avx2::name##_item>
#define FORM_LANES(name) scalar_avx2::run_items<&scalar_avx2::name##_item>
#define FORM_GROUP(name) scalar_avx2::run_groups<&scalar_avx2::name##_group>
#define FORM_HOST(name) nullptr
#define KERNEL(name, stage, form, items, feature, arguments) FORM_##form(name),
const KernelTable scalar_avx2_kernels = {1,
                                         {
#include "shared/kernels.def"
                                         }};
} // namespace tandem::minicl
