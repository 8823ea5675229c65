/* Worlds as bytes: what is restored goes on with the bits of what was saved, wherever it goes on, and damaged bytes are
 * refused. */
#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>

#include <fmt/format.h>

#include <tandem/load_scene.h>
#include <tandem/world.h>

#include "host/world/snapshot.h"
#include "host/world/snapshot_fields.h"
#include "host/world/snapshot_scene.h"
#include "tests/catch.h"
#include "tests/host/runtime/opencl/pocl.h"
#include "tests/parity/parity.h"
#include "tests/parity/scripted_day.h"

using namespace tandem;
using namespace tandem::parity;
using Catch::Matchers::ContainsSubstring;

namespace {

using Bytes = std::vector<std::byte>;

Settings watched(Solver solver = Solver::soft_step)
{
  Settings settings = settings_for(solver);
  settings.events = settings.pair_events = settings.check = true;
  return settings;
}

/* Both live the same days and have equal hashes, handles and events after each. */
void require_equal_days(World &expected, World &world, uint64_t first, uint64_t days, const ScriptedDay &day)
{
  for (uint64_t step = first; step < first + days; ++step) {
    CAPTURE(step);
    day(expected, step);
    day(world, step);
    REQUIRE(world.body_ids() == expected.body_ids());
    expected.step();
    world.step();
    REQUIRE(world.state_hash() == expected.state_hash());
    REQUIRE(world.statistics().steps == expected.statistics().steps);
    if (step == first) continue;
    const auto events = world.contact_events(), others = expected.contact_events();
    REQUIRE(events.size() == others.size());
    for (size_t k = 0; k < events.size(); ++k)
      REQUIRE((events[k].kind == others[k].kind && events[k].a == others[k].a && events[k].b == others[k].b &&
               events[k].impulse == others[k].impulse));
  }
}

/* A day until the step, saved, and gone on with on each of the backends. */
void require_goes_on(const Scene &scene, const Settings &settings, const std::string &saved_on,
                     const std::vector<std::string> &backends, uint64_t until, uint64_t days, uint64_t seed = 3)
{
  const ScriptedDay day(seed);
  World original(scene, settings, {saved_on, {}});
  for (uint64_t step = 0; step < until; ++step) {
    day(original, step);
    original.step();
  }
  const Bytes snapshot = original.save();
  for (const std::string &backend : backends) {
    CAPTURE(saved_on, backend, settings.solver, settings.broadphase, until);
    World expected(snapshot, {"serial", {}}), world(snapshot, {backend, {}});
    CHECK(world.state_hash() == original.state_hash());
    CHECK(world.save() == snapshot);
    require_equal_days(expected, world, until, days, day);
  }
  World world(snapshot, {"serial", {}});
  require_equal_days(original, world, until, days, day);
}

Bytes sealed(Bytes bytes)
{
  ByteWriter writer;
  writer.put_bytes(bytes.data(), bytes.size());
  return seal(writer, snapshot_kind, run_parts_in_order);
}

Child child_of(const Shape &shape)
{
  Child child;
  child.shape = shape;
  return child;
}

/* A few bodies that touch, one of them destroyed, with a hull, a mesh and a compound among the shapes. */
Bytes small_snapshot()
{
  Scene scene;
  scene.name = "few";
  const std::vector<Vec3> corners = {{0, 0.5f, 0}, {0.5f, -0.3f, 0.4f}, {-0.5f, -0.3f, 0.4f}, {0, -0.3f, -0.6f}};
  const std::vector<Vec3> mesh = {{-9, 0, -9}, {9, 0, -9}, {9, 0, 9}, {-9, 0, 9}};
  const std::vector<uint32_t> triangles = {0, 2, 1, 0, 3, 2};
  scene.shapes = {mesh_shape(mesh, triangles, "floor"), hull_shape(corners, "hull"),
                  compound_shape({child_of(sphere_shape(0.2f)), child_of(box_shape(0.1f, 0.3f, 0.1f))}),
                  sphere_shape(0.3f)};
  scene.bodies.resize(5);
  scene.bodies[0].type = BodyType::fixed;
  for (uint32_t k = 1; k < 5; ++k) {
    scene.bodies[k].shape = std::min(k, 3u);
    scene.bodies[k].position = {0.4 * k, 0.5, 0.1 * k};
    take_mass_properties(scene, scene.bodies[k]);
  }
  Settings settings;
  settings.events = true;
  World world(scene, settings, {"serial", {}});
  for (int k = 0; k < 20; ++k) world.step();
  world.destroy_body(world.id_of(4));
  world.add_force(world.id_of(1), {{1, 2, 3}});
  return world.save();
}

} // namespace

