/* heap_cases.h - the worlds of the heap's tests: those in which other places are made to fail, and more, each with
 * short steps. */
#pragma once

#include <algorithm>
#include <vector>

#include "tests/host/runtime/interface/fault_scenes.h"

namespace tests::heap {

/* One pass of each kind: what differs are the kernels, not how often they run. */
inline tandem::Settings short_step(tandem::Settings settings)
{
  settings.substeps = 1;
  settings.iterations = std::min(settings.iterations, 2u);
  return settings;
}

inline std::vector<tandem::fault_scenes::Case> heap_cases()
{
  using namespace tandem;
  using fault_scenes::with;
  std::vector<fault_scenes::Case> all = fault_scenes::cases();
  all.push_back({"box-stack:n=4,height=1", with(Solver::direct, Broadphase::sap, true), "islands"});
  all.push_back({TANDEM_SOURCE_DIR "/tests/scenes/few_hulls.json", with(Solver::jacobi, Broadphase::brute_force, false),
                 "hulls, split masses"});
  all.push_back(
      {TANDEM_SOURCE_DIR "/tests/scenes/few_trees.json", with(Solver::soft_step, Broadphase::grid, true), "meshes"});
  for (fault_scenes::Case &c : all) c.settings = short_step(c.settings);
  return all;
}

} // namespace tests::heap
