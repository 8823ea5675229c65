/* Lists of pairs with runs of one (a, b), as bodies of several parts make them: each run is one contact. The oracle is
 * a map. */
#include <map>
#include <vector>

#include "host/base/random.h"
#include "shared/events/list.h"
#include "tests/catch.h"

using tandem::Random;

namespace {

/* Sorted entries of one step: b, whether it touches, its one point. */
struct Entries {
  std::vector<uint> start{0}, b, touching, color, points;
  std::vector<float4> impulse, point, normal;

  void add(uint body, bool touches, float carried, float x)
  {
    b.push_back(body);
    touching.push_back(touches);
    color.push_back(carried > 0 ? 3u : COLOR_INACTIVE);
    points.push_back(touches ? 1u : 0u);
    impulse.push_back({carried, 0, 0, 0});
    point.push_back({x, 0, 0, -0.1f * x});
    normal.push_back({0, carried, 1, 0});
  }
};

Entries random_entries(Random &random, uint bodies)
{
  Entries entries;
  for (uint a = 0; a < bodies; ++a) {
    for (uint b = 0; b < a; ++b)
      for (uint part = random.below(3) ? 0 : 1 + random.below(3); part > 0; --part) {
        const bool touches = random.below(2);
        entries.add(b, touches, touches && random.below(2) ? float(1 + random.below(9)) : 0.0f,
                    float(1 + random.below(5)));
      }
    entries.start.push_back(uint(entries.b.size()));
  }
  entries.add(0, false, 0, 0); /* so that no vector is empty */
  return entries;
}

struct Expected {
  bool touched = false, touches = false;
  float impulse = 0, hardest = 0;
  uint points = 0;
};

} // namespace

TEST_CASE("each run of entries of one pair has one event, and the events are those of a map", "[events][sanitizer]")
{
  constexpr uint bodies = 12;
  Random random(17);
  size_t seen[3] = {};
  for (int trial = 0; trial < 300; ++trial) {
    const Entries before = random_entries(random, bodies), now = random_entries(random, bodies);
    std::map<std::pair<uint, uint>, Expected> expected;
    for (uint a = 0; a < bodies; ++a) {
      for (uint i = before.start[a]; i < before.start[a + 1]; ++i)
        if (before.touching[i]) expected[{a, before.b[i]}].touched = true;
      for (uint i = now.start[a]; i < now.start[a + 1]; ++i) {
        if (!now.touching[i]) continue;
        Expected &e = expected[{a, now.b[i]}];
        e.touches = true;
        e.impulse += now.impulse[i].x;
        e.hardest = std::max(e.hardest, now.impulse[i].x);
        ++e.points;
      }
    }
    const size_t pairs = now.b.size();
    std::vector<float4> points(4 * pairs), positions(2 * bodies), velocities(2 * bodies),
        contacts(3 * (pairs + before.b.size()));
    std::copy(now.point.begin(), now.point.end(), points.begin());
    for (uint a = 0; a < bodies; ++a) positions[2 * a] = {100.0f * float(a), 0, 0, 0};
    std::vector<uint> counts(COUNT_TOTAL), starts(bodies), codes(4 * (pairs + before.b.size()));
    counts[CAPACITY_PAIRS] = uint(pairs);
    counts[CAPACITY_POINTS] = 4;
    const read_touching_pairs touching{now.start.data(), now.b.data(), now.touching.data()};
    const read_cached_touching_pairs touched{before.start.data(), before.b.data(), before.touching.data()};
    const read_manifolds manifolds{now.normal.data(), points.data(), now.points.data(), nullptr};
    uint total = 0;
    for (uint a = 0; a < bodies; ++a) {
      count_events_item(touching, touched, starts.data(), a);
      const uint found = starts[a];
      starts[a] = total;
      total += found;
    }
    REQUIRE(total == expected.size());
    for (uint a = bodies; a-- > 0;)
      write_events_item(touching, now.color.data(), now.impulse.data(), manifolds, touched, positions.data(),
                        velocities.data(), starts.data(), counts.data(), codes.data(), contacts.data(), a);
    uint at = 0;
    for (const auto &[pair, e] : expected) {
      const uint *code = &codes[4 * at];
      const float4 *contact = &contacts[3 * at++];
      REQUIRE((code[1] == pair.first && code[2] == pair.second));
      const uint kind = !e.touches ? EVENT_END : e.touched ? EVENT_PERSIST : EVENT_BEGIN;
      REQUIRE(code[0] == kind);
      REQUIRE(code[3] == e.points);
      REQUIRE(contact[0].w == e.impulse);
      REQUIRE(contact[2].y == e.hardest); /* the normal of the part that pressed hardest */
      if (e.touches)
        REQUIRE((contact[0].x - 100.0f * float(pair.first) >= 1 && contact[0].x - 100.0f * float(pair.first) <= 5));
      ++seen[kind];
    }
  }
  for (size_t count : seen) CHECK(count > 1000);
}