TEST_CASE("a snapshot of more sleeping islands than a block of a list holds is restored")
{
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.shapes = {sphere_shape(0.25f)};
  scene.bodies.resize(block_records + 9);
  for (size_t k = 0; k < scene.bodies.size(); ++k)
    scene.bodies[k].position = {static_cast<double>(k % 100), static_cast<double>(k / 100), 0};
  Settings settings;
  settings.sleeping = true;
  World original(scene, settings, {"serial", {}});
  for (int k = 0; k < 40; ++k) original.step();
  REQUIRE(original.statistics().asleep == scene.bodies.size());
  const Bytes snapshot = original.save();
  World world(snapshot, {"tbb:threads=2", {}});
  CHECK(world.save() == snapshot);
  for (World *one : {&original, &world}) {
    one->destroy_bodies(one->body_ids());
    one->create_bodies(scene.bodies);
    one->step();
  }
  CHECK(world.state_hash() == original.state_hash());
  CHECK(world.save() == original.save());
}

TEST_CASE("a snapshot of more bodies than a block of its list holds is the same from any number of threads",
          "[sanitizer]")
{
  Scene scene;
  scene.shapes = {sphere_shape(0.25f)};
  scene.bodies.resize(2 * block_records + 7);
  for (size_t k = 0; k < scene.bodies.size(); ++k) {
    scene.bodies[k].name = std::string(k % 3, 'b');
    scene.bodies[k].position = {static_cast<double>(k % 100), static_cast<double>(k / 100), 0};
  }
  World one(scene, {}, {"serial", {}}), many(scene, {}, {"tbb:threads=7", {}});
  one.step();
  many.step();
  const Bytes snapshot = one.save();
  REQUIRE(snapshot.size() > size_t{1} << 20);
  CHECK(many.save() == snapshot);
  World world(snapshot, {"tbb:threads=3", {}});
  one.step();
  world.step();
  CHECK(world.state_hash() == one.state_hash());
  CHECK(world.save() == one.save());
}

TEST_CASE("a snapshot into used bytes is the same, whatever they were")
{
  World world(small_snapshot(), {"serial", {}});
  const Bytes expected = world.save();
  for (const size_t size : {size_t{0}, size_t{1}, expected.size() / 2, expected.size() - 1, expected.size(),
                            expected.size() + 1, 3 * expected.size()}) {
    Bytes bytes(size, std::byte{0xa5});
    world.save(bytes);
    CAPTURE(size);
    CHECK(bytes == expected);
    const std::byte *const memory = bytes.data();
    world.save(bytes);
    CHECK(bytes.data() == memory);
  }
}

TEST_CASE("a restored world goes on with the same bits on any backend", "[sanitizer]")
{
  require_goes_on(yard(), watched(), "serial", {"tbb:threads=2,lanes=4"}, 57, 60);
  require_goes_on(yard(), watched(), "tbb:threads=2,lanes=4", {"serial:order=backward"}, 22, 30);
}

TEST_CASE("six hundred steps after a snapshot, with creations and removals, have the same bits")
{
  require_goes_on(yard(), watched(), "tbb:threads=2,lanes=8", {"serial", "tbb:threads=2,lanes=16"}, 100, 600);
}

TEST_CASE("parity on PoCL: a snapshot goes to the device and back")
{
  require_pocl();
  const Settings settings = build_of_all_features(watched());
  require_goes_on(yard(), settings, "serial", {"cl:pocl"}, 40, 20);
  require_goes_on(yard(), settings, "cl:pocl", {"serial"}, 40, 20);
}

TEST_CASE("snapshots hold what each solver and broadphase hands on", "[sanitizer]")
{
  for (const Solver solver : choices<Solver>())
    require_goes_on(yard(), watched(solver), "serial", {"tbb:threads=2,lanes=4"}, 40, 6);
  for (const Broadphase broadphase : choices<Broadphase>()) {
    Settings settings = watched();
    settings.broadphase = broadphase;
    settings.specialise = broadphase != Broadphase::trees;
    require_goes_on(yard(), settings, "serial", {"serial"}, 35, 6);
  }
}

