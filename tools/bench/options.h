/* options.h - what `tandem bench` was asked for, as each benchmark reads it. */
#pragma once

#include <string>
#include <vector>

#include "tools/command/output.h"

namespace tandem {

struct BenchOptions {
  std::string what, on = "tbb", count, steps, chart, table;
  std::vector<std::string> pairs, broadphases, scenes, beside;
  bool inexact = false, error = false;
  JsonOutput json;
};

/* The scenes of --scene, whose values commas part, as they part the parameters of a scene. */
std::vector<std::string> scenes_of_parts(const std::vector<std::string> &parts);

} // namespace tandem
