/* Recordings: what a program did with a world is made again anywhere with the same bits, what differs is named, and
 * damaged files are refused. */
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <tandem/compare.h>
#include <tandem/recording.h>
#include <tandem/world.h>

#include "host/base/hash.h"
#include "tests/catch.h"
#include "tests/host/runtime/opencl/pocl.h"
#include "tests/parity/scripted_day.h"

using namespace tandem;
using namespace tandem::parity;
using Catch::Matchers::ContainsSubstring;

namespace {

using Bytes = std::vector<std::byte>;

/* A file that is removed when the test ends. */
struct Scratch {
  std::string path = (std::filesystem::temp_directory_path() / "tandem-recording-XXXXXX").string();
  Scratch() { REQUIRE(mkdtemp(path.data())); }
  ~Scratch() { std::filesystem::remove_all(path); }
  std::string file() const { return path + "/F.tandem"; }
};

Bytes bytes_of(const std::string &path)
{
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  Bytes bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

std::optional<RecordedDifference> verified(const WorldRecording &recording, const std::string &backend,
                                           uint64_t from = 0)
{
  World world(recording.snapshot(from), {backend, {}});
  ReplayRequest request;
  request.first = recording.snapshot_step(from);
  request.verify_from = from;
  return replay(recording, world, request);
}

Body ball_at(const Point &position)
{
  Body body;
  body.name = "ball";
  body.shape = 2;
  body.position = position;
  return body;
}

/* Every call that a world has, between steps. */
void live_a_full_day(World &world)
{
  const ScriptedDay day(4);
  Bytes snapshot;
  for (uint64_t step = 0; step < 60; ++step) {
    day(world, step);
    if (step == 3) world.add_material({"ice", 0, 0});
    if (step == 4) {
      const uint32_t shape = world.add_shape(sphere_shape(0.7f));
      Body body = ball_at({1, 7, 1});
      body.shape = shape;
      body.material = 1;
      world.create_body(body);
    }
    if (step == 8) world.set_body(0, world.bodies()[0]);
    if (step == 20) snapshot = world.save();
    if (step == 30) world.restore(snapshot);
    if (step == 40) world.keep_states(4);
    if (step == 43 && world.states_kept() > 1) world.go_back(1);
    if (step == 50) world.keep_states(3, false);
    if (step == 51) world.keep_state();
    world.step();
  }
}

WorldRecording recorded_day(const std::string &backend, const RecordingOptions &options = {})
{
  const Scratch scratch;
  World world(yard(), {}, {backend, {}});
  for (int k = 0; k < 3; ++k) world.step();
  world.start_recording(scratch.file(), options);
  live_a_full_day(world);
  world.add_impulse(world.id_of(0), {});
  world.stop_recording();
  return {bytes_of(scratch.file()), "F.tandem"};
}

/* A floor and a few balls for a few steps. */
Bytes small_recording(bool ends = true)
{
  const Scratch scratch;
  {
    World world(yard(), {}, {"serial", {}});
    world.start_recording(scratch.file());
    for (int k = 0; k < 4; ++k) {
      const BodyId id = world.create_body(ball_at({2.0 * k, 0.4, 0}));
      world.add_force(id, {{1, 0, 0}, {0, 1, 0}, Point{0, 1, 0}});
      if (k == 2) world.destroy_body(world.id_of(2));
      world.step();
    }
    if (ends) world.stop_recording();
  }
  return bytes_of(scratch.file());
}

} // namespace

TEST_CASE("a recording of calls with more bodies than a block of a list holds is made again")
{
  const Scratch scratch;
  World world(yard(), {}, {"serial", {}});
  world.start_recording(scratch.file());
  std::vector<Body> balls;
  for (int k = 0; k < 5000; ++k) balls.push_back(ball_at({2.0 * (k % 70), 3, 2.0 * (k / 70)}));
  const std::vector<BodyId> ids = world.create_bodies(balls);
  world.add_forces(ids, std::vector<Force>(ids.size(), {{1, 2, 0}, {0, 0, 0}, Point{0, 1, 0}}));
  world.step();
  world.destroy_bodies(ids);
  world.step();
  world.stop_recording();
  const WorldRecording recording(bytes_of(scratch.file()), "F.tandem");
  REQUIRE((recording.finished() && recording.steps() == 2));
  CHECK_FALSE(verified(recording, "tbb:threads=3"));
}

TEST_CASE("a recording of every call is made again on any backend with the same hashes", "[sanitizer]")
{
  const WorldRecording recording = recorded_day("tbb:threads=2,lanes=4");
  CHECK(recording.steps() == 60);
  CHECK(recording.finished());
  for (const char *backend : {"serial", "tbb:threads=2"}) {
    CAPTURE(backend);
    const auto difference = verified(recording, backend);
    if (difference) FAIL("step " << difference->step);
  }
}

TEST_CASE("parity on PoCL: a recording is made again on the device")
{
  require_pocl();
  CHECK_FALSE(verified(recorded_day("serial"), "cl:pocl"));
}

TEST_CASE("the first step and body that differ are named", "[sanitizer]")
{
  const Scratch scratch;
  Scene scene = yard();
  for (int k = 0; k < 6; ++k) scene.bodies.push_back(ball_at({3.0 * k, 20, 0}));
  scene.bodies[5].name = "the fourth";
  World original(scene, {}, {"serial", {}});
  original.start_recording(scratch.file());
  for (int k = 0; k < 12; ++k) original.step();
  original.stop_recording();
  const WorldRecording recording(bytes_of(scratch.file()), "F.tandem");
  World world(recording.snapshot(), {"serial", {}});
  ReplayRequest request;
  request.after_step = [&](uint64_t done) {
    if (done == 7) world.add_impulse(world.id_of(5), {{1e-6f, 0, 0}});
  };
  const std::optional<RecordedDifference> difference = replay(recording, world, request);
  REQUIRE(difference);
  CHECK(difference->step == 7);
  CHECK(difference->body == 5u);
  CHECK(difference->body_step == 7);
  CHECK(difference->name == "the fourth");
  CHECK(difference->recorded != difference->found);

  World once(recording.snapshot(), {"serial", {}});
  request.verify = false;
  request.after_step = [&](uint64_t done) {
    if (done == 7) once.add_impulse(once.id_of(5), {{1e-6f, 0, 0}});
  };
  const std::optional<RecordedDifference> last = replay(recording, once, request);
  REQUIRE(last);
  CHECK(last->step == 11);
}

TEST_CASE("large worlds have hashes of bodies every few steps, and the body is named there", "[sanitizer]")
{
  const Scratch scratch;
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.shapes = {sphere_shape(0.1f)};
  scene.bodies.resize(2100);
  for (size_t k = 0; k < scene.bodies.size(); ++k) scene.bodies[k].position = {static_cast<double>(k), 0, 0};
  World original(scene, {}, {"serial", {}});
  original.start_recording(scratch.file());
  for (int k = 0; k < 6; ++k) original.step();
  original.stop_recording();
  const WorldRecording recording(bytes_of(scratch.file()), "F.tandem");
  CHECK(recording.has_body_hashes(0));
  CHECK_FALSE(recording.has_body_hashes(1));
  CHECK(recording.has_body_hashes(3));
  World world(recording.snapshot(), {"serial", {}});
  ReplayRequest request;
  request.after_step = [&](uint64_t done) {
    if (done == 1) world.add_impulse(world.id_of(2000), {{1, 0, 0}});
  };
  const std::optional<RecordedDifference> difference = replay(recording, world, request);
  REQUIRE(difference);
  CHECK(difference->step == 1);
  CHECK(difference->body == 2000u);
  CHECK(difference->body_step == 3);
}

TEST_CASE("a replay starts at the last snapshot before the step that is asked for", "[sanitizer]")
{
  RecordingOptions options;
  options.snapshot_every = 10;
  const WorldRecording recording = recorded_day("serial", options);
  CHECK(recording.snapshot_step(0) == 0);
  CHECK(recording.snapshot_step(9) == 0);
  CHECK(recording.snapshot_step(10) == 10);
  CHECK(recording.snapshot_step(37) == 30);
  CHECK(recording.snapshot_step(59) == 40); /* states are kept from then on */
  for (const uint64_t from : {0, 12, 35, 59}) {
    CAPTURE(from);
    CHECK_FALSE(verified(recording, "tbb:threads=2", from));
  }
}

TEST_CASE("a recording is a scene for the comparison of backends", "[sanitizer]")
{
  const WorldRecording recording(small_recording(), "F.tandem");
  ComparisonRequest request;
  request.backends = {"serial", "tbb:threads=2,lanes=4"};
  request.steps = recording.steps();
  request.snapshot = recording.snapshot();
  request.before_step = [&](World &world, uint64_t step) { recording.make_calls(world, step); };
  const Comparison comparison = compare_backends(yard(), request);
  CHECK(comparison.equal);
  CHECK(comparison.steps == 4);
  CHECK(comparison.kernels_compared > 100);
}

TEST_CASE("a recording without its end is read up to its last whole step", "[sanitizer]")
{
  const WorldRecording recording(small_recording(false), "F.tandem");
  CHECK_FALSE(recording.finished());
  CHECK(recording.steps() == 4);
  CHECK_FALSE(verified(recording, "serial"));
}

TEST_CASE("a recording that cannot be written says so", "[sanitizer]")
{
  World world(yard(), {}, {"serial", {}});
  CHECK_THROWS_WITH(world.start_recording("/nonexistent/F.tandem"), ContainsSubstring("cannot write: No such file"));
  if (std::filesystem::exists("/dev/full")) CHECK_THROWS_AS(world.start_recording("/dev/full"), InputError);
  world.stop_recording();
  world.step();
}

TEST_CASE("every byte of a recording matters: damaged ones are refused, cut ones end after a whole step", "[address]")
{
  const Bytes whole = small_recording();
  Bytes damaged = whole;
  for (size_t k = 0; k < whole.size(); ++k) {
    CAPTURE(k);
    damaged[k] ^= std::byte{0x04};
    REQUIRE_THROWS_AS(WorldRecording(damaged, "F.tandem"), InputError);
    damaged[k] = whole[k];
  }
  uint64_t read = 0;
  for (size_t length = 0; length < whole.size(); ++length) {
    CAPTURE(length);
    try {
      const WorldRecording part({whole.begin(), whole.begin() + static_cast<ptrdiff_t>(length)}, "F.tandem");
      REQUIRE_FALSE(part.finished());
      REQUIRE_FALSE(verified(part, "serial"));
      ++read;
    } catch (const InputError &) {}
  }
  CHECK(read == 5); /* after the snapshot and after each step */
}

namespace {

/* Gives every part the hash of its bytes. Nothing if they are not parts any more. */
void seal_again(Bytes &bytes)
{
  size_t at = 16;
  for (uint64_t number = 0; at + 16 <= bytes.size(); ++number) {
    uint64_t length = 0;
    std::memcpy(&length, &bytes[at], sizeof length);
    if (length > bytes.size() - at - 16) return;
    const uint64_t hash = hash_blocks(bytes.data() + at + 16, length, number, run_parts_in_order);
    std::memcpy(&bytes[at + 8], &hash, sizeof hash);
    at += 16 + length;
  }
}

} // namespace

TEST_CASE("no byte of a recording that was sealed again makes the replay fail otherwise", "[address]")
{
  const Bytes whole = small_recording();
  uint64_t refused = 0, different = 0, equal = 0;
  for (size_t k = 16; k < whole.size(); ++k) {
    if (k % 3 != 0 && k < 4000) continue; /* the snapshot has a hash of its own */
    CAPTURE(k);
    Bytes bytes = whole;
    bytes[k] ^= std::byte{0x81};
    seal_again(bytes);
    try {
      const WorldRecording recording(std::move(bytes), "F.tandem");
      ++(verified(recording, "serial") ? different : equal);
    } catch (const InputError &) {
      ++refused;
    }
  }
  CHECK(refused > 100);
  CHECK(different > 10);
}