TEST_CASE("scenes of meshes, compounds and rolling bodies are restored whole")
{
  for (const std::string &name : small_scenes()) {
    CAPTURE(name);
    World original(load_scene(name), watched(), {"tbb:threads=2", {}});
    for (int k = 0; k < 15; ++k) original.step();
    World restored(original.save(), {"tbb:threads=2", {}});
    for (int k = 0; k < 15; ++k) {
      original.step();
      restored.step();
      REQUIRE(restored.state_hash() == original.state_hash());
    }
    CHECK(restored.scene().name == original.scene().name);
    CHECK(restored.scene().bodies.back().name == original.scene().bodies.back().name);
  }
}

TEST_CASE("restoring takes back steps, creations, removals and calls that were not applied", "[sanitizer]")
{
  const ScriptedDay day(11);
  World world(yard(), watched(), {"tbb:threads=2", {}}), expected(yard(), watched(), {"serial", {}});
  uint64_t launches = 0;
  world.set_observer([&](const Launch &) { ++launches; });
  Bytes snapshot;
  for (uint64_t step = 0; step < 30; ++step) {
    day(world, step);
    day(expected, step);
    world.step();
    expected.step();
  }
  snapshot = world.save();
  const uint64_t hash = world.state_hash();
  const BodyId late = world.create_body(expected.scene().bodies[1]);
  for (uint64_t step = 30; step < 60; ++step) {
    day(world, step);
    world.step();
  }
  world.add_impulse(world.body_ids().back(), {{1e3f, 0, 0}});
  world.restore(snapshot);
  CHECK(world.state_hash() == hash);
  CHECK(world.contact_events().empty());
  CHECK(world.statistics().contacts == 0);
  CHECK_FALSE(world.exists(late));
  const uint64_t before = launches;
  require_equal_days(expected, world, 30, 30, day);
  CHECK(launches > before);
}

TEST_CASE("calls that wait for a step are part of a snapshot", "[sanitizer]")
{
  World world(yard(), {}, {"serial", {}});
  Body ball;
  ball.shape = 2;
  ball.position = {0, 5, 0};
  const BodyId id = world.create_body(ball);
  world.add_force(id, {{60, 0, 0}});
  world.add_impulse(id, {{0, 0, 3}});
  World restored(world.save(), {"serial", {}});
  world.step();
  restored.step();
  CHECK(restored.state_hash() == world.state_hash());
  CHECK(restored.read_body(id).linear_velocity[0] == Approx(1)); /* 60 N on 1 kg for 1/60 s */
  CHECK(restored.read_body(id).linear_velocity[2] == Approx(3));
}

TEST_CASE("bodies that were quarantined stay out of a restored world", "[sanitizer]")
{
  World world(yard(), {}, {"serial", {}});
  Body ball;
  ball.name = "lost";
  ball.shape = 2;
  ball.position = {0, 5, 0};
  const BodyId id = world.create_body(ball);
  BodyState state = world.read_body(id);
  state.linear_velocity[0] = std::numeric_limits<float>::quiet_NaN();
  world.set_body_unchecked(id.index, state);
  world.step();
  REQUIRE(world.quarantined().size() == 1);
  World restored(world.save(), {"serial", {}});
  REQUIRE(restored.quarantined().size() == 1);
  CHECK(restored.quarantined()[0].name == "lost");
  CHECK(restored.statistics().nonfinite == 1);
  for (int k = 0; k < 5; ++k) {
    world.step();
    restored.step();
    REQUIRE(restored.state_hash() == world.state_hash());
  }
  CHECK(restored.read_body(id).position == world.read_body(id).position);
}

TEST_CASE("every byte of a snapshot matters: damaged and cut ones are refused, and the world stays", "[address]")
{
  const Bytes snapshot = small_snapshot();
  World world(snapshot, {"serial", {}});
  world.step();
  const uint64_t hash = world.state_hash();
  Bytes damaged = snapshot;
  for (size_t k = 0; k < snapshot.size(); ++k) {
    CAPTURE(k);
    damaged[k] ^= std::byte{0x10};
    REQUIRE_THROWS_AS(world.restore(damaged), InputError);
    damaged[k] = snapshot[k];
    REQUIRE_THROWS_AS(world.restore(std::span(snapshot).first(k)), InputError);
  }
  CHECK(world.state_hash() == hash);
  damaged.push_back(std::byte{0});
  CHECK_THROWS_WITH(world.restore(damaged), ContainsSubstring("cut off or damaged"));
  world.restore(snapshot);
  world.step();
  CHECK(world.state_hash() == hash);
}

