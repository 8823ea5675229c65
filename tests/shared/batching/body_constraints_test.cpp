/* Lists of the constraints of each body against lists made by hand, for random graphs with and without hubs. */
#include "host/base/random.h"
#include "host/pipeline/body_constraints.h"
#include "host/pipeline/layout.h"
#include "host/runtime/make_backend.h"
#include "shared/records.h"
#include "tests/catch.h"
#include "tests/parity/parity.h"
#include "tests/shared/words.h"

using namespace tandem;

namespace {

struct Graph {
  uint32_t bodies = 0, overflow = 0; /* constraints from `overflow` on have no colour */
  std::vector<uint32_t> a, b, flags;
};

/* Every seventh body is fixed; about half of the constraints of a hub graph touch body 1. */
Graph random_graph(uint32_t bodies, uint32_t constraints, bool hub, uint64_t seed)
{
  Random random(seed);
  Graph graph;
  graph.bodies = bodies;
  graph.overflow = constraints / 3;
  for (uint32_t i = 0; i < bodies; ++i)
    graph.flags.push_back((i % 7 == 0 ? uint32_t(BODY_TYPE_FIXED) : uint32_t(BODY_TYPE_DYNAMIC)) << 3);
  for (uint32_t i = 0; i < constraints; ++i) {
    const uint32_t a = 2 + random.below(bodies - 2);
    graph.a.push_back(a);
    graph.b.push_back(hub && i % 2 ? 1 : random.below(a));
  }
  return graph;
}

struct ConstraintLists {
  std::vector<uint32_t> starts, entries;
  bool operator==(const ConstraintLists &) const = default;
};

ConstraintLists constraints_by_hand(const Graph &graph, uint32_t first)
{
  std::vector<std::vector<uint32_t>> lists(graph.bodies);
  for (uint32_t i = first; i < graph.a.size(); ++i)
    for (uint32_t side : {0u, 1u})
      if (const uint32_t body = side ? graph.b[i] : graph.a[i]; graph.flags[body] >> 3 == uint32_t(BODY_TYPE_DYNAMIC))
        lists[body].push_back(2 * i + side);
  ConstraintLists result;
  for (const std::vector<uint32_t> &list : lists) {
    result.starts.push_back(uint32_t(result.entries.size()));
    result.entries.insert(result.entries.end(), list.begin(), list.end());
  }
  result.starts.push_back(uint32_t(result.entries.size()));
  return result;
}

ConstraintLists constraints_on_backend(const std::string &name, const Graph &graph, uint32_t first_color)
{
  const auto constraints = uint32_t(graph.a.size());
  StepPlan plan;
  plan.bodies = graph.bodies;
  plan.capacity_pairs = constraints + 5;
  plan.known[COUNT_ONE] = 1;
  plan.known[COUNT_BODIES] = graph.bodies;
  plan.known[COUNT_BODIES_PLUS_ONE] = graph.bodies + 1;
  plan.known[COUNT_CONSTRAINTS] = plan.known[COLOR_START + COLOR_OVERFLOW + 1] = constraints;
  plan.known[COLOR_START + COLOR_OVERFLOW] = graph.overflow;
  plan.known[COUNT_BODY_CONSTRAINTS] = 2 * constraints;
  plan.known[COUNT_OVERFLOW_BODY_CONSTRAINTS] = 2 * (constraints - graph.overflow);

  const std::unique_ptr<Backend> backend = make_backend(name);
  Memory memory;
  std::vector<Kernel> kernels = {Kernel::body_constraint_keys, Kernel::body_constraint_starts};
  for (size_t k = 0; k < kernel_count; ++k)
    if (row_of(kernel_at(k)).stage == Stage::parallel) kernels.push_back(kernel_at(k));
  backend->prepare(0, kernels);
  const Sizes sizes{.bodies = graph.bodies,
                    .materials = 1,
                    .hulls = {},
                    .trees = {},
                    .pairs = plan.capacity_pairs,
                    .cells = 1024,
                    .features = 0};
  for (Buffer buffer :
       {Buffer::body_constraint, Buffer::body_constraint_other, Buffer::body_constraint_key,
        Buffer::body_constraint_key_other, Buffer::body_constraint_start, Buffer::sort_histogram, Buffer::scan_sums})
    memory.resize(buffer, bytes_of(buffer, sizes));
  set_words(memory, Buffer::counts, {plan.known.begin(), plan.known.end()});
  set_words(memory, Buffer::constraint_a, graph.a);
  set_words(memory, Buffer::constraint_b, graph.b);
  set_words(memory, Buffer::body_flags, graph.flags);

  DirectLauncher launcher(memory, *backend);
  list_body_constraints(launcher, plan, first_color);
  ConstraintLists lists;
  lists.starts = memory.read<uint32_t>(Buffer::body_constraint_start, graph.bodies + 1);
  lists.entries = memory.read<uint32_t>(Buffer::body_constraint, lists.starts.back());
  backend->finish();
  return lists;
}

} // namespace

TEST_CASE("every moving body lists its constraints in order", "[sanitizer]")
{
  const Graph graph =
      GENERATE(random_graph(5, 0, false, 1), random_graph(10, 1, false, 2), random_graph(200, 700, false, 3),
               random_graph(3000, 9000, true, 4), random_graph(70000, 9000, false, 5));
  const uint32_t first_color = GENERATE(0u, COLOR_OVERFLOW);
  const ConstraintLists expected = constraints_by_hand(graph, first_color == 0 ? 0 : graph.overflow);
  CAPTURE(graph.bodies, graph.a.size(), first_color);
  for (const char *name : {"serial", "serial:order=backward", "serial:order=shuffled", "tbb:threads=7"}) {
    CAPTURE(name);
    CHECK((constraints_on_backend(name, graph, first_color) == expected));
  }
}

TEST_CASE("bodies list the same constraints on OpenCL")
{
  parity::require_pocl();
  for (const uint32_t first_color : {0u, COLOR_OVERFLOW}) {
    const Graph graph = random_graph(3000, 9000, true, 4);
    CHECK((constraints_on_backend("cl:pocl", graph, first_color) ==
           constraints_by_hand(graph, first_color == 0 ? 0 : graph.overflow)));
  }
}
