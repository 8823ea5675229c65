/* lanes16.cpp - the LANES kernels, 16 items an instruction: AVX-512. */
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <utility>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "minicl/kernel_table.h"
#include "shared/platform.h"

#if defined(__AVX512F__)
#define TANDEM_LANES 16
namespace tandem::lanes16 {
#include "minicl/lanes.h"
#include "shared/lanes_kernels.h"
#include "minicl/kernel_range.h"
} // namespace tandem::lanes16

namespace tandem::minicl {
#define FORM_ITEM(name) nullptr
#define FORM_LANES(name) lanes16::run_items<&lanes16::name##_item>
#define FORM_GROUP(name) nullptr
#define FORM_HOST(name) nullptr
#define KERNEL(name, stage, form, items, feature, arguments) FORM_##form(name),
const KernelTable lanes16_kernels = {16,
                                     {
#include "shared/kernels.def"
                                     }};
} // namespace tandem::minicl
#else
namespace tandem::minicl {
const KernelTable lanes16_kernels = {16, {}};
}
#endif
