/* The invariant of batching: constraints of one colour share no body that can move. */
#include <set>

#include "host/catalog/catalog.h"
#include "host/runtime/memory.h"
#include "shared/records.h"
#include "tests/catch.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

struct Coloring {
  std::vector<uint32_t> a, b, starts; /* constraint ends in colour order; COLOR_LIMIT + 2 starts */
  std::vector<bool> moves;            /* by index of the body buffers */
};

Coloring coloring_of(World &world)
{
  Memory &memory = world.memory();
  const auto counts = memory.read<uint32_t>(Buffer::counts, COUNT_TOTAL);
  Coloring coloring;
  coloring.a = memory.read<uint32_t>(Buffer::constraint_a, counts[COUNT_CONSTRAINTS]);
  coloring.b = memory.read<uint32_t>(Buffer::constraint_b, counts[COUNT_CONSTRAINTS]);
  coloring.starts.assign(counts.begin() + COLOR_START, counts.begin() + COLOR_START + COLOR_ENTRIES);
  const auto velocity = memory.read<float4>(Buffer::body_velocity, 2 * counts[COUNT_BODIES]);
  for (size_t i = 0; i < velocity.size(); i += 2) coloring.moves.push_back(velocity[i].w > 0);
  return coloring;
}

void check_colors(const Coloring &coloring)
{
  REQUIRE(coloring.starts.size() == COLOR_LIMIT + 2);
  CHECK(coloring.starts.front() == 0);
  CHECK(coloring.starts.back() == coloring.a.size());
  std::set<std::pair<uint32_t, uint32_t>> pairs;
  for (uint32_t color = 0; color <= COLOR_LIMIT; ++color) {
    std::set<uint32_t> touched;
    REQUIRE(coloring.starts[color] <= coloring.starts[color + 1]);
    for (uint32_t i = coloring.starts[color]; i < coloring.starts[color + 1]; ++i) {
      pairs.insert({coloring.a[i], coloring.b[i]});
      if (color == COLOR_OVERFLOW) continue;
      CAPTURE(color, i);
      for (uint32_t body : {coloring.a[i], coloring.b[i]})
        if (coloring.moves[body] && !touched.insert(body).second)
          FAIL("body " << body << " stands twice in colour " << color);
    }
  }
  CHECK(pairs.size() == coloring.a.size());
}

/* A slab with 100 spheres on it: more contacts than there are colours. */
Scene slab_under_small_boxes()
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_body(scene, BodyType::dynamic, box_shape(3, 0.25f, 3), {0, 0.25f, 0}).mass = 20;
  for (int i = 0; i < 100; ++i)
    add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.2f, 0.2f),
             {0.5f * float(i % 10) - 2.25f, 0.7f, 0.5f * float(i / 10) - 2.25f})
        .mass = 0.5f;
  return scene;
}

} // namespace

TEST_CASE("constraints of one colour share no moving body", "[physics][address]")
{
  const Batching batching = GENERATE(from_range(choices<Batching>()));
  const std::string name = GENERATE("box-grid:nx=4,ny=4,nz=4", "mixed:n=150", "spheres:n=150");
  Settings settings;
  settings.batching = batching;
  settings.check = true;
  World world(load_scene(name), settings);
  uint32_t constraints = 0;
  for (int i = 0; i < 8; ++i) {
    run(world, 10);
    const Coloring coloring = coloring_of(world);
    check_colors(coloring);
    constraints += uint32_t(coloring.a.size());
  }
  CAPTURE(name, batching);
  CHECK(constraints > 100);
  CHECK_FALSE(world.batch_fault());
}

TEST_CASE("a body that touches more than 63 others goes to the overflow constraints and still works", "[physics]")
{
  Settings settings;
  settings.batching = GENERATE(from_range(choices<Batching>()));
  settings.check = true;
  CAPTURE(settings.batching);
  World world(slab_under_small_boxes(), settings);
  const std::vector<BodyState> start = world.bodies();
  run(world, 120);
  const Coloring coloring = coloring_of(world);
  check_colors(coloring);
  CHECK_FALSE(world.batch_fault());
  CHECK(coloring.a.size() >= 101);
  CHECK(coloring.starts[COLOR_OVERFLOW + 1] - coloring.starts[COLOR_OVERFLOW] >= 101 - COLOR_LIMIT);
  CHECK(world.statistics().colors == COLOR_LIMIT + 1);
  CHECK(world.statistics().max_penetration < 0.0075);
  double moved = 0;
  const std::vector<BodyState> now = world.bodies();
  for (size_t i = 1; i < now.size(); ++i)
    moved = std::max(moved, (vector_of(now[i].position) - vector_of(start[i].position)).norm());
  INFO("100 boxes on a slab, overflow constraints: "
       << coloring.starts[COLOR_OVERFLOW + 1] - coloring.starts[COLOR_OVERFLOW] << ": moved " << moved << " m");
  CHECK(moved < 0.02);
}
