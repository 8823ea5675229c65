/* fault_scenes.h - the worlds for tests in which one operation after the other fails: by the hooks in buffers, builds,
 * launches and transfers of faults_test.cpp, and by operator new in tests/heap/. */
#pragma once

#include <array>
#include <string>
#include <vector>

#include <tandem/world.h>

#include "host/catalog/catalog.h"
#include "tests/catch.h"

namespace tandem::fault_scenes {

struct Case {
  const char *scene;
  Settings settings;
  const char *what;
};

inline Settings with(Solver solver, Broadphase broadphase, bool events)
{
  Settings settings = settings_for(solver);
  settings.broadphase = broadphase;
  settings.events = settings.pair_events = events;
  settings.check = true;
  return settings;
}

/* Every method that keeps data from step to step. */
inline std::vector<Case> cases()
{
  return {{"box-grid:nx=2,ny=2,nz=2", with(Solver::soft_step, Broadphase::grid, true), "boxes, events"},
          {"box-grid:nx=2,ny=2,nz=2", with(Solver::xpbd, Broadphase::trees, false), "slip, kept trees"},
          {"box-grid:nx=2,ny=2,nz=2", with(Solver::avbd, Broadphase::sap3, false), "penalties, kept ends"},
          {"compounds:n=4", with(Solver::soft_step, Broadphase::bvh, true), "normals, kept hierarchy"},
          {TANDEM_SOURCE_DIR "/tests/scenes/rolling_balls.json", with(Solver::pgs, Broadphase::hybrid, false),
           "rolling friction"}};
}

/* A small initial pair capacity makes a scene of 52 coincident spheres grow it. */
inline Scene dense_cluster(uint32_t spheres)
{
  Scene scene;
  scene.name = "crowd";
  scene.shapes = {sphere_shape(0.5f)};
  scene.bodies.resize(spheres);
  for (uint32_t i = 0; i < spheres; ++i) scene.bodies[i].position = {0.01 * i, 0, 0};
  return scene;
}

inline std::vector<uint64_t> hashes_of(const Scene &scene, const Settings &settings, const Placement &placement,
                                       int steps)
{
  World world(scene, settings, placement);
  std::vector<uint64_t> hashes{world.state_hash()};
  for (int k = 0; k < steps; ++k) {
    world.step();
    hashes.push_back(world.state_hash());
  }
  return hashes;
}

inline std::vector<Ray> some_rays()
{
  return {{.origin = {0, 10, 0}, .direction = {0, -1, 0}, .reach = 100, .filter = {}},
          {.origin = {1, 10, 1}, .direction = {0, -1, 0}, .reach = 100, .filter = {}}};
}
inline std::vector<QueryBox> a_box()
{
  return {{.center = {0, 0, 0}, .half_extents = {2, 2, 2}, .displacement = {0, 0, 0}, .filter = {}}};
}
inline std::vector<ShapeCastHit> swept_ball(World &world)
{
  return world.cast_shapes(sphere_shape(0.3f), std::vector<Pose>{{.position = {0, 20, 0}}},
                           std::vector<Vec3>{{0, -30, 0}});
}
inline std::vector<std::vector<uint32_t>> overlapped_by_ball(World &world)
{
  return world.overlap_shapes(sphere_shape(0.3f), std::vector<Pose>{{.position = {0, 0, 0}}});
}

} // namespace tandem::fault_scenes
