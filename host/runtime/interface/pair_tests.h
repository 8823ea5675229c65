/* pair_tests.h - the rows of shared/pairs.def for the host: the kernels that find the contacts of each kind of pair.
 * The pipeline launches them, and specialisation derives features from them. */
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "host/runtime/interface/features.h"
#include "host/runtime/interface/kernel_list.h"
#include "shared/body_codes.h"

namespace tandem {

namespace pair_kernels {
using enum Kernel;
constexpr std::nullopt_t NO_KERNEL = std::nullopt;
} // namespace pair_kernels

struct PairTest {
  uint32_t kind;                  /* PAIR_KIND_ */
  Features feature;               /* of scenes that have such pairs */
  std::string_view first, second; /* shapes, by their names in the rows */
  Kernel kernel;
  std::optional<Kernel> follower; /* of pairs marked TO_FOLLOW */
};

/* Indexed by kind. */
inline constexpr PairTest pair_tests[] = {
#define PAIR(kind, first, second, kernel, follower, what) \
  {PAIR_KIND_##kind, FEATURE_##kind, #first, #second, pair_kernels::kernel, pair_kernels::follower},
#include "shared/pairs.def"
#undef PAIR
};

} // namespace tandem
