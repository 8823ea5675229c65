/* left_out.h - `tandem bench left-out`: what a scene saves by each feature of shared/features.def that it lacks, in
 * kernels, launches, bytes and milliseconds. */
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/bench/options.h"
#include "tools/bench/scenes.h"

namespace tandem {

struct WorldCost {
  uint64_t kernels = 0, bytes = 0;
  Spread launches{}, milliseconds{}; /* a step, over the timed ones */
};

struct LeftOut {
  std::string scene, feature;
  WorldCost without, with; /* the world as it is, and one that runs the feature all the same */
  std::string failure;     /* why there are no costs; empty if there are */
};

/* The features that scenes bring in, not the settings, by their names in shared/features.def. */
std::vector<std::string> scene_feature_names();

/* A row for each scene and feature that it lacks. The two worlds of a row make their steps in turn; one that fails, or
 * ends in other bits than the other, stops no other row. Throws InputError alone, for what is wrong with the request.
 */
std::vector<LeftOut> bench_left_out(const ScenesRequest &request);

std::vector<std::string> failures_of(const std::vector<LeftOut> &rows); /* a line each */
std::string left_out_text(const std::vector<LeftOut> &rows);
std::string left_out_markdown(const std::vector<LeftOut> &rows);
Json left_out_json(const std::vector<LeftOut> &rows);

/* The exit status is 1 if a row has no costs. */
int execute_left_out(const BenchOptions &options);

} // namespace tandem
