/* Every broadphase finds the pairs that brute force finds, and therefore the same bits. */
#include <set>

#include "host/catalog/catalog.h"
#include "host/pipeline/broadphases/choice.h"
#include "host/runtime/memory.h"
#include "tests/catch.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* Radii from 1 cm to 10 m, and a few bodies in one place. */
Scene many_sizes()
{
  Scene scene = empty_scene();
  add_ground(scene);
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const float size = float(0.01 * std::pow(1000.0, random.uniform()));
    const float reach = 15;
    const Point place{random.uniform(-reach, reach), 0.5 + random.uniform(0, 2 * reach), random.uniform(-reach, reach)};
    Body &body = add_body(scene, BodyType::dynamic,
                          i % 2 ? sphere_shape(size) : box_shape(size, 0.3f * size, 0.6f * size), place);
    body.mass = 1000 * size * size * size;
    body.orientation = random.orientation();
    body.linear_velocity = {float(random.uniform(-5, 5)), 0, float(random.uniform(-5, 5))};
  }
  return scene;
}

/* All centres in one plane, or all in one point: two axes or all three have no extent. */
Scene flat(bool one_point)
{
  Scene scene = empty_scene({0, 0, 0});
  for (int i = 0; i < 40; ++i) {
    const Point place = one_point ? Point{1, 2, 3} : Point{0.9f * float(i % 8), 0, 0.9f * float(i / 8)};
    add_body(scene, BodyType::dynamic, i % 3 ? box_shape(0.5f, 0.4f, 0.5f) : sphere_shape(0.5f), place);
  }
  return scene;
}

/* Bodies without neighbours, one on its own at a kilometre. */
Scene scattered()
{
  Scene scene = empty_scene();
  for (int i = 0; i < 50; ++i)
    add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {3.0f * float(i), 0, float(i % 7)});
  add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {1000, 1000, -1000});
  return scene;
}

Scene scene_of(const std::string &name)
{
  if (name == "many sizes") return many_sizes();
  if (name == "flat") return flat(false);
  if (name == "one point") return flat(true);
  if (name == "scattered") return scattered();
  return load_scene(name);
}

std::vector<uint64_t> hashes_with(Broadphase broadphase, const Scene &scene)
{
  Settings settings;
  settings.broadphase = broadphase;
  World world(scene, settings);
  std::vector<uint64_t> hashes;
  for (int i = 0; i < 30; ++i) {
    world.step();
    hashes.push_back(world.state_hash());
  }
  CHECK(all_finite(world.bodies()));
  return hashes;
}

} // namespace

TEST_CASE("every broadphase leads to the bits of brute force", "[physics]")
{
  const std::string name = GENERATE("box-grid:nx=5,ny=5,nz=5", "falling-boxes:n=150", "mixed:n=200", "spheres:n=200",
                                    "pyramid:rows=8", "many sizes", "flat", "one point", "scattered");
  CAPTURE(name);
  const Scene scene = scene_of(name);
  const std::vector<uint64_t> oracle = hashes_with(Broadphase::brute_force, scene);
  for (const Broadphase broadphase : choices<Broadphase>()) {
    CAPTURE(broadphase);
    CHECK(hashes_with(broadphase, scene) == oracle);
  }
}

TEST_CASE("pairs come near once, persist and leave once, and touch only while they are near")
{
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {-3, 0, 0}).linear_velocity = {6, 0, 0};
  add_body(scene, BodyType::fixed, sphere_shape(0.5f), {0, 0.98, 0});
  add_body(scene, BodyType::fixed, box_shape(0.1f, 0.1f, 0.1f), {0, -40, 0});
  for (Body &body : scene.bodies) body.material = 0;
  Settings settings;
  settings.pair_events = settings.events = true;
  World world(scene, settings);
  std::vector<ContactEvent::Kind> kinds;
  for (int step = 0; step < 60; ++step) {
    world.step();
    const std::vector<PairEvent> events = world.pair_events();
    REQUIRE(events.size() <= 1);
    for (const PairEvent &event : events) {
      CHECK((event.a == 0 && event.b == 1));
      kinds.push_back(event.kind);
    }
    for (const ContactEvent &contact : world.contact_events())
      if (contact.kind != ContactEvent::Kind::end)
        CHECK((!events.empty() && events[0].kind != ContactEvent::Kind::end));
  }
  REQUIRE(kinds.size() > 2);
  CHECK(kinds.front() == ContactEvent::Kind::begin);
  CHECK(kinds.back() == ContactEvent::Kind::end);
  CHECK(std::all_of(kinds.begin() + 1, kinds.end() - 1,
                    [](ContactEvent::Kind kind) { return kind == ContactEvent::Kind::persist; }));
  CHECK_THROWS_AS(World(scene).pair_events(), InputError);
}

