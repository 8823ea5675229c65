/* broadphase_test.cpp - the inputs have the properties that they promise, the pairs are those of two loops on the host,
 * and a broadphase that loses one is detected. */
#ifdef TANDEM_COMMAND
#include "host/runtime/make_backend.h"
#include "tests/catch.h"
#include "tools/bench/broadphase.h"
#include "tools/bench/broadphase_frames.h"

using namespace tandem;

namespace {

struct BodyBounds {
  float4 lower, upper;
};

bool overlap(const BodyBounds &p, const BodyBounds &q)
{
  return p.lower.x <= q.upper.x && q.lower.x <= p.upper.x && p.lower.y <= q.upper.y && q.lower.y <= p.upper.y &&
         p.lower.z <= q.upper.z && q.lower.z <= p.upper.z;
}

std::vector<BodyBounds> bounds_of(BroadphaseFrames &frames, size_t bodies)
{
  return frames.memory().read<BodyBounds>(Buffer::bounds, bodies);
}

/* Each of those that overlap and do not both stand still. */
uint32_t counted_pairs(BroadphaseFrames &frames, const MovingBodies &moving)
{
  const size_t bodies = moving.scene.bodies.size();
  const std::vector<BodyBounds> bounds = bounds_of(frames, bodies);
  const auto stands = [&](size_t k) { return moving.scene.bodies[moving.special.order[k]].type == BodyType::fixed; };
  uint32_t pairs = 0;
  for (size_t a = 0; a < bodies; ++a)
    for (size_t b = 0; b < a; ++b) pairs += overlap(bounds[a], bounds[b]) && !(stands(a) && stands(b));
  return pairs;
}

double pairs_each(const char *input, uint32_t bodies)
{
  const MovingBodies moving(broadphase_input_named(input), bodies);
  const std::unique_ptr<Backend> backend = make_backend("serial");
  BroadphaseFrames frames(moving, row_of(Broadphase::grid), *backend);
  frames.run(0);
  return double(frames.pairs()) / bodies;
}

/* The output of the benchmark on 500 bodies of `pile`, with these arguments. */
std::vector<BroadphaseScene> bench_of(const std::vector<BroadphaseRow> &broadphases,
                                      const std::vector<uint32_t> &bodies = {500})
{
  BroadphaseRequest request = broadphase_request({}, {"pile"});
  request.backend = "serial";
  request.bodies = bodies;
  request.broadphases = broadphases;
  return bench_broadphase(request);
}

/* Names another body in the first pair, in one frame alone. */
int frames_until_wrong = 0;
void find_pairs_wrongly(StepLaunches &step)
{
  find_pairs_in_grid(step);
  if (--frames_until_wrong == 0) step.run_range(Kernel::fill, COUNT_ZERO, COUNT_ONE, {7}, {Buffer::pair_b});
}

} // namespace

TEST_CASE("bench broadphase: all find the pairs that two loops count, in every frame", "[bench-broadphase]")
{
  const std::unique_ptr<Backend> backend = make_backend("serial");
  for (const BroadphaseInput &input : broadphase_inputs()) {
    const MovingBodies moving(input, 700);
    REQUIRE(moving.scene.bodies.size() == 700);
    for (const BroadphaseRow &broadphase : broadphases()) {
      BroadphaseFrames frames(moving, broadphase, *backend);
      for (uint32_t frame = 0; frame < 3; ++frame) {
        CAPTURE(input.name, broadphase.name, frame);
        frames.run(frame);
        CHECK(frames.pairs() > 0);
        CHECK(frames.pairs() == counted_pairs(frames, moving));
      }
    }
  }
}

TEST_CASE("bench broadphase: inputs are as dense as they say", "[bench-broadphase]")
{
  const double spheres = pairs_each("spheres", 2000), pile = pairs_each("pile", 2000),
               sizes = pairs_each("sizes", 2000), fixed = pairs_each("static", 2000);
  CAPTURE(spheres, pile, sizes, fixed);
  CHECK(std::abs(2 * spheres - 4) < 0.8); /* others that a body overlaps */
  CHECK(pile > 2);
  CHECK(pile < 5);
  CHECK(sizes > 1);
  CHECK(sizes < 6);
  CHECK(fixed > 0.01);
  CHECK(fixed < 0.1);
}

TEST_CASE("bench broadphase: the large box overlaps a tenth of the small ones", "[bench-broadphase]")
{
  const MovingBodies moving(broadphase_input_named("one-large"), 2000);
  const std::unique_ptr<Backend> backend = make_backend("serial");
  BroadphaseFrames frames(moving, row_of(Broadphase::bvh), *backend);
  frames.run(0);
  REQUIRE(moving.special.order[0] == 0);
  int with_large = 0;
  for (uint32_t b : frames.memory().read<uint32_t>(Buffer::pair_b, frames.pairs())) with_large += b == 0;
  CHECK(with_large > 160);
  CHECK(with_large < 240);
}

