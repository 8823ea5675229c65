/* no_body.h - the index where there is no body: what a query hits that hits nothing, a side of a joint that is the
 * world. */
#pragma once

#include <cstdint>

namespace tandem {

constexpr uint32_t no_body = 0xffffffffu;

} // namespace tandem
