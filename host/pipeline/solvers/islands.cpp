/* islands.cpp - finds islands, writes each as a dense problem, and stores the solution; see islands.h. */
#include "host/pipeline/solvers/islands.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "host/base/arena.h"
#include "host/pipeline/solvers/island_rows.h"
#include "host/pipeline/solvers/island_solver.h"
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

/* Constraints by island. Each list of all constraints has the range [starts[k], starts[k + 1]) for island k. */
struct Islands {
  void reserve(size_t most_constraints)
  {
    starts.reserve(most_constraints + 1);
    for (std::vector<uint32_t> *list : {&next, &members, &ordered}) list->reserve(most_constraints);
    seen.reserve(most_constraints);
    points.reserve(most_constraints);
    outcomes.reserve(most_constraints);
  }

  size_t count() const { return starts.size() - 1; }
  size_t size(size_t k) const { return starts[k + 1] - starts[k]; }
  bool is_small(size_t k) const { return points[k] <= most_island_points; }
  std::span<const uint32_t> constraints(size_t k) const { return {members.data() + starts[k], size(k)}; }
  std::span<uint32_t> order(size_t k) { return {ordered.data() + starts[k], size(k)}; }
  std::span<uint8_t> marks(size_t k) { return {seen.data() + starts[k], size(k)}; }

  std::vector<uint32_t> parent, island_of; /* of each body */
  std::vector<uint32_t> starts, next;
  std::vector<uint32_t> members, ordered; /* in the order of the constraints; in that of elimination */
  std::vector<uint8_t> seen;
  std::vector<uint32_t> points;  /* of each island */
  std::vector<Outcome> outcomes; /* of each island */
};

void unite_bodies(const IslandRows &rows, std::vector<uint32_t> &parent)
{
  parent.resize(rows.bodies());
  std::iota(parent.begin(), parent.end(), 0u);
  for (uint32_t i = 0; i < rows.count; ++i)
    if (rows.moves(rows.a[i]) && rows.moves(rows.b[i])) {
      const uint32_t one = root_of(parent, rows.a[i]), other = root_of(parent, rows.b[i]);
      parent[std::max(one, other)] = std::min(one, other);
    }
}

/* The constraints of each island keep the order of the constraints; islands are ordered by their first constraint. */
void find_islands(const IslandRows &rows, Islands &islands)
{
  islands.reserve(rows.stride);
  unite_bodies(rows, islands.parent);
  const auto root = [&](uint32_t i) { return root_of(islands.parent, rows.moves(rows.a[i]) ? rows.a[i] : rows.b[i]); };
  islands.island_of.assign(rows.bodies(), INDEX_NONE);
  islands.starts.assign(1, 0);
  for (uint32_t i = 0; i < rows.count; ++i) {
    uint32_t &island = islands.island_of[root(i)];
    if (island == INDEX_NONE) {
      island = static_cast<uint32_t>(islands.count());
      islands.starts.push_back(0);
    }
    ++islands.starts[island + 1];
  }
  std::partial_sum(islands.starts.begin(), islands.starts.end(), islands.starts.begin());
  islands.next.assign(islands.starts.begin(), islands.starts.end() - 1);
  islands.members.resize(rows.count);
  for (uint32_t i = 0; i < rows.count; ++i) islands.members[islands.next[islands.island_of[root(i)]]++] = i;
  islands.ordered.resize(rows.count);
  islands.seen.resize(rows.count);
  islands.points.assign(islands.count(), 0);
  for (uint32_t i = 0; i < rows.count; ++i) islands.points[islands.island_of[root(i)]] += rows.points_of(i);
}

/* Writes the constraints by their distance from `start` over shared moving bodies, breadth first, and returns how many
 * it has reached. */
size_t walk_from(const IslandRows &rows, std::span<const uint32_t> constraints, size_t start, std::span<uint32_t> order,
                 std::span<uint8_t> seen)
{
  const auto touch = [&](uint32_t one, uint32_t other) {
    for (uint32_t body : {rows.a[one], rows.b[one]})
      if (rows.moves(body) && (body == rows.a[other] || body == rows.b[other])) return true;
    return false;
  };
  std::fill(seen.begin(), seen.end(), uint8_t{0});
  seen[start] = 1;
  order[0] = constraints[start];
  size_t found = 1;
  for (size_t at = 0; at < found; ++at)
    for (size_t k = 0; k < constraints.size(); ++k) {
      if (seen[k] || !touch(order[at], constraints[k])) continue;
      seen[k] = 1;
      order[found++] = constraints[k];
    }
  return found;
}

