/* Orders of items, threads and widths of the CPU backends give the bits of the serial one, kernel by kernel. */
#include "tests/parity/parity.h"

using namespace tandem;
using namespace tandem::parity;

TEST_CASE("parity on CPU: box-grid") { require_parity(small_scenes()[0], cpu_backends(), 20); }
TEST_CASE("parity on CPU: falling-boxes") { require_parity(small_scenes()[1], cpu_backends(), 60); }
TEST_CASE("parity on CPU: box-stack") { require_parity(small_scenes()[2], cpu_backends(), 30); }
TEST_CASE("parity on CPU: pyramid") { require_parity(small_scenes()[3], cpu_backends(), 40); }
TEST_CASE("parity on CPU: spheres") { require_parity(small_scenes()[4], cpu_backends(), 60); }
TEST_CASE("parity on CPU: mixed") { require_parity(small_scenes()[5], cpu_backends(), 60); }
TEST_CASE("parity on CPU: shapes") { require_parity(small_scenes()[6], cpu_backends(), 60); }
TEST_CASE("parity on CPU: convex-hulls") { require_parity(small_scenes()[7], cpu_backends(), 60); }
TEST_CASE("parity on CPU: compounds") { require_parity("compounds:n=40", cpu_backends(), 60); }
TEST_CASE("parity on CPU: hulls-on-mesh") { require_parity("hulls-on-mesh:n=40", cpu_backends(), 60); }
TEST_CASE("parity on CPU: meshes and compounds of every kind") { require_parity(few_trees(), cpu_backends(), 60); }
/* Another way to the same list: each way on every backend, and one state in the end. */
TEST_CASE("parity on CPU: trees by subtrees")
{
  Settings settings;
  settings.midphase = Midphase::subtrees;
  for (const std::string &scene : {std::string("compounds:n=40"), std::string("hulls-on-mesh:n=40"), few_trees()}) {
    require_parity(scene, cpu_backends(), 30, settings);
    CHECK(state_after(scene, "tbb", 60, settings) == state_after(scene, "serial", 60));
  }
}

TEST_CASE("parity on CPU: rolling") { require_parity(small_scenes()[8], cpu_backends(), 30); }

TEST_CASE("parity on CPU: thin-wall") { require_parity("thin-wall:n=40", cpu_backends(), 12); }
TEST_CASE("parity on CPU: bullet-stack") { require_parity("bullet-stack:rows=2,height=3", cpu_backends(), 12); }
TEST_CASE("parity on CPU: pairs that grow in number") { require_parity(imploding_boxes(), cpu_backends(), 5); }

TEST_CASE("parity on CPU: every narrowphase of every shape")
{
  for (const Narrowphase narrowphase : choices<Narrowphase>()) {
    Settings settings;
    settings.narrowphase = narrowphase;
    CAPTURE(narrowphase);
    require_parity(every_shape(), cpu_backends(), 30, settings);
  }
}

/* The other narrowphases see the pairs of the same list. */
TEST_CASE("parity on CPU: every broadphase, and both bounds, of every shape")
{
  for (const Broadphase broadphase : choices<Broadphase>())
    for (const Bounds bounds : choices<Bounds>()) {
      Settings settings;
      settings.broadphase = broadphase;
      settings.bounds = bounds;
      settings.pair_events = true;
      require_parity(every_shape(), cpu_backends(), 15, settings);
    }
}

/* One kernel or four, and exact ways to a hull's farthest vertex. */
TEST_CASE("parity on CPU: what must not change a result of convex shapes")
{
  for (const std::string &scene : {std::string("convex-hulls:n=60"), every_shape()}) {
    const uint64_t expected = state_after(scene, "serial", 60);
    Settings split, climbing;
    split.narrowphase = Narrowphase::sat_split;
    climbing.support = Support::hill_climbing;
    CHECK(state_after(scene, "serial", 60, split) == expected);
    CHECK(state_after(scene, "tbb:threads=2", 60, climbing) == expected);
  }
}

TEST_CASE("parity on CPU: supports of hulls")
{
  for (const Support support : choices<Support>()) {
    Settings settings;
    settings.support = support;
    CAPTURE(support);
    require_parity("convex-hulls:n=40", cpu_backends(), 30, settings);
  }
}

/* Broadphases find the same pairs in different ways: each must be exact by itself. */
TEST_CASE("parity on CPU: every broadphase")
{
  const std::vector<std::string> backends = {"serial", "serial:order=backward", "serial:order=shuffled",
                                             "tbb:threads=7"};
  for (const Broadphase broadphase : choices<Broadphase>()) {
    Settings settings;
    settings.broadphase = broadphase;
    require_parity("mixed:n=60", backends, 30, settings);
    require_parity("box-grid:nx=12,ny=10,nz=11", backends, 3, settings); /* more bodies than a tile has items,
                                                                              set up by pair */
  }
}

TEST_CASE("parity on CPU: every batching, width and number of threads")
{
  const std::vector<std::string> backends = {"serial", "serial:order=backward", "serial:order=shuffled",
                                             "tbb:threads=1,lanes=1", "tbb:threads=7"};
  for (const Batching batching : choices<Batching>()) {
    Settings settings;
    settings.batching = batching;
    settings.check = true;
    require_parity("pyramid-2d:n=700", backends, 3, settings); /* more contacts than a tile has items */
    require_parity("falling-boxes:n=60,height=0", backends, 40, settings);
    require_parity("mixed:n=60", backends, 30, settings);
    require_parity("box-grid:nx=4,ny=4,nz=4", backends, 20, settings);
  }
}

TEST_CASE("parity on CPU: broadphases lead to one state")
{
  const uint64_t expected = state_after("mixed:n=100", "serial", 40);
  for (const Broadphase broadphase : choices<Broadphase>()) {
    Settings settings;
    settings.broadphase = broadphase;
    CAPTURE(broadphase);
    CHECK(state_after("mixed:n=100", "tbb", 40, settings) == expected);
  }
}

TEST_CASE("parity on CPU: a few bodies of every shape", "[sanitizer]")
{
  const std::vector<std::string> backends = {"serial", "serial:order=shuffled", "tbb:threads=4",
                                             "tbb:threads=4,lanes=1"};
  const std::vector<std::string> scenes = {"box-grid:nx=5,ny=3,nz=5", "spheres:n=300,height=0", "mixed:n=30",
                                           every_shape(), few_trees()};
  for (const std::string &scene : scenes) require_parity(scene, backends, 5);
  Settings settings;
  settings.midphase = Midphase::subtrees;
  require_parity(few_trees(), backends, 5, settings);
  require_parity("hulls-on-mesh:n=20", backends, 2, settings);
}

/* Large enough that every kernel is split over several threads. */
TEST_CASE("parity on CPU: threads share each kernel", "[sanitizer]")
{
  require_parity("box-grid:nx=8,ny=8,nz=8", {"serial", "tbb:threads=4"}, 6);
  require_parity("falling-boxes:n=600,height=0", {"serial", "tbb:threads=4"}, 6);
}
