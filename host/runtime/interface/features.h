/* features.h - the rows of features.def as sets of one feature, such as FEATURE_TREES, which the host tests and
 * unites, and their names. */
#pragma once

#include <limits>

#include <tandem/features.h>

#include "shared/features.h"

namespace tandem {

static_assert(FEATURE_COUNT <= std::numeric_limits<Features>::digits, "Parameters and Features hold a bit a feature");

constexpr Features feature_of_index(int index) { return Features{1} << index; }

constexpr Features FEATURE_ALWAYS = 0;
#define FEATURE(name, what) constexpr Features FEATURE_##name = feature_of_index(FEATURE_INDEX_##name);
#include "shared/features.def"
#undef FEATURE

struct FeatureRow {
  const char *name;
  const char *what; /* brings it in */
  Features feature;
};

constexpr FeatureRow feature_rows[] = {
#define FEATURE(name, what) {#name, what, FEATURE_##name},
#include "shared/features.def"
#undef FEATURE
};

/* Adds the features that others of these need. */
constexpr Features with_needs(Features features)
{
#define FEATURE(name, what)
#define FEATURE_NEEDS(feature, other) \
  if ((features & FEATURE_##feature) != 0) features |= FEATURE_##other;
#include "shared/features.def"
#undef FEATURE_NEEDS
#undef FEATURE
  return features;
}

} // namespace tandem
