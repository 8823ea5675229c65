/* Colours of bodies: no constraint and no joint joins two moving bodies of one colour, and each body has the lowest
 * colour that its neighbours of higher priority leave free, as one pass in order of priority finds it. */
#include <numeric>
#include <set>

#include "host/catalog/catalog.h"
#include "host/pipeline/solvers/solvers.h"
#include "shared/batching/coloring.h"
#include "tests/catch.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

constexpr uint32_t uncolored = 0xffffffffu;

/* The colours by index of the body buffers. */
struct Coloring {
  std::vector<std::set<uint32_t>> neighbors;
  std::vector<bool> takes_part; /* moves and is touched */
  std::vector<uint32_t> colors;
};

Coloring coloring_of(World &world)
{
  Memory &memory = world.memory();
  const auto counts = memory.read<uint32_t>(Buffer::counts, COUNT_TOTAL);
  const uint32_t bodies = counts[COUNT_BODIES], constraints = counts[COUNT_CONSTRAINTS];
  const auto a = memory.read<uint32_t>(Buffer::constraint_a, constraints),
             b = memory.read<uint32_t>(Buffer::constraint_b, constraints);
  const auto velocity = memory.read<float4>(Buffer::body_velocity, 2 * bodies);
  const auto sorted = memory.read<uint32_t>(Buffer::sort_value, bodies);
  Coloring coloring{std::vector<std::set<uint32_t>>(bodies), std::vector<bool>(bodies),
                    std::vector<uint32_t>(bodies, uncolored)};
  const auto moves = [&](uint32_t body) { return velocity[2 * body].w > 0; };
  const auto join = [&](uint32_t one, uint32_t other) {
    const bool one_moves = one != INDEX_NONE && moves(one), other_moves = other != INDEX_NONE && moves(other);
    if (one_moves) coloring.takes_part[one] = true;
    if (other_moves) coloring.takes_part[other] = true;
    if (!one_moves || !other_moves) return;
    coloring.neighbors[one].insert(other);
    coloring.neighbors[other].insert(one);
  };
  for (uint32_t i = 0; i < constraints; ++i) join(a[i], b[i]);
  const uint32_t joints = world.scene().joints.empty() ? 0 : counts[COUNT_JOINTS];
  if (joints > 0) {
    const auto joint_a = memory.read<uint32_t>(Buffer::joint_a, joints),
               joint_b = memory.read<uint32_t>(Buffer::joint_b, joints);
    for (uint32_t i = 0; i < joints; ++i) join(joint_a[i], joint_b[i]);
  }
  for (uint32_t color = 0; color <= COLOR_OVERFLOW; ++color)
    for (uint32_t i = counts[BODY_COLOR_START + color]; i < counts[BODY_COLOR_START + color + 1]; ++i)
      coloring.colors[sorted[i]] = color;
  return coloring;
}

/* One body after another, the highest priority first. */
std::vector<uint32_t> greedy(const Coloring &coloring)
{
  std::vector<uint32_t> order(coloring.colors.size()), colors(coloring.colors.size(), uncolored);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [](uint32_t a, uint32_t b) { return bid_of(a) > bid_of(b); });
  for (uint32_t body : order) {
    if (!coloring.takes_part[body]) continue;
    std::set<uint32_t> used;
    for (uint32_t other : coloring.neighbors[body]) used.insert(colors[other]);
    uint32_t color = 0;
    while (color < COLOR_LIMIT && used.count(color)) ++color;
    colors[body] = color;
  }
  return colors;
}

/* A body of many neighbours. */
Scene slab_under_boxes(int side)
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_body(scene, BodyType::dynamic, box_shape(0.3f * float(side), 0.25f, 0.3f * float(side)), {0, 0.25f, 0}).mass = 20;
  for (int i = 0; i < side * side; ++i)
    add_body(scene, BodyType::dynamic, box_shape(0.25f, 0.25f, 0.25f),
             {0.5f * (float(i % side) - 0.5f * float(side)), 0.75f, 0.5f * (float(i / side) - 0.5f * float(side))});
  return scene;
}

} // namespace

TEST_CASE("bodies of one colour share no constraint and no joint, and colours are those of a greedy pass", "[physics]")
{
  const std::vector<Scene> scenes{load_scene("box-grid:nx=5,ny=5,nz=5"), load_scene("pyramid:rows=12"),
                                  slab_under_boxes(12), load_scene("joint-grid:columns=12,rows=9"),
                                  load_scene("ragdolls:n=6,height=0")};
  for (const Scene &scene : scenes) {
    World world(scene, settings_for(Solver::avbd));
    world.set_observer([](const Launch &) {}); /* so that what it reads shares no memory */
    for (int i = 0; i < 3; ++i) {
      run(world, 5);
      const Coloring coloring = coloring_of(world);
      size_t joined = 0;
      for (uint32_t body = 0; body < coloring.colors.size(); ++body) {
        CAPTURE(scene.name, body);
        REQUIRE((coloring.colors[body] != uncolored) == coloring.takes_part[body]);
        for (uint32_t other : coloring.neighbors[body]) {
          ++joined;
          if (coloring.colors[body] != COLOR_OVERFLOW) REQUIRE(coloring.colors[other] != coloring.colors[body]);
        }
      }
      CHECK(joined > 100);
      CHECK(coloring.colors == greedy(coloring));
    }
  }
}