TEST_CASE("messages about snapshots say what is wrong", "[sanitizer]")
{
  const Bytes snapshot = small_snapshot();
  const auto message_of = [](const Bytes &bytes) {
    try {
      World world(bytes, {"serial", {}});
    } catch (const InputError &error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  Bytes other = snapshot;
  other[0] = std::byte{'P'};
  CHECK(message_of(other) == "snapshot: it is no snapshot of Tandem, which begins with 'TANDEMS'");
  other = snapshot;
  other[8] = std::byte{14};
  CHECK_THAT(message_of(other), ContainsSubstring("snapshot: the snapshot has format 14; Tandem ") &&
                                    ContainsSubstring("reads format 13"));
  other = snapshot;
  other[100] ^= std::byte{1};
  CHECK_THAT(message_of(other), ContainsSubstring("do not have the hash of its header; it is damaged"));
  CHECK_THAT(message_of({}), ContainsSubstring("0 bytes are no snapshot"));
}

/* The hash keeps accidents out; with the hash of what was changed, the reader itself must hold. */
TEST_CASE("no byte of a snapshot that was sealed again makes the reader fail otherwise", "[address]")
{
  const Bytes snapshot = small_snapshot();
  uint64_t refused = 0, read = 0;
  for (size_t k = seal_bytes; k < snapshot.size(); ++k)
    for (const uint8_t change : {0x01, 0x80, 0xff}) {
      CAPTURE(k, change);
      Bytes bytes = snapshot;
      bytes[k] ^= std::byte{change};
      bytes = sealed(std::move(bytes));
      try {
        const SnapshotContents contents = read_snapshot(bytes, "snapshot");
        ++read;
        if (k % 5 != 0 || change != 0xff) continue;
        World world(bytes, {"serial", {}});
        for (int step = 0; step < 3; ++step) world.step();
      } catch (const InputError &) {
        ++refused;
      }
    }
  CHECK(refused > 1000);
  CHECK(read > 1000);
}

TEST_CASE("no cut of a snapshot that was sealed again makes the reader fail otherwise", "[address]")
{
  const Bytes snapshot = small_snapshot();
  for (size_t length = seal_bytes; length < snapshot.size(); ++length) {
    const auto part = std::span(snapshot).first(length);
    CAPTURE(length);
    const Bytes bytes = sealed({part.begin(), part.end()});
    REQUIRE_THROWS_AS(read_snapshot(bytes, "snapshot"), InputError);
  }
}

namespace {

/* What world.save() gave, with other words in place of those at a byte, and the hash of that. */
Bytes forged(Bytes bytes, size_t at, uint32_t word, size_t words = 1)
{
  for (size_t k = 0; k < words; ++k) std::memcpy(&bytes[at + k * sizeof word], &word, sizeof word);
  return sealed(std::move(bytes));
}

/* Where the contents of a buffer begin: behind its name, the size of its items and its bytes, whose number this is. */
size_t contents_of(const Bytes &bytes, const std::string &name, uint64_t &length)
{
  const std::string_view text(reinterpret_cast<const char *>(bytes.data()), bytes.size());
  const size_t at = text.rfind(name);
  REQUIRE(at != text.npos);
  std::memcpy(&length, &bytes[at + name.size() + sizeof(uint64_t)], sizeof length);
  return at + name.size() + 2 * sizeof(uint64_t);
}

/* Where the number of large bodies stands: behind the order of the bodies and the number of half-spaces. */
size_t place_of_large(const Bytes &bytes)
{
  ByteReader reader(std::span<const std::byte>(bytes).subspan(seal_bytes), "snapshot", seal_bytes);
  reader.get<std::vector<std::string>>();
  Settings settings;
  reader.get(settings);
  get_scene(reader);
  reader.get<std::vector<std::string>>();
  reader.get<std::vector<uint32_t>>();
  reader.get<uint32_t>();
  return reader.position();
}

Bytes sleeping_snapshot()
{
  Settings settings;
  settings.sleeping = true;
  World world(load_scene("box-grid:nx=3,ny=2,nz=3"), settings, {"serial", {}});
  for (int k = 0; k < 400 && world.statistics().asleep < 18; ++k) world.step();
  REQUIRE(world.statistics().asleep == 18);
  return world.save();
}

} // namespace

TEST_CASE("numbers of a snapshot that kernels index with are checked, whoever sealed it", "[address]")
{
  const auto message_of = [](const Bytes &bytes) {
    try {
      World world(bytes, {"serial", {}});
      world.step();
    } catch (const InputError &error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const Bytes touching = small_snapshot(), asleep = sleeping_snapshot();
  uint64_t length;
  const size_t partners = contents_of(touching, "cached_b", length);
  REQUIRE(length >= 2 * sizeof(uint32_t));
  for (const uint32_t body : {5u, 1000u, 0x7fffffffu, 0xffffffffu})
    CHECK_THAT(message_of(forged(touching, partners, body, length / sizeof(uint32_t))),
               ContainsSubstring(fmt::format("a cached pair has body {}, of 5 bodies", body)));
  const size_t large = place_of_large(asleep);
  uint32_t bodies_with_large;
  std::memcpy(&bodies_with_large, &asleep[large], sizeof bodies_with_large);
  REQUIRE(bodies_with_large == 1);
  CHECK(message_of(forged(asleep, large, 1)) == "none");
  for (const uint32_t count : {2u, 5u, 19u, 20u})
    CHECK_THAT(message_of(forged(asleep, large, count)), ContainsSubstring("bodies with the large ones"));
}

TEST_CASE("a list of starts that is shorter than one number is refused", "[address]")
{
  const Bytes snapshot = small_snapshot();
  uint64_t length;
  const size_t at = contents_of(snapshot, "cached_start", length);
  for (const uint64_t shorter : {1, 2, 3}) {
    Bytes bytes = snapshot;
    std::memcpy(&bytes[at - sizeof shorter], &shorter, sizeof shorter);
    const auto begin = bytes.begin() + static_cast<ptrdiff_t>(at);
    bytes.erase(begin + static_cast<ptrdiff_t>(shorter), begin + static_cast<ptrdiff_t>(length));
    CHECK_THROWS_WITH(read_snapshot(sealed(bytes), "snapshot"), ContainsSubstring("the starts of the cached pairs"));
  }
}

namespace {

/* Writes and reads a record. */
template <class T> T copied(const T &record)
{
  ByteWriter writer;
  writer.put(record);
  const Bytes bytes = writer.take();
  ByteReader reader(bytes, "test");
  T copy = reader.get<T>();
  reader.expect_end();
  return copy;
}

template <class T> auto fields_of(const T &record)
{
  return visit_fields(record, [](const auto &...fields) { return std::tie(fields...); });
}

template <class T> bool all_equal(const T &one, const T &other) { return fields_of(one) == fields_of(other); }

/* How many fields of the first are equal to those of the second. */
template <class T> size_t equal_fields(const T &one, const T &other)
{
  size_t equal = 0;
  std::apply(
      [&](const auto &...a) {
        std::apply([&](const auto &...b) { ((equal += a == b ? 1 : 0), ...); }, fields_of(other));
      },
      fields_of(one));
  return equal;
}

} // namespace

TEST_CASE("every field of a body, a material and the settings is in a snapshot", "[sanitizer]")
{
  const Body body{"one",
                  BodyType::kinematic,
                  true,
                  3,
                  4,
                  {1, 2, 3},
                  {1, 0, 0, 0},
                  {4, 5, 6},
                  {0, 1, 0, 0},
                  {7, 8, 9},
                  {1, 2, 4},
                  5,
                  {1, 2, 3},
                  true,
                  0.5f,
                  0.25f,
                  0.125f,
                  6,
                  7,
                  true,
                  {true, false, true},
                  {false, true, false},
                  8,
                  9,
                  10};
  CHECK(equal_fields(body, Body{}) == 0);
  CHECK(all_equal(copied(body), body));
  const Material material{"ice", 1, 2, 0.5f, Combine::maximum, Combine::minimum, 3, 4};
  CHECK(equal_fields(material, Material{}) == 0);
  CHECK(all_equal(copied(material), material));
  Settings settings{0.5f,
                    7,
                    8,
                    Solver::xpbd,
                    Broadphase::sap,
                    Bounds::tight,
                    Midphase::subtrees,
                    Narrowphase::gjk_epa,
                    Support::cube_map,
                    9,
                    Batching::iterative,
                    true,
                    true,
                    true,
                    true,
                    0.25f,
                    0.75f,
                    true,
                    true,
                    10,
                    false,
                    {},
                    11,
                    12,
                    13,
                    14,
                    15,
                    16,
                    17,
                    18,
                    19};
  CHECK(equal_fields(settings, Settings{}) == 0);
  CHECK(all_equal(copied(settings), settings));
  const JointAxis axis{1, 2, 3, 4, 5, 6, 7, 8, 9, true, 10, 11, 12, 13};
  CHECK(equal_fields(axis, JointAxis{}) == 0);
  CHECK(all_equal(copied(axis), axis));
  const Joint joint{"knee",
                    JointType::hinge,
                    false,
                    1,
                    2,
                    {1, 2, 3},
                    {4, 5, 6},
                    {1, 0, 0, 0},
                    {0, 1, 0, 0},
                    true,
                    13,
                    14,
                    {true, false, false},
                    {false, true, false},
                    {axis, axis, axis},
                    {axis, axis, axis}};
  CHECK(equal_fields(joint, Joint{}) == 0);
  CHECK(all_equal(copied(joint), joint));
  const Actuator actuator{"knee", 1, 2, Control::target_velocity, 3, 4, 5, 6};
  CHECK(equal_fields(actuator, Actuator{}) == 0);
  CHECK(all_equal(copied(actuator), actuator));
}

TEST_CASE("shapes share in a restored scene what they shared, and keep every field", "[sanitizer]")
{
  const std::vector<Vec3> corners = {{0, 0.5f, 0}, {0.5f, -0.3f, 0.4f}, {-0.5f, -0.3f, 0.4f}, {0, -0.3f, -0.6f}};
  const Shape hull = hull_shape(corners, "hull"),
              mesh = height_field_shape(std::vector<float>{0, 1, 2, 3, 1, 2}, 3, 1, 1, "mesh");
  Child child{hull, {1, 2, 3}, {1, 0, 0, 0}, 2.5f, 0, 5, 6};
  Scene scene;
  scene.name = "shared";
  scene.gravity = {1, 2, 3};
  scene.shapes = {hull, mesh, compound_shape({child, child_of(mesh)}), hull, capsule_shape(0.25f, 0.75f)};
  scene.materials[0].restitution = 0.75f;
  ByteWriter writer;
  put_scene(writer, scene);
  const Bytes bytes = writer.take();
  ByteReader reader(bytes, "test");
  const Scene read = get_scene(reader);
  reader.expect_end();
  REQUIRE(read.shapes.size() == 5);
  CHECK(read.shapes[0].hull == read.shapes[3].hull);
  const std::vector<Child> &children = read.shapes[2].compound->children;
  REQUIRE(children.size() == 2);
  CHECK(children[0].shape.hull == read.shapes[0].hull);
  CHECK(children[1].shape.mesh == read.shapes[1].mesh);
  CHECK((children[0].position == child.position && children[0].orientation == child.orientation &&
         children[0].density == child.density && children[0].material == child.material &&
         children[0].filter_group == child.filter_group && children[0].filter_mask == child.filter_mask));
  CHECK_FALSE(children[1].material);
  CHECK(read.shapes[0].hull->vertices == hull.hull->vertices);
  CHECK(read.shapes[0].hull->edges == hull.hull->edges);
  CHECK(read.shapes[0].hull->tolerance == hull.hull->tolerance);
  CHECK(read.shapes[1].mesh->triangles == mesh.mesh->triangles);
  CHECK(read.shapes[1].mesh->neighbours == mesh.mesh->neighbours);
  CHECK(read.shapes[4].size == scene.shapes[4].size);
  CHECK((read.name == "shared" && read.gravity == scene.gravity && read.materials[0].restitution == 0.75f));
}

TEST_CASE("the reader allocates nothing that the bytes cannot hold", "[sanitizer]")
{
  ByteWriter writer;
  writer.put(uint64_t{1} << 60);
  const Bytes bytes = writer.take();
  CHECK_THROWS_WITH(ByteReader(bytes, "test").get<std::vector<Body>>(),
                    ContainsSubstring("does not fit into the 0 bytes"));
  CHECK_THROWS_WITH(ByteReader(bytes, "test").get<std::vector<float>>(), ContainsSubstring("byte 8"));
  CHECK_THROWS_AS(ByteReader(bytes, "test").get<std::string>(), InputError);
}