/* Orders neighbours near each other, so that the matrix has a small bandwidth (Cuthill and McKee, 1969): a search from
 * the last constraint of a first search. */
std::span<const uint32_t> in_narrow_order(const IslandRows &rows, Islands &islands, size_t k)
{
  const std::span<const uint32_t> constraints = islands.constraints(k);
  const std::span<uint32_t> order = islands.order(k);
  const uint32_t last = order[walk_from(rows, constraints, 0, order, islands.marks(k)) - 1];
  const auto end = static_cast<size_t>(std::find(constraints.begin(), constraints.end(), last) - constraints.begin());
  return order.first(walk_from(rows, constraints, end, order, islands.marks(k)));
}

/* --- rows of a constraint -------------------------------------------------------------------------- */

/* speed = direction . (v_b - v_a) + r_cross_n_b . w_b - r_cross_n_a . w_a */
struct Row {
  uint32_t a, b;
  vec3 direction, r_cross_n_a, r_cross_n_b;
  double *impulse; /* where it is stored */
};

/* A manifold has at most four points, and three rows beside theirs. An island has most rows where each point is a
 * manifold of its own. */
constexpr size_t most_constraint_rows = 7, most_island_rows = 4 * most_island_points;

/* What the solution of one island takes. A task keeps it for the islands of this launch and of later ones. */
struct IslandMemory {
  void reserve(size_t most_constraints)
  {
    const size_t rows = std::min(most_constraint_rows * most_constraints, most_island_rows);
    list.reserve(rows);
    problem.matrix.reserve(rows * rows);
    problem.offset.reserve(rows);
    problem.impulse.reserve(rows);
    problem.manifolds.reserve(std::min<size_t>(most_constraints, most_island_points));
    arena.reserve(island_solver_bytes(rows));
  }
  void clear()
  {
    list.clear();
    problem.offset.clear();
    problem.impulse.clear();
    problem.manifolds.clear();
  }

  std::vector<Row> list;
  IslandProblem problem;
  Arena arena;
};

class Island {
public:
  Island(IslandRows &rows, std::span<const uint32_t> constraints, uint32_t pass, IslandMemory &memory)
      : rows_(rows), constraints_(constraints), pass_(pass), list_(memory.list), problem_(memory.problem),
        arena_(memory.arena)
  {
    memory.clear();
    for (uint32_t i : constraints_) add_constraint(i);
    problem_.rows = static_cast<uint32_t>(list_.size());
    assemble();
  }

  bool is_finite() const
  {
    const auto finite = [](double x) { return std::isfinite(x); };
    return std::all_of(problem_.matrix.begin(), problem_.matrix.end(), finite) &&
           std::all_of(problem_.offset.begin(), problem_.offset.end(), finite) &&
           std::all_of(problem_.impulse.begin(), problem_.impulse.end(), finite);
  }

  /* Returns false if the solver stalled. */
  bool solve()
  {
    if (problem_.rows == 0) return true;
    const bool converged = solve_island(problem_, arena_).converged;
    apply();
    if (pass_ != PASS_BOUNCING && rows_.bounces()) note_highest();
    return converged;
  }

private:
  void add_constraint(uint32_t i);
  void add_normals(uint32_t i, const contact &c, const normal_rows &s, const delta_pose &moved);
  void add_friction(uint32_t i, const contact &c, arm_shift shift);
  void add_row(const Row &row, double bias);
  bool normal_row(uint32_t i, uint32_t k, double separation, double rate, double &bias) const;
  void assemble();
  void apply();
  void note_highest();
  double speed_of(const Row &r) const;
  void push(uint32_t body, const vec3 &direction, const vec3 &turn, double impulse);

  IslandRows &rows_;
  std::span<const uint32_t> constraints_;
  uint32_t pass_;
  std::vector<Row> &list_;
  IslandProblem &problem_;
  Arena &arena_;
};

