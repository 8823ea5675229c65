/* Going back a few steps: the steps after have the same bits, also where bodies came and went in between. */
#include <algorithm>
#include <limits>
#include <map>

#include <tandem/world.h>

#include "host/base/random.h"
#include "tests/catch.h"
#include "tests/host/runtime/opencl/pocl.h"
#include "tests/parity/scripted_day.h"

using namespace tandem;
using namespace tandem::parity;
using Catch::Matchers::ContainsSubstring;

namespace {

Settings watched()
{
  Settings settings;
  settings.events = settings.pair_events = settings.check = true;
  return settings;
}

/* A scripted day, and from a step on one without compounds, each of which would lay the buffers out anew. */
struct CalmDay {
  uint64_t calm_from = 60;

  void operator()(World &world, uint64_t step) const
  {
    if (step < calm_from) return ScriptedDay(3)(world, step);
    Random random(step);
    const auto number = [&](double low, double high) { return static_cast<float>(random.uniform(low, high)); };
    for (uint32_t k = 0; k < step % 4 && world.body_count() < 60; ++k) {
      Body body;
      body.shape = 2 + (static_cast<uint32_t>(step) + k) % 3;
      for (double &x : body.position) x = random.uniform(1, 6);
      body.linear_velocity = {number(-3, 3), number(-3, 3), number(-3, 3)};
      world.create_body(body);
    }
    const std::vector<BodyId> ids = world.body_ids();
    for (uint64_t k = 0; k < step % 3 && ids.size() > 10; ++k)
      world.destroy_body(ids[2 + (step + 5 * k) % (ids.size() - 2)]);
    const BodyId id = world.body_ids().back();
    world.add_force(id, {{number(-30, 30), 0, number(-30, 30)}});
    world.add_impulse(id, {{0, number(0, 3), 0}});
  }
};

/* What must be equal whenever a step has been made. */
struct Seen {
  uint64_t hash;
  std::vector<BodyId> ids;
  size_t events, bodies, shapes;
  uint64_t contacts;
};

Seen seen_of(World &world)
{
  return {world.state_hash(),
          world.body_ids(),
          world.contact_events().size(),
          world.scene().bodies.size(),
          world.scene().shapes.size(),
          world.statistics().contacts};
}

void require_same(const Seen &one, const Seen &other)
{
  REQUIRE(one.hash == other.hash);
  REQUIRE(one.ids == other.ids);
  REQUIRE(one.events == other.events);
  REQUIRE(one.bodies == other.bodies);
  REQUIRE(one.contacts == other.contacts);
}

/* Lives a day and goes back again and again by as many steps as chance says and the ring allows. Returns how often it
 * went back across creations and removals. */
uint64_t live_with_returns(const std::string &backend, const std::vector<Seen> &expected, uint64_t first,
                           uint32_t states)
{
  const CalmDay day;
  World world(yard(), watched(), {backend, {}});
  for (uint64_t step = 0; step < first; ++step) {
    day(world, step);
    world.step();
  }
  world.keep_states(states);
  Random random(1);
  uint64_t across = 0;
  for (uint64_t step = first; step < expected.size(); ++step) {
    CAPTURE(backend, step);
    day(world, step);
    world.step();
    require_same(seen_of(world), expected[step]);
    if (step % 4 != 0) continue;
    const auto back = static_cast<uint32_t>(random.uniform(0, world.states_kept()));
    world.add_impulse(world.body_ids().back(), {{9, 9, 9}}); /* is dropped */
    const std::vector<BodyId> ids = world.body_ids();
    world.go_back(back);
    if (world.body_ids() != ids) ++across;
    CAPTURE(back);
    const uint64_t to = step - back;
    REQUIRE(world.state_hash() == (to < first ? world.state_hash() : expected[to].hash));
    REQUIRE(world.statistics().steps == to + 1);
    CHECK(world.contact_events().empty());
    for (uint64_t again = to + 1; again <= step; ++again) {
      day(world, again);
      world.step();
      require_same(seen_of(world), expected[again]);
    }
  }
  return across;
}

std::vector<Seen> undisturbed(uint64_t steps)
{
  const CalmDay day;
  World world(yard(), watched(), {"serial", {}});
  std::vector<Seen> seen;
  for (uint64_t step = 0; step < steps; ++step) {
    day(world, step);
    world.step();
    seen.push_back(seen_of(world));
  }
  return seen;
}

Body ball_at(const Point &position)
{
  Body body;
  body.shape = 2;
  body.position = position;
  return body;
}

} // namespace

TEST_CASE("a world that goes back a few steps makes them again with the same bits", "[sanitizer]")
{
  const std::vector<Seen> expected = undisturbed(160);
  for (const char *backend : {"serial", "tbb:threads=2,lanes=4"})
    CHECK(live_with_returns(backend, expected, 60, 10) > 10);
  CHECK(live_with_returns("serial", expected, 2, 6) > 5);
}

TEST_CASE("parity on PoCL: states stay on the device, and steps are made again with the same bits")
{
  require_pocl();
  CHECK(live_with_returns("cl:pocl", undisturbed(90), 60, 8) > 2);
}

