/* The data that one step passes to the next: each number of it changes the hash of the state, and everything that
 * changes the bits of the next step is in that hash. */
#include <algorithm>
#include <limits>
#include <memory>
#include <set>
#include <string>

#include <tandem/world.h>

#include "host/catalog/catalog.h"
#include "host/pipeline/broadphases/broadphase.h"
#include "host/pipeline/layout.h"
#include "host/world/carried.h"
#include "shared/platform.h"
#include "tests/catch.h"

using namespace tandem;

namespace {

struct Case {
  const char *scene;
  Solver solver;
  Broadphase broadphase;
  bool automatic = false; /* substeps */
};

/* Together they carry over every buffer that there is. */
const std::vector<Case> cases = {
    {"box-grid:nx=2,ny=2,nz=2", Solver::soft_step, Broadphase::grid},
    {"box-grid:nx=2,ny=2,nz=2", Solver::soft_step, Broadphase::grid, true},
    {"box-grid:nx=2,ny=2,nz=2", Solver::xpbd, Broadphase::trees},
    {"box-grid:nx=2,ny=2,nz=2", Solver::avbd, Broadphase::sap3},
    {"compounds:n=6", Solver::pgs, Broadphase::bvh},
    {TANDEM_SOURCE_DIR "/tests/scenes/rolling_balls.json", Solver::soft_step, Broadphase::hybrid},
    {"ragdolls:n=2,height=0", Solver::soft_step, Broadphase::grid},
    {"ragdolls:n=2,height=0", Solver::avbd, Broadphase::grid},
    {"crane:rows=1,length=1", Solver::soft_step, Broadphase::grid},
    {"humanoid:n=1", Solver::soft_step, Broadphase::grid},
    {"spheres:n=12,height=0", Solver::jacobi, Broadphase::grid}};

/* After so many steps; with events, forces and sleeping, which carry buffers of their own. No body rests long enough to
 * sleep. */
std::unique_ptr<World> world_of(const Case &c, uint64_t steps)
{
  Settings settings = settings_for(c.solver);
  settings.broadphase = c.broadphase;
  if (c.automatic) settings.substeps = automatic_substeps;
  settings.events = true;
  const Scene scene = load_scene(c.scene);
  settings.sleeping = scene.joints.empty();
  settings.tree_joint_forces = !scene.articulations.empty();
  auto world = std::make_unique<World>(scene, settings, Placement{"serial", {}, false});
  world->add_force(world->id_of(1), {0, 0.01f, 0});
  for (uint64_t k = 0; k < steps; ++k) world->step();
  return world;
}

uint32_t bodies_of(World &world) { return static_cast<uint32_t>(world.scene().bodies.size()); }
uint32_t pairs_of(World &world)
{
  return world.memory().read<uint32_t>(Buffer::cached_start, 1, bodies_of(world)).front();
}

size_t words_of(World &world, Buffer buffer)
{
  const BufferRow &row = row_of(buffer);
  const size_t bodies = bodies_of(world);
  const bool is_of_joints =
      row.capacity == Capacity::JOINTS || row.capacity == Capacity::JOINT_AXES || row.capacity == Capacity::COUPLINGS;
  const size_t items = row.capacity == Capacity::BODIES            ? bodies
                       : row.capacity == Capacity::BODIES_PLUS_ONE ? bodies + 1
                       : is_of_joints                              ? world.memory().bytes(buffer) / item_bytes(buffer)
                                                                   : pairs_of(world);
  return items * row.per_item * size_of(row.element) / sizeof(uint32_t);
}

/* Flips bits of one word of a buffer; a second time it is as it was. */
void flip(World &world, Buffer buffer, size_t word, uint32_t bits)
{
  const uint32_t changed = world.memory().read<uint32_t>(buffer, 1, word).front() ^ bits;
  world.memory().upload(buffer, &changed, sizeof changed, word * sizeof changed);
}

} // namespace

