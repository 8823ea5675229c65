/* reference.cpp - the same kernels with `real` = double: the truth that float results are measured against.
 *
 * Nothing here is compared bit for bit. Types of memory are wider too (shared/platform.h), so they live in this
 * namespace, and buffers are kept by minicl/reference_storage.h. */
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <utility>

#include "minicl/kernel_table.h"
#include "minicl/reference_storage.h"

#define TANDEM_REFERENCE
namespace tandem::reference {
#include "shared/platform.h"
#include "shared/kernels.h"
#include "minicl/kernel_range.h"
} // namespace tandem::reference

namespace tandem::minicl {
const ParameterLayout reference_parameters = {
    offsetof(reference::Parameters, features) / sizeof(reference::memory_real), sizeof(reference::Parameters)};

#define FORM_ITEM(name) reference::run_items<&reference::name##_item>
#define FORM_LANES(name) reference::run_items<&reference::name##_item>
#define FORM_GROUP(name) reference::run_groups<&reference::name##_group>
#define FORM_HOST(name) nullptr
#define KERNEL(name, stage, form, items, feature, arguments) FORM_##form(name),
const KernelTable reference_kernels = {1,
                                       {
#include "shared/kernels.def"
                                       }};
} // namespace tandem::minicl