double *component_of(float4 &r, uint32_t k) { return k == 0 ? &r.x : k == 1 ? &r.y : k == 2 ? &r.z : &r.w; }
double value_of(const float4 &r, uint32_t k) { return k == 0 ? r.x : k == 1 ? r.y : k == 2 ? r.z : r.w; }

void Island::add_row(const Row &row, double bias)
{
  list_.push_back(row);
  problem_.offset.push_back(bias);
  problem_.impulse.push_back(*row.impulse);
}

void Island::add_constraint(uint32_t i)
{
  const contact c = load_contact(&rows_.parameters, {rows_.a.data(), rows_.b.data(), rows_.normal.data()},
                                 rows_.velocity.data(), rows_.inertia.data(), i);
  const delta_pose moved = load_delta_pose(rows_.delta.data(), c);
  const arm_shift shift = shift_of_contact(c, moved.translation);
  const float4 old = rows_.normal_impulse[i];
  const point_planes planes{rows_.count, 4};
  const normal_rows s = load_normal_rows(rows_.points.data(), planes, c, load_float4(rows_.offset.data(), i), shift,
                                         make_vec4(old.x, old.y, old.z, old.w), i);
  ManifoldRows manifold;
  manifold.first = static_cast<uint32_t>(list_.size());
  add_normals(i, c, s, moved);
  manifold.normals = static_cast<uint32_t>(list_.size()) - manifold.first;
  if (manifold.normals == 0) return;
  manifold.friction = c.friction;
  manifold.twist_radius = rows_.friction_impulse[i].w;
  manifold.slides = c.friction > 0 && rows_.center[i].w > 0;
  manifold.twists = c.friction > 0 && manifold.twist_radius > 0 && rows_.offset[i].w > 0;
  if (manifold.slides) add_friction(i, c, shift);
  if (manifold.twists) add_row({c.a, c.b, {0, 0, 0}, c.normal, c.normal, &rows_.friction_impulse[i].z}, 0);
  problem_.manifolds.push_back(manifold);
}

/* The complementarity law of one point in this pass, as in normal_impulse() of shared/solve/contact.h but rigid;
 * returns false if the point takes no part. */
bool Island::normal_row(uint32_t i, uint32_t k, double separation, double rate, double &bias) const
{
  const Parameters &p = rows_.parameters;
  const double old = value_of(rows_.normal_impulse[i], k);
  const bool ahead = separation > 0;
  if (pass_ == PASS_BIASED) {
    const double slop = slop_of(rows_.slop[i]), limit = push_limit(&p, rows_.slop[i]);
    bias = ahead ? separation * p.inverse_substep : maximum(rate * minimum(separation + slop, 0.0), -limit);
    return true;
  }
  bias = ahead ? separation * p.inverse_substep : 0.0;
  if (pass_ == PASS_BOUNCING) {
    const double target_velocity = value_of(rows_.restitution[i], k);
    const double highest = value_of(rows_.restitution[rows_.count + i], k);
    if (target_velocity >= 0 && highest > 0) {
      bias = -target_velocity;
      return true;
    }
  }
  return !(ahead && old == 0);
}

void Island::add_normals(uint32_t i, const contact &c, const normal_rows &s, const delta_pose &moved)
{
  const double rate = softness_of(&rows_.parameters, c).rate, closed = dot3(c.normal, moved.translation);
  for (uint32_t k = 0; k < 4; ++k) {
    if (!(s.mass[k] > 0)) continue;
    const double separation = rows_.of_point(i, k, POINT_SEPARATION) + closed +
                              (dot3(s.r_cross_n_b[k], moved.rotation_b) - dot3(s.r_cross_n_a[k], moved.rotation_a));
    double bias = 0;
    if (normal_row(i, k, separation, rate, bias))
      add_row({c.a, c.b, c.normal, s.r_cross_n_a[k], s.r_cross_n_b[k], component_of(rows_.normal_impulse[i], k)}, bias);
  }
}

