/* lanes8.cpp - the LANES kernels, 8 items an instruction: AVX2. */
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <utility>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "minicl/kernel_table.h"
#include "shared/platform.h"

#if defined(__AVX2__)
#define TANDEM_LANES 8
namespace tandem::lanes8 {
#include "minicl/lanes.h"
#include "shared/lanes_kernels.h"
#include "minicl/kernel_range.h"
} // namespace tandem::lanes8

namespace tandem::minicl {
#define FORM_ITEM(name) nullptr
#define FORM_LANES(name) lanes8::run_items<&lanes8::name##_item>
#define FORM_GROUP(name) nullptr
#define FORM_HOST(name) nullptr
#define KERNEL(name, stage, form, items, feature, arguments) FORM_##form(name),
const KernelTable lanes8_kernels = {8,
                                    {
#include "shared/kernels.def"
                                    }};
} // namespace tandem::minicl
#else
namespace tandem::minicl {
const KernelTable lanes8_kernels = {8, {}};
}
#endif