TEST_CASE("bench broadphase: bodies are drawn alike each time, move by small steps, and the fixed ones stay",
          "[bench-broadphase]")
{
  for (const BroadphaseInput &input : broadphase_inputs()) {
    const MovingBodies moving(input, 400), again(input, 400);
    const std::vector<float4> start = moving.places_at(0), later = moving.places_at(10), same = again.places_at(10);
    REQUIRE(start.size() == 800);
    int moved = 0, fixed = 0;
    for (size_t k = 0; k < 400; ++k) {
      const float4 &from = start[2 * k], &to = later[2 * k];
      const double displacement = std::abs(to.x - from.x) + std::abs(to.y - from.y) + std::abs(to.z - from.z);
      CAPTURE(input.name, k, displacement);
      CHECK(same[2 * k].x == to.x);
      CHECK(displacement < 0.51); /* ten steps at 1 m/s along each axis */
      const bool stands = moving.scene.bodies[moving.special.order[k]].type == BodyType::fixed;
      if (stands) CHECK(displacement == 0);
      moved += displacement > 0;
      fixed += stands;
    }
    CHECK(moved == 400 - fixed);
    CHECK(fixed == (std::string(input.name) == "static" ? 396 : std::string(input.name) == "pile" ? 1 : 0));
  }
}

TEST_CASE("bench broadphase: a list that outgrows its room is found again with room", "[bench-broadphase]")
{
  const MovingBodies moving(broadphase_input_named("spheres"), 500);
  const std::unique_ptr<Backend> backend = make_backend("serial");
  for (const BroadphaseRow &broadphase : broadphases()) {
    BroadphaseFrames ample(moving, broadphase, *backend), tight(moving, broadphase, *backend, 1);
    for (uint32_t frame = 0; frame < 2; ++frame) {
      ample.run(frame);
      tight.run(frame);
      CAPTURE(broadphase.name, frame);
      CHECK(tight.pairs() == ample.pairs());
      CHECK(tight.hash() == ample.hash());
    }
  }
}

TEST_CASE("bench broadphase: one wrong pair in one frame is reported", "[bench-broadphase]")
{
  frames_until_wrong = 4; /* the first launch records kernels */
  const std::vector<BroadphaseScene> scenes = bench_of({{Broadphase::automatic, "wrong", "", find_pairs_wrongly},
                                                        row_of(Broadphase::brute_force),
                                                        row_of(Broadphase::bvh)});
  const std::vector<std::string> lines = differences_of(scenes);
  REQUIRE(lines.size() == 1);
  CHECK(lines[0].find("pile, 500 bodies: wrong gives other pairs than brute-force in frame 2: ") == 0);
  CHECK(broadphase_text(scenes[0]).find("WRONG") != std::string::npos);
  CHECK(broadphase_json(scenes[0])["runs"][0]["difference"].is_string());
  CHECK(broadphase_json(scenes[0])["runs"][1]["difference"].is_null());
}

TEST_CASE("bench broadphase: a table of sizes with slopes, and a chart", "[bench-broadphase]")
{
  const std::vector<BroadphaseScene> scenes = bench_of({row_of(Broadphase::grid), row_of(Broadphase::bvh)}, {100, 200});
  CHECK(differences_of(scenes).empty());
  const std::string text = broadphase_text(scenes[0]);
  for (const char *said : {"pile: ", "100", "200", "slope", "grid", "bvh", "pairs"})
    CHECK(text.find(said) != std::string::npos);
  const Json json = broadphase_json(scenes[0]);
  REQUIRE(json["runs"].size() == 4);
  CHECK(json["slopes"]["bvh"].is_number());
  CHECK(json["runs"][0]["pairs"] == json["runs"][1]["pairs"]);
  const std::string chart = broadphase_chart({scenes[0], scenes[0]}, "serial");
  CHECK(chart.find("data-name=\"grid\"") != chart.rfind("data-name=\"grid\""));
  CHECK(chart.find("pairs of bounds: pile, on serial") != std::string::npos);
}

TEST_CASE("bench broadphase: slopes of known times, and what they predict", "[bench-broadphase]")
{
  CHECK_FALSE(slope_of({}).has_value());
  CHECK_FALSE(slope_of({{1000, 3}}).has_value());
  CHECK(*slope_of({{1000, 3}, {10000, 30}}) == Approx(1));
  CHECK(*slope_of({{1000, 3}, {10000, 300}}) == Approx(2));
  CHECK(*slope_of({{1000, 9}, {1000, 9}, {4000, 18}}) == Approx(0.5)); /* the two largest alone */
  CHECK_FALSE(predicted_milliseconds({}, 1000).has_value());
  CHECK(*predicted_milliseconds({{1000, 3}}, 10000) == Approx(300));
  CHECK(*predicted_milliseconds({{1000, 3}, {10000, 300}}, 100000) == Approx(30000));
  CHECK(*predicted_milliseconds({{1000, 3}, {10000, 4}}, 100000) == Approx(40)); /* never less than in proportion */
  CHECK(*predicted_milliseconds({{1000, 3}, {10000, 30000}}, 100000) == Approx(3000000));
}
#endif