void Island::add_friction(uint32_t i, const contact &c, arm_shift shift)
{
  const vec4 center = load_float4(rows_.center.data(), i), offset = load_float4(rows_.offset.data(), i);
  const vec3 arm_a = add(xyz(center), shift.a), arm_b = add(xyz(center_of_b(center, offset)), shift.b);
  const tangents t = tangents_of(c.normal);
  float4 &kept = rows_.friction_impulse[i];
  add_row({c.a, c.b, t.first, cross3(arm_a, t.first), cross3(arm_b, t.first), &kept.x}, 0);
  add_row({c.a, c.b, t.second, cross3(arm_a, t.second), cross3(arm_b, t.second), &kept.y}, 0);
}

double Island::speed_of(const Row &r) const
{
  const spatial_velocity one = load_velocity(rows_.velocity.data(), r.a),
                         other = load_velocity(rows_.velocity.data(), r.b);
  return dot3(r.direction, subtract(other.linear, one.linear)) + dot3(r.r_cross_n_b, other.angular) -
         dot3(r.r_cross_n_a, one.angular);
}

/* Computes W and the speeds without any impulse: the present speeds minus the effect of the present impulses. */
void Island::assemble()
{
  const size_t n = problem_.rows;
  problem_.matrix.assign(n * n, 0.0);
  for (size_t r = 0; r < n; ++r)
    for (const bool second : {false, true}) {
      const uint32_t body = second ? list_[r].b : list_[r].a;
      if (!rows_.moves(body)) continue;
      const vec3 turn = rows_.turned_by(body, second ? list_[r].r_cross_n_b : list_[r].r_cross_n_a);
      const vec3 pushing = rows_.free_part(body, list_[r].direction);
      for (size_t s = r; s < n; ++s) {
        if (list_[s].a != body && list_[s].b != body) continue;
        const bool other = list_[s].b == body;
        const double value = rows_.velocity[2 * body].w * dot3(pushing, list_[s].direction) +
                             dot3(turn, other ? list_[s].r_cross_n_b : list_[s].r_cross_n_a);
        problem_.matrix[r * n + s] += other == second ? value : -value;
      }
    }
  for (size_t r = 0; r < n; ++r)
    for (size_t s = r + 1; s < n; ++s) problem_.matrix[s * n + r] = problem_.matrix[r * n + s];
  for (size_t r = 0; r < n; ++r) {
    problem_.offset[r] += speed_of(list_[r]);
    for (size_t s = 0; s < n; ++s) problem_.offset[r] -= problem_.matrix[s * n + r] * problem_.impulse[s];
  }
}

void Island::push(uint32_t body, const vec3 &direction, const vec3 &turn, double impulse)
{
  if (!rows_.moves(body)) return;
  spatial_velocity m = load_velocity(rows_.velocity.data(), body);
  m.linear = pushed(m.linear, rows_.locks(body), direction, m.inverse_mass * impulse);
  m.angular = add_scaled(m.angular, rows_.turned_by(body, turn), impulse);
  store_velocity(rows_.velocity.data(), body, m);
}

void Island::apply()
{
  for (size_t r = 0; r < list_.size(); ++r) {
    const double change = problem_.impulse[r] - *list_[r].impulse;
    if (change == 0) continue;
    *list_[r].impulse = problem_.impulse[r];
    push(list_[r].a, list_[r].direction, list_[r].r_cross_n_a, -change);
    push(list_[r].b, list_[r].direction, list_[r].r_cross_n_b, change);
  }
}

/* Only points that carried an impulse in some pass may get restitution. */
void Island::note_highest()
{
  for (uint32_t i : constraints_)
    for (uint32_t k = 0; k < 4; ++k) {
      double *const highest = component_of(rows_.restitution[rows_.count + i], k);
      *highest = std::max(*highest, value_of(rows_.normal_impulse[i], k));
    }
}

Outcome solve_one(IslandRows &rows, Islands &islands, size_t k, uint32_t pass, IslandMemory &memory)
{
  const minicl::ExactFloatingPoint environment;
  if (!islands.is_small(k)) return Outcome::left;
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
  if (rows_.count == 0) return;
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
  memories_.resize(std::max(memories_.size(), std::min<size_t>(parts_at_once(), rows_.stride)));
  for (IslandMemory &memory : memories_) memory.reserve(rows_.stride);
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