TEST_CASE("every number that is carried over changes the hash of the state")
{
  std::set<Buffer> seen;
  for (const Case &c : cases) {
    const auto world = world_of(c, 20);
    const uint64_t hash = world->state_hash();
    REQUIRE(pairs_of(*world) > 0);
    for (const CarriedBuffer &carried : carried_buffers()) {
      if (world->memory().bytes(carried.now) == 0) continue;
      seen.insert(carried.now);
      /* The last of the starts says how many pairs there are: it is not changed into what no scene has. */
      const size_t words = words_of(*world, carried.now) - (carried.now == Buffer::cached_start ? 1 : 0);
      for (size_t word = 0; word < words; ++word) {
        CAPTURE(c.scene, c.solver, row_of(carried.now).name, word);
        flip(*world, carried.now, word, 1);
        REQUIRE(world->state_hash() != hash);
        flip(*world, carried.now, word, 1);
      }
    }
    REQUIRE(world->state_hash() == hash);
  }
  const std::vector<CarriedBuffer> all = carried_buffers(); /* modules of other tests among them */
  const auto of_pipeline = [](const CarriedBuffer &carried) { return index_of(carried.now) < buffer_count; };
  CHECK(seen.size() == static_cast<size_t>(std::count_if(all.begin(), all.end(), of_pipeline)));
}

namespace {

/* The buffers of one lifetime that the step of this world writes. */
std::set<Buffer> written_by_step(World &world, Lifetime lifetime)
{
  std::set<Buffer> written;
  for (const Kernel kernel : world.kernels())
    for (const Argument &argument : row_of(kernel).arguments)
      if (argument.kind == Argument::Kind::buffer && argument.access != Access::in &&
          row_of(argument.buffer).lifetime == lifetime)
        written.insert(argument.buffer);
  written.erase(Buffer::tile_changed); /* 0 between launches, whatever is kept */
  return written;
}

/* One word after the other of buffers of this lifetime is changed between two steps: the next must not notice. */
void check_that_no_bit_follows_from(Lifetime lifetime, const Case &c)
{
  const auto undisturbed = world_of(c, 11), disturbed = world_of(c, 10);
  if (lifetime == Lifetime::KEPT) forget_kept(disturbed->memory());
  size_t changed = 0;
  for (const Buffer buffer : written_by_step(*disturbed, lifetime)) {
    if (!disturbed->memory().is_held(buffer)) continue; /* who took its memory is disturbed instead */
    const size_t words = disturbed->memory().bytes(buffer) / sizeof(uint32_t);
    for (size_t word = 0; word < words; ++word) flip(*disturbed, buffer, word, 0x00400001u);
    changed += words;
  }
  CAPTURE(c.scene, c.solver, c.broadphase);
  const bool keeps = c.broadphase == Broadphase::trees || c.broadphase == Broadphase::sap3;
  if (lifetime == Lifetime::SCRATCH || keeps) CHECK(changed > 50);
  REQUIRE(disturbed->state_hash() == world_of(c, 10)->state_hash());
  disturbed->step();
  CHECK(disturbed->state_hash() == undisturbed->state_hash());
}

} // namespace

TEST_CASE("no bit of the next step follows from scratch")
{
  for (const Case &c : cases) check_that_no_bit_follows_from(Lifetime::SCRATCH, c);
}

TEST_CASE("what is kept may be forgotten between two steps without a change of bits")
{
  for (const Case &c : cases) check_that_no_bit_follows_from(Lifetime::KEPT, c);
}

TEST_CASE("what changes the motion of the next step changes the hash before it")
{
  for (const Case &c : cases) {
    const auto undisturbed = world_of(c, 21);
    const uint64_t before = world_of(c, 20)->state_hash();
    size_t noticed = 0;
    for (const CarriedBuffer &carried : carried_buffers()) {
      const auto first = world_of(c, 20);
      if (row_of(carried.now).element != Element::float4 || first->memory().bytes(carried.now) == 0) continue;
      const size_t words = words_of(*first, carried.now);
      for (size_t word = 0; word < words; word += 1 + words / 5) {
        const auto world = world_of(c, 20);
        flip(*world, carried.now, word, 0x00400000u);
        const uint64_t hash = world->state_hash();
        world->step();
        const bool moved = world->body_hash() != undisturbed->body_hash();
        CAPTURE(c.scene, c.solver, row_of(carried.now).name, word);
        if (moved) CHECK(hash != before);
        noticed += moved;
      }
    }
    CHECK(noticed > 3);
  }
}

TEST_CASE("a world in which a body was taken out is another state")
{
  const Case c = cases[0];
  const auto world = world_of(c, 2), other = world_of(c, 2);
  BodyState broken = world->bodies()[1];
  broken.linear_velocity[0] = std::numeric_limits<float>::quiet_NaN();
  world->set_body_unchecked(1, broken);
  world->step();
  other->step();
  CHECK(world->quarantined().size() == 1);
  CHECK(world->state_hash() != other->state_hash());
}
