/* worlds.h - batches of worlds for tests, beside the same worlds alone, which are the oracle: after every step each
 * world of the batch must have the hashes of the one alone. */
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <tandem/worlds.h>

#include "host/catalog/catalog.h"
#include "tests/catch.h"

namespace tandem::tests {

/* Scenes of equally many bodies in other poses. */
inline std::vector<Scene> seeded_scenes(const std::string &name, uint32_t worlds)
{
  std::vector<Scene> scenes;
  for (uint32_t world = 0; world < worlds; ++world)
    scenes.push_back(load_scene(name + ",seed=" + std::to_string(world + 1)));
  return scenes;
}

/* Every world of a scene whose other bodies move apart: copies would pass where numbers of worlds are mixed up. */
inline std::vector<Scene> varied_scenes(const std::string &name, uint32_t worlds)
{
  std::vector<Scene> scenes(worlds, load_scene(name));
  for (uint32_t world = 0; world < worlds; ++world)
    for (size_t body = 0; body < scenes[world].bodies.size(); ++body)
      if (scenes[world].bodies[body].type == BodyType::dynamic)
        scenes[world].bodies[body].linear_velocity = {0.25f * float(world), -0.5f * float(world % 3),
                                                      0.125f * float((world + body) % 5)};
  return scenes;
}

class BatchBesideWorlds {
public:
  BatchBesideWorlds(const std::vector<Scene> &scenes, const std::string &backend, const Settings &settings = {},
                    const std::string &backend_alone = "serial")
      : batch(scenes, settings, {backend, {}, false})
  {
    for (const Scene &scene : scenes)
      alone.push_back(std::make_unique<World>(scene, settings, Placement{backend_alone, {}, false}));
    require_equal();
  }

  void require_equal()
  {
    const std::vector<uint64_t> bodies = batch.body_hashes(), states = batch.state_hashes();
    REQUIRE(bodies.size() == alone.size());
    for (uint32_t world = 0; world < alone.size(); ++world) {
      CAPTURE(world, batch.steps(world));
      REQUIRE(bodies[world] == alone[world]->body_hash());
      REQUIRE(states[world] == alone[world]->state_hash());
    }
  }

  void step(uint32_t steps)
  {
    for (uint32_t k = 0; k < steps; ++k) {
      batch.step();
      for (const std::unique_ptr<World> &world : alone) world->step();
      require_equal();
    }
  }

  /* Also alone. */
  void reset(const std::vector<uint32_t> &worlds)
  {
    batch.reset(worlds);
    for (const uint32_t world : worlds)
      alone[world] = std::make_unique<World>(batch.scene(world), batch.settings(), Placement{"serial", {}, false});
    require_equal();
  }

  Worlds batch;
  std::vector<std::unique_ptr<World>> alone;
};

} // namespace tandem::tests
