/* Calls to a world that fail at any one operation: each takes effect completely or not at all. */
#include <functional>

#include <tandem/world.h>

#include "host/runtime/interface/faults.h"
#include "tests/catch.h"

using namespace tandem;

namespace {

uint64_t nth = 0, seen = 0;
bool struck = false;

bool strike(faults::Site)
{
  const bool fails = seen++ == nth;
  struck = struck || fails;
  return fails;
}

class Armed {
public:
  explicit Armed(uint64_t at)
  {
    nth = at, seen = 0, struck = false;
    faults::hook = strike;
  }
  ~Armed() { faults::hook = nullptr; }
};

Scene few_boxes()
{
  Scene scene;
  scene.name = "few boxes";
  scene.shapes = {box_shape(0.5f, 0.5f, 0.5f), half_space_shape(), sphere_shape(0.4f)};
  Body ground;
  ground.shape = 1;
  ground.type = BodyType::fixed;
  scene.bodies = {ground};
  for (int k = 0; k < 4; ++k) {
    Body box;
    box.position = {0.1 * k, 0.5 + k, 0};
    scene.bodies.push_back(box);
  }
  return scene;
}

using Call = std::function<void(World &)>;

const std::vector<std::pair<const char *, Call>> &calls()
{
  static const std::vector<std::pair<const char *, Call>> all = {
      {"rows", [](World &world) { world.set_mass(world.id_of(2), 3); }},
      {"features", [](World &world) { world.set_properties(world.id_of(2), {.linear_damping = 1, .filter_mask = 6}); }},
      {"locks",
       [](World &world) {
         world.set_locks(world.id_of(3), {false, false, true}, {true, true, false});
       }},
      {"type", [](World &world) { world.set_type(world.id_of(1), BodyType::fixed); }},
      {"shape",
       [](World &world) {
         Child child;
         child.shape = sphere_shape(0.3f);
         child.position = {0.5f, 0, 0};
         world.add_shape_to(world.id_of(4), child);
       }},
      {"create",
       [](World &world) {
         Body ball;
         ball.shape = 2;
         ball.position = {3, 2, 0};
         world.create_body(ball);
       }},
      {"destroy", [](World &world) { world.destroy_body(world.id_of(2)); }},
      {"reserve", [](World &world) { world.reserve_pairs(20000); }},
      {"shrink",
       [](World &world) {
         world.reserve_pairs(20000);
         world.shrink_to_fit();
       }},
  };
  return all;
}

std::vector<uint64_t> hashes_after(World &world, int steps)
{
  std::vector<uint64_t> hashes{world.state_hash()};
  for (int k = 0; k < steps; ++k) {
    world.step();
    hashes.push_back(world.state_hash());
  }
  return hashes;
}

} // namespace

TEST_CASE("a call that fails anywhere changes nothing, and can be made again", "[address]")
{
  Settings settings;
  settings.events = settings.moved_bodies = true;
  uint64_t failures = 0;
  for (const auto &[name, call] : calls()) {
    World undisturbed(few_boxes(), settings, {"serial", {}});
    for (int k = 0; k < 3; ++k) undisturbed.step();
    const uint64_t before = undisturbed.state_hash();
    const size_t contacts_before = undisturbed.statistics().contacts;
    call(undisturbed);
    const std::vector<uint64_t> expected = hashes_after(undisturbed, 3);
    for (uint64_t at = 0;; ++at) {
      CAPTURE(name, at);
      World world(few_boxes(), settings, {"serial", {}});
      for (int k = 0; k < 3; ++k) world.step();
      bool threw = false;
      {
        const Armed armed(at);
        try {
          call(world);
        } catch (const std::exception &) {
          threw = true;
        }
      }
      if (threw) {
        ++failures;
        REQUIRE(world.state_hash() == before);
        REQUIRE(world.body_count() == 5);
        REQUIRE(world.scene().bodies.size() == 5);
        REQUIRE(world.scene().shapes.size() == 3);
        REQUIRE(world.scene().bodies[2].mass == 1);
        const size_t contacts = world.statistics().contacts; /* those of the last step, or none */
        REQUIRE((contacts == contacts_before || contacts == 0));
        REQUIRE((contacts > 0 || world.contact_events().empty()));
        call(world);
      }
      REQUIRE(hashes_after(world, 3) == expected);
      if (!struck) break;
    }
  }
  CHECK(failures > 0); /* of what brings tables; a few rows on the CPU need nothing that can fail */
}