TEST_CASE("pair events of a crowd are the differences of its lists of pairs")
{
  const std::string name = GENERATE("mixed:n=120", "compounds:n=30");
  const Broadphase broadphase = GENERATE(Broadphase::grid, Broadphase::sap3, Broadphase::trees, Broadphase::bvh);
  Settings settings;
  settings.pair_events = true;
  settings.broadphase = broadphase;
  World world(load_scene(name), settings);
  world.keep_after_steps(Buffer::pair_a);
  settings.broadphase = Broadphase::brute_force;
  World oracle(load_scene(name), settings);
  std::set<std::pair<uint32_t, uint32_t>> before;
  size_t ends = 0;
  for (int step = 0; step < 200; ++step) {
    world.step();
    oracle.step();
    CAPTURE(name, broadphase, step);
    const uint32_t count = world.memory().read<uint32_t>(Buffer::counts, 1, COUNT_PAIRS).front();
    const auto a = world.memory().read<uint32_t>(Buffer::pair_a, count),
               b = world.memory().read<uint32_t>(Buffer::pair_b, count);
    std::set<std::pair<uint32_t, uint32_t>> now;
    for (uint32_t k = 0; k < count; ++k) now.insert(std::minmax(world.scene_body(a[k]), world.scene_body(b[k])));
    std::vector<PairEvent> expected;
    std::set<std::pair<uint32_t, uint32_t>> either = before;
    either.insert(now.begin(), now.end());
    for (const auto &pair : either)
      expected.push_back({!before.contains(pair) ? ContactEvent::Kind::begin
                          : now.contains(pair)   ? ContactEvent::Kind::persist
                                                 : ContactEvent::Kind::end,
                          pair.first, pair.second});
    const std::vector<PairEvent> events = world.pair_events(), of_oracle = oracle.pair_events();
    const auto same = [](const PairEvent &p, const PairEvent &q) {
      return p.kind == q.kind && p.a == q.a && p.b == q.b;
    };
    REQUIRE(std::equal(events.begin(), events.end(), expected.begin(), expected.end(), same));
    REQUIRE(std::equal(events.begin(), events.end(), of_oracle.begin(), of_oracle.end(), same));
    ends += static_cast<size_t>(std::count_if(expected.begin(), expected.end(), [](const PairEvent &event) {
      return event.kind == ContactEvent::Kind::end;
    }));
    before = now;
  }
  CHECK(ends > 0);
}

TEST_CASE("auto chooses by the sizes and the number of bodies, says why, and changes no bit")
{
  const auto choice = [](const std::string &scene, const char *backend) {
    return choose_broadphase(scene_of(scene), backend);
  };
  CHECK(choice("scattered", "serial").broadphase == Broadphase::brute_force);
  CHECK(choice("box-grid:nx=6,ny=6,nz=6", "tbb").broadphase == Broadphase::trees);
  CHECK(choice("box-grid:nx=5,ny=5,nz=5", "cl").broadphase == Broadphase::brute_force);
  CHECK(choice("box-grid:nx=12,ny=12,nz=12", "cl:nvidia").broadphase == Broadphase::grid);
  CHECK(choice("box-grid:nx=12,ny=12,nz=12", "cl:nvidia").why.find("1729 bodies, of which 1 are") != std::string::npos);
  Scene sizes = empty_scene();
  for (int i = 0; i < 300; ++i) add_body(sizes, BodyType::dynamic, sphere_shape(i % 3 ? 0.1f : 1.0f), {3.0 * i, 0, 0});
  Scene many_sizes = empty_scene();
  for (int i = 0; i < 2000; ++i)
    add_body(many_sizes, BodyType::dynamic, sphere_shape(i % 3 ? 0.1f : 1.0f), {3.0 * i, 0, 0});
  CHECK(choose_broadphase(many_sizes, "cl").broadphase == Broadphase::trees);
  CHECK(choose_broadphase(many_sizes, "cl").why.find("667 are more than") != std::string::npos);
  for (const std::string name : {"scattered", "falling-boxes:n=150", "many sizes"}) {
    CAPTURE(name);
    CHECK(hashes_with(Broadphase::automatic, scene_of(name)) == hashes_with(Broadphase::brute_force, scene_of(name)));
  }
  Settings settings;
  settings.broadphase = Broadphase::automatic;
  CHECK(World(sizes, settings).settings().broadphase == Broadphase::trees);
}
