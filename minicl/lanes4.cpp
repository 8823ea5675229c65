/* lanes4.cpp - the LANES kernels, 4 items an instruction: SSE2 (every x86-64). */
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <utility>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "minicl/kernel_table.h"
#include "shared/platform.h"

#if 1
#define TANDEM_LANES 4
namespace tandem::lanes4 {
#include "minicl/lanes.h"
#include "shared/lanes_kernels.h"
#include "minicl/kernel_range.h"
} // namespace tandem::lanes4

namespace tandem::minicl {
#define FORM_ITEM(name) nullptr
#define FORM_LANES(name) lanes4::run_items<&lanes4::name##_item>
#define FORM_GROUP(name) nullptr
#define FORM_HOST(name) nullptr
#define KERNEL(name, stage, form, items, feature, arguments) FORM_##form(name),
const KernelTable lanes4_kernels = {4,
                                    {
#include "shared/kernels.def"
                                    }};
} // namespace tandem::minicl
#else
namespace tandem::minicl {
const KernelTable lanes4_kernels = {4, {}};
}
#endif
