/* parity.h - small scenes and the lockstep comparison for all parity tests. */
#pragma once

#include <string>
#include <vector>

#include <tandem/compare.h>

#include "host/base/random.h"
#include "host/catalog/catalog.h"
#include "host/runtime/interface/kernel_list.h"
#include "minicl/kernel_table.h"
#include "tests/catch.h"
#include "tests/host/runtime/opencl/pocl.h"

namespace tandem::parity {

/* One body of each convex shape, touching others from the first step on. */
inline std::string every_shape() { return TANDEM_SOURCE_DIR "/tests/scenes/every_shape.json"; }

/* Meshes and compounds on and beside one another. */
inline std::string few_trees() { return TANDEM_SOURCE_DIR "/tests/scenes/few_trees.json"; }

/* Balls that each lie on a compound of two balls: all pairs are of balls, and yet they touch at several points. */
inline std::string balls_on_compounds() { return TANDEM_SOURCE_DIR "/tests/scenes/balls_on_compounds.json"; }

/* One of each built-in scene. The grid has more pairs than a tile has items, so that scans and sorts cross tiles; the
 * others start low, so that they collide within the first steps. */
inline const std::vector<std::string> &small_scenes()
{
  static const std::vector<std::string> scenes = {
      "box-grid:nx=7,ny=6,nz=7",
      "falling-boxes:n=100,height=0",
      "box-stack:n=50",
      "pyramid:rows=8",
      "spheres:n=125,height=0,restitution=0.5",
      "mixed:n=100",
      "shapes:n=60",
      "convex-hulls:n=60",
      "rolling",
      every_shape(),
      "compounds:n=40",
      "hulls-on-mesh:n=40",
      few_trees(),
      "thin-wall:n=40",
      "bullet-stack:rows=2,height=3",
      balls_on_compounds(),
  };
  return scenes;
}

/* Rotating boxes that fly toward one centre: each step has hundreds of pairs more than the one before, and most are
 * followed. */
inline Scene imploding_boxes()
{
  constexpr int side = 9;
  Random random(5);
  Scene scene;
  scene.name = "imploding boxes";
  scene.shapes.push_back(box_shape(0.5f, 0.5f, 0.5f));
  for (int i = 0; i < side * side * side; ++i) {
    const Point at = {2.0 * (i % side) - side + 1, 2.0 * (i / side % side) - side + 1,
                      2.0 * (i / (side * side)) - side + 1};
    Body body;
    body.type = BodyType::dynamic;
    body.position = at;
    body.linear_velocity = {float(-9 * at[0]), float(-9 * at[1]), float(-9 * at[2])};
    for (float &spin : body.angular_velocity) spin = float(random.uniform(-9, 9));
    scene.bodies.push_back(body);
  }
  return scene;
}

/* The CPU backends that this processor can run: one for each order of items, then widths and threads. */
inline std::vector<std::string> cpu_backends()
{
  std::vector<std::string> backends = {"serial", "serial:order=backward", "serial:order=shuffled"};
  for (const char *threads : {"1", "2", "7"})
    for (const uint32_t lanes : {1u, 4u, 8u, 16u})
      if (lanes == 1 || minicl::lanes_table(lanes))
        backends.push_back(std::string("tbb:threads=") + threads + ",lanes=" + std::to_string(lanes));
  return backends;
}

inline std::string describe(const Difference &difference)
{
  return "step " + std::to_string(difference.step) + ", " + difference.backends[0] + " and " + difference.backends[1] +
         ", kernel " + (difference.kernel ? row_of(*difference.kernel).name : "?") + ", buffer " +
         (difference.buffer ? row_of(*difference.buffer).name : "?") + ", number " + std::to_string(difference.scalar) +
         ": " + difference.note;
}

/* Compares every kernel of every step. A run in which nothing was compared fails. */
inline void require_parity(const Scene &scene, const std::vector<std::string> &backends, uint64_t steps,
                           const Settings &settings = {})
{
  ComparisonRequest request;
  request.settings = settings;
  request.backends = backends;
  request.steps = steps;
  const Comparison comparison = compare_backends(scene, request);
  CAPTURE(scene.name, settings.solver, settings.broadphase, settings.batching);
  if (comparison.first_difference) FAIL(describe(*comparison.first_difference));
  CHECK(comparison.steps == steps);
  CHECK(comparison.kernels_compared > 10 * steps * (backends.size() - 1));
}

inline void require_parity(const std::string &scene, const std::vector<std::string> &backends, uint64_t steps,
                           const Settings &settings = {})
{
  CAPTURE(scene);
  require_parity(load_scene(scene), backends, steps, settings);
}

/* Tests on PoCL share one build of all features, since to compile one takes far longer than their steps do;
 * specialised_test.cpp and a few others have builds of their own. */
inline Settings build_of_all_features(Settings settings = {})
{
  settings.specialise = false;
  return settings;
}

/* The hash of the bodies and the contact cache after a number of steps. */
inline uint64_t state_after(const std::string &scene, const std::string &backend, uint64_t steps,
                            const Settings &settings = {})
{
  World world(load_scene(scene), settings, Placement{backend, {}, false});
  for (uint64_t k = 0; k < steps; ++k) world.step();
  return world.state_hash();
}

} // namespace tandem::parity
