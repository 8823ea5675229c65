/* islands.cpp - finds islands, writes each as a dense problem, and stores the solution; see islands.h. */
#include "host/pipeline/solvers/islands.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "host/pipeline/solvers/island.h"
#include "host/runtime/interface/floating_point.h"
#include "host/runtime/parts.h"

namespace tandem {
namespace {

using namespace in_double;

/* --- islands ------------------------------------------------------------------------------------- */

uint32_t root_of(std::vector<uint32_t> &parent, uint32_t body)
{
  while (parent[body] != body) body = parent[body] = parent[parent[body]];
  return body;
}

enum class Outcome : uint8_t { left, solved, stalled };

/* Edges by island. Each list of all edges has the range [starts[k], starts[k + 1]) for island k. */
struct Islands {
  void reserve(size_t most_edges)
  {
    starts.reserve(most_edges + 1);
    for (std::vector<uint32_t> *list : {&next, &members, &ordered}) list->reserve(most_edges);
    seen.reserve(most_edges);
    points.reserve(most_edges);
    outcomes.reserve(most_edges);
  }

  size_t count() const { return starts.size() - 1; }
  size_t size(size_t k) const { return starts[k + 1] - starts[k]; }
  bool is_small(size_t k) const { return points[k] <= most_island_points; }
  std::span<const uint32_t> edges(size_t k) const { return {members.data() + starts[k], size(k)}; }
  std::span<uint32_t> order(size_t k) { return {ordered.data() + starts[k], size(k)}; }
  std::span<uint8_t> marks(size_t k) { return {seen.data() + starts[k], size(k)}; }

  std::vector<uint32_t> parent, island_of; /* of each body */
  std::vector<uint32_t> starts, next;
  std::vector<uint32_t> members, ordered; /* in the order of the edges; in that of elimination */
  std::vector<uint8_t> seen;
  std::vector<uint32_t> points;  /* of each island */
  std::vector<Outcome> outcomes; /* of each island */
};

/* The first body of an edge that moves, or INDEX_NONE: such an edge is in no island. */
uint32_t first_moving(const IslandRows &rows, uint32_t edge)
{
  for (const uint32_t body : rows.ends(edge))
    if (rows.moves(body)) return body;
  return INDEX_NONE;
}

void unite_bodies(const IslandRows &rows, std::vector<uint32_t> &parent)
{
  parent.resize(rows.bodies());
  std::iota(parent.begin(), parent.end(), 0u);
  for (uint32_t edge = 0; edge < rows.edges(); ++edge) {
    const uint32_t first = first_moving(rows, edge);
    for (const uint32_t body : rows.ends(edge)) {
      if (!rows.moves(body)) continue;
      const uint32_t one = root_of(parent, first), other = root_of(parent, body);
      parent[std::max(one, other)] = std::min(one, other);
    }
  }
}

/* Calls take(edge, root) for each edge in an island; the root is a body. */
template <class Take> void for_each_edge(const IslandRows &rows, std::vector<uint32_t> &parent, const Take &take)
{
  for (uint32_t edge = 0; edge < rows.edges(); ++edge) {
    const uint32_t body = first_moving(rows, edge);
    if (body != INDEX_NONE) take(edge, root_of(parent, body));
  }
}

/* The edges of each island keep their order; islands are ordered by their first edge. */
void find_islands(const IslandRows &rows, Islands &islands)
{
  islands.reserve(rows.most_edges());
  unite_bodies(rows, islands.parent);
  islands.island_of.assign(rows.bodies(), INDEX_NONE);
  islands.starts.assign(1, 0);
  for_each_edge(rows, islands.parent, [&](uint32_t, uint32_t root) {
    uint32_t &island = islands.island_of[root];
    if (island == INDEX_NONE) {
      island = static_cast<uint32_t>(islands.count());
      islands.starts.push_back(0);
    }
    ++islands.starts[island + 1];
  });
  std::partial_sum(islands.starts.begin(), islands.starts.end(), islands.starts.begin());
  islands.next.assign(islands.starts.begin(), islands.starts.end() - 1);
  islands.members.resize(islands.starts.back());
  islands.ordered.resize(islands.starts.back());
  islands.seen.resize(islands.starts.back());
  islands.points.assign(islands.count(), 0);
  for_each_edge(rows, islands.parent, [&](uint32_t edge, uint32_t root) {
    const uint32_t island = islands.island_of[root];
    islands.members[islands.next[island]++] = edge;
    islands.points[island] += rows.size_of(edge);
  });
}

bool share_moving_body(const IslandRows &rows, uint32_t one, uint32_t other)
{
  const IslandRows::Ends ends = rows.ends(other);
  for (const uint32_t body : rows.ends(one))
    if (rows.moves(body) && std::find(ends.begin(), ends.end(), body) != ends.end()) return true;
  return false;
}

/* Writes the edges by their distance from `start` over shared moving bodies, breadth first, and returns how many it has
 * reached. */
size_t walk_from(const IslandRows &rows, std::span<const uint32_t> edges, size_t start, std::span<uint32_t> order,
                 std::span<uint8_t> seen)
{
  std::fill(seen.begin(), seen.end(), uint8_t{0});
  seen[start] = 1;
  order[0] = edges[start];
  size_t found = 1;
  for (size_t at = 0; at < found; ++at)
    for (size_t k = 0; k < edges.size(); ++k) {
      if (seen[k] || !share_moving_body(rows, order[at], edges[k])) continue;
      seen[k] = 1;
      order[found++] = edges[k];
    }
  return found;
}

/* Orders neighbours near each other, so that the matrix has a small bandwidth (Cuthill and McKee, 1969): a search from
 * the last edge of a first search. */
std::span<const uint32_t> in_narrow_order(const IslandRows &rows, Islands &islands, size_t k)
{
  const std::span<const uint32_t> edges = islands.edges(k);
  const std::span<uint32_t> order = islands.order(k);
  const uint32_t last = order[walk_from(rows, edges, 0, order, islands.marks(k)) - 1];
  const auto end = static_cast<size_t>(std::find(edges.begin(), edges.end(), last) - edges.begin());
  return order.first(walk_from(rows, edges, end, order, islands.marks(k)));
}

/* Whether a contact has a target velocity. */
bool bounces(const IslandRows &rows, std::span<const uint32_t> edges)
{
  for (const uint32_t edge : edges) {
    if (!rows.is_contact(edge)) continue;
    for (uint32_t k = 0; k < 4; ++k)
      if (value_of(rows.restitution[edge], k) >= 0 && value_of(rows.restitution[rows.count + edge], k) > 0) return true;
  }
  return false;
}

Outcome solve_one(IslandRows &rows, Islands &islands, size_t k, uint32_t pass, IslandMemory &memory)
{
  const minicl::ExactFloatingPoint environment;
  if (!islands.is_small(k)) return Outcome::left;
  if (pass == PASS_BOUNCING && !bounces(rows, islands.edges(k))) return Outcome::solved; /* by the passes before */
  Island island(rows, in_narrow_order(rows, islands, k), pass, memory);
  if (!island.is_finite()) return Outcome::left;
  return island.solve() ? Outcome::solved : Outcome::stalled;
}

IslandRows::Outcomes count_outcomes(const Islands &islands, uint32_t stalled_before)
{
  IslandRows::Outcomes values = {0, 0, stalled_before};
  for (size_t k = 0; k < islands.count(); ++k) {
    if (islands.outcomes[k] == Outcome::left) values[1] += static_cast<uint32_t>(islands.size(k));
    else ++values[0];
    if (islands.outcomes[k] == Outcome::stalled) ++values[2];
  }
  return values;
}

/* The memory that it keeps is for as many constraints as the buffers have room for. So a launch allocates only where
 * these have grown, or where there are more bodies or more threads than before. */
class SolveIslands : public CpuKernel {
public:
  void run(const Launch &launch, Memory &memory) override
  {
    try {
      run_pass(launch.values.at(0), memory);
    } catch (...) {
      rows_.forget();
      throw;
    }
  }

private:
  void run_pass(uint32_t pass, Memory &memory);
  void find_small_islands();
  void improve(uint32_t pass, Memory &memory);
  void make_room_for_tasks();
  void solve(uint32_t pass);

