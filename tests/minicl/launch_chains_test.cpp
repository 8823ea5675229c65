/* Launches of one tree an item run block by block, others one after another, and trees have the bits of a thread that
 * runs one launch after another. */
#include "minicl/launch_chains.h"
#include "tests/catch.h"
#include "tests/parity/parity.h"

using namespace tandem;
using namespace tandem::minicl;

namespace {

BoundLaunch launch_of(Kernel kernel, uint32_t last = COUNT_ARTICULATIONS)
{
  BoundLaunch bound;
  bound.launch.kernel = kernel;
  bound.launch.last = last;
  return bound;
}

using Pairs = std::vector<std::pair<size_t, size_t>>;

Pairs chains_of(const std::vector<BoundLaunch> &series)
{
  LaunchChains chains;
  chains.find(series);
  Pairs found;
  for (size_t k = 0; k < chains.count(); ++k) found.emplace_back(chains.at(k).first, chains.at(k).last);
  return found;
}

} // namespace

TEST_CASE("launch chains: neighbours of one tree an item are one chain, and nothing else is")
{
  const BoundLaunch accelerate = launch_of(Kernel::accelerate_articulations),
                    contacts = launch_of(Kernel::solve_tree_contacts), rows = launch_of(Kernel::solve_articulations),
                    bodies = launch_of(Kernel::integrate_positions, COUNT_BODIES),
                    order = launch_of(Kernel::order_tree_contacts),
                    joints = launch_of(Kernel::solve_link_joints, COUNT_JOINTS);
  CHECK(chains_of({}).empty());
  CHECK(chains_of({accelerate, contacts, rows, bodies, contacts, rows}) == Pairs{{0, 3}, {3, 4}, {4, 6}});
  CHECK(chains_of({bodies, bodies, order, order}) == Pairs{{0, 1}, {1, 2}, {2, 3}, {3, 4}});
  CHECK(chains_of({rows, joints, rows}) == Pairs{{0, 1}, {1, 2}, {2, 3}});
  CHECK(chains_of({rows, launch_of(Kernel::solve_tree_contacts, COUNT_BODIES), contacts}) ==
        Pairs{{0, 1}, {1, 2}, {2, 3}});
}

TEST_CASE("launch chains: blocks are all trees once, and end where trees that lie beside each other do")
{
  for (const auto &[first, last] : std::vector<std::pair<uint32_t, uint32_t>>{
           {0, 0}, {0, 1}, {0, 32}, {5, 7}, {16, 100}, {31, 33}, {0xffffff00u, 0xffffffffu}}) {
    uint32_t next = first;
    for_each_block_of_trees(first, last, [&](uint32_t begin, uint32_t end) {
      REQUIRE(begin == next);
      REQUIRE(end > begin);
      CHECK((end % trees_of_block == 0 || end == last));
      CHECK(end - begin <= trees_of_block);
      next = end;
    });
    CHECK(next == last);
  }
}

TEST_CASE("parity on CPU: more trees than a block has, on one thread and on several")
{
  parity::require_parity("humanoid:n=70", {"serial", "tbb:threads=1,lanes=8", "tbb:threads=1,lanes=16"}, 6);
  for (const char *backend : {"tbb:threads=1", "tbb:threads=2", "tbb:threads=3,lanes=8"})
    CHECK(parity::state_after("humanoid:n=70", backend, 8) == parity::state_after("humanoid:n=70", "serial", 8));
}