TEST_CASE("states that the ring does not hold are refused, with the reason, and the world stays", "[sanitizer]")
{
  World world(yard(), {}, {"serial", {}});
  CHECK_THROWS_WITH(world.go_back(0), "go_back: 0 states back, and 0 are kept");
  CHECK_THROWS_WITH(world.keep_state(), ContainsSubstring("keep_states makes it"));
  world.keep_states(3);
  for (int k = 0; k < 5; ++k) world.step();
  CHECK(world.states_kept() == 3);
  const uint64_t hash = world.state_hash();
  CHECK_THROWS_WITH(world.go_back(3), "go_back: 3 states back, and 3 are kept");
  CHECK_THROWS_AS(world.keep_states(10001), InputError);
  CHECK(world.states_kept() == 3);
  CHECK(world.state_hash() == hash);
  world.create_body(ball_at({0, 5, 0})); /* the first ball brings tables */
  CHECK(world.states_kept() == 0);
  CHECK_THROWS_WITH(world.go_back(0), ContainsSubstring("those before are gone: bodies were created"));
  world.step();
  CHECK(world.states_kept() == 1);
  world.keep_states(0);
  CHECK(world.states_kept() == 0);
}

TEST_CASE("states that are kept by calls alone are gone back to one by one", "[sanitizer]")
{
  World world(yard(), {}, {"serial", {}});
  const BodyId ball = world.create_body(ball_at({0, 5, 0}));
  world.keep_states(4, false);
  std::vector<uint64_t> hashes{world.state_hash()};
  for (int k = 0; k < 3; ++k) {
    for (int step = 0; step < 5; ++step) world.step();
    world.add_impulse(ball, {{1, 0, 0}});
    world.keep_state();
    hashes.push_back(world.state_hash());
  }
  CHECK(world.states_kept() == 4);
  world.step();
  world.go_back(0);
  CHECK(world.state_hash() == hashes[3]);
  world.go_back(2);
  CHECK(world.state_hash() == hashes[1]);
  CHECK(world.states_kept() == 2);
  CHECK(world.read_body(ball).linear_velocity[0] == Approx(1));
  world.go_back(1);
  CHECK(world.state_hash() == hashes[0]);
  CHECK(world.statistics().steps == 0);
}

TEST_CASE("going back undoes the first force, a quarantine and the use of a free index", "[sanitizer]")
{
  World world(yard(), {}, {"serial", {}}), expected(yard(), {}, {"serial", {}});
  std::vector<BodyId> ids;
  for (World *one : {&world, &expected}) {
    ids = one->create_bodies(std::vector<Body>{ball_at({0, 5, 0}), ball_at({3, 5, 0})});
    for (int k = 0; k < 5; ++k) one->step();
  }
  world.keep_states(9);
  world.add_force(ids[0], {{5, 0, 0}});
  world.step();
  BodyState state = world.read_body(ids[1]);
  state.linear_velocity[1] = std::numeric_limits<float>::quiet_NaN();
  world.set_body_unchecked(ids[1].index, state);
  world.step();
  REQUIRE(world.quarantined().size() == 1);
  world.destroy_body(ids[0]);
  world.step();
  const BodyId again = world.create_body(ball_at({-4, 6, 2}));
  CHECK(again.index == ids[0].index);
  world.step();
  world.go_back(4);
  CHECK(world.state_hash() == expected.state_hash());
  CHECK(world.quarantined().empty());
  CHECK(world.statistics().nonfinite == 0);
  CHECK(world.exists(ids[0]));
  CHECK_FALSE(world.exists(again));
  for (int k = 0; k < 60; ++k) {
    world.step();
    expected.step();
    REQUIRE(world.state_hash() == expected.state_hash());
  }
  CHECK(world.save() == expected.save());
}

TEST_CASE("going back on the reference backend loses no digit", "[sanitizer]")
{
  const CalmDay day;
  World world(yard(), {}, {"reference", {}});
  const auto live = [&](uint64_t first, uint64_t end) {
    for (uint64_t step = first; step < end; ++step) {
      day(world, step);
      world.step();
    }
  };
  live(0, 60);
  world.keep_states(8);
  live(60, 65);
  const std::vector<PreciseBodyState> then = world.precise_bodies();
  world.go_back(5);
  live(60, 65);
  const std::vector<PreciseBodyState> again = world.precise_bodies();
  REQUIRE(again.size() == then.size());
  for (size_t k = 0; k < then.size(); ++k) {
    CAPTURE(k);
    CHECK((again[k].position == then[k].position && again[k].orientation == then[k].orientation &&
           again[k].linear_velocity == then[k].linear_velocity));
  }
}

TEST_CASE("a restored world keeps states as before, and cannot go back beyond its restoration", "[sanitizer]")
{
  World world(yard(), {}, {"serial", {}});
  world.keep_states(5);
  for (int k = 0; k < 4; ++k) world.step();
  const std::vector<std::byte> snapshot = world.save();
  for (int k = 0; k < 4; ++k) world.step();
  world.restore(snapshot);
  const uint64_t hash = world.state_hash();
  CHECK(world.states_kept() == 1);
  world.step();
  world.go_back(1);
  CHECK(world.state_hash() == hash);
}