  IslandRows rows_;
  Islands islands_;
  bool has_small_islands_ = false;
  std::vector<IslandMemory> memories_; /* one for each task */
};

void SolveIslands::run_pass(uint32_t pass, Memory &memory)
{
  if (rows_.read_graph(memory)) find_small_islands();
  if (rows_.edges() == 0) return;
  islands_.outcomes.assign(islands_.count(), Outcome::left);
  if (has_small_islands_) improve(pass, memory);
  rows_.write_outcomes(memory, count_outcomes(islands_, rows_.stalled()));
}

void SolveIslands::find_small_islands()
{
  find_islands(rows_, islands_);
  has_small_islands_ = false;
  for (size_t k = 0; k < islands_.count(); ++k) has_small_islands_ |= islands_.is_small(k);
  make_room_for_tasks();
}

void SolveIslands::improve(uint32_t pass, Memory &memory)
{
  rows_.read_rest(memory);
  solve(pass);
  if (std::any_of(islands_.outcomes.begin(), islands_.outcomes.end(),
                  [](Outcome outcome) { return outcome != Outcome::left; }))
    rows_.write(memory);
}

/* Tasks allocate nothing, so what fails for want of memory fails here. */
void SolveIslands::make_room_for_tasks()
{
  memories_.resize(std::max(memories_.size(), std::min<size_t>(parts_at_once(), rows_.most_edges())));
  for (IslandMemory &memory : memories_) memory.reserve(rows_.stride, rows_.has_joints());
}

/* Each task takes the next island until none is left, so that there are no more memories than threads. */
void SolveIslands::solve(uint32_t pass)
{
  std::atomic<size_t> next = 0;
  const auto solve_some = [&](IslandMemory &memory) {
    for (size_t k; (k = next.fetch_add(1, std::memory_order_relaxed)) < islands_.count();)
      islands_.outcomes[k] = solve_one(rows_, islands_, k, pass, memory);
  };
  const size_t tasks = std::min(memories_.size(), islands_.count());
  run_parts(tasks, PartFunction([&](size_t task) { solve_some(memories_[task]); }));
}

} // namespace

std::unique_ptr<CpuKernel> make_solve_islands() { return std::make_unique<SolveIslands>(); }

} // namespace tandem
