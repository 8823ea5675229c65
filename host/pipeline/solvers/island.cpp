/* island.cpp - rows of contacts, the dense problem, and its effect; see island.h. Joints: island_joints.cpp. */
#include "host/pipeline/solvers/island.h"

#include <cmath>

namespace tandem {

using namespace in_double;

double *component_of(float4 &r, uint32_t k) { return k == 0 ? &r.x : k == 1 ? &r.y : k == 2 ? &r.z : &r.w; }
double value_of(const float4 &r, uint32_t k) { return k == 0 ? r.x : k == 1 ? r.y : k == 2 ? r.z : r.w; }

Island::Island(IslandRows &rows, std::span<const uint32_t> edges, uint32_t pass, IslandMemory &memory)
    : rows_(rows), edges_(edges), pass_(pass), list_(memory.list), limits_(memory.limits), problem_(memory.problem),
      arena_(memory.arena)
{
  memory.clear();
  for (const uint32_t edge : edges_)
    if (rows_.is_contact(edge)) add_contact(edge);
    else if (rows_.is_joint(edge)) add_joint(rows_.joint_of(edge));
    else add_coupling(rows_.coupling_of(edge));
  problem_.rows = static_cast<uint32_t>(list_.size());
  assemble();
  soften();
}

bool Island::is_finite() const
{
  const auto finite = [](double x) { return std::isfinite(x); };
  for (size_t r = 0; r < problem_.rows; ++r)
    if (!(problem_.matrix[r * problem_.rows + r] > 0)) return false; /* it would divide by 0 */
  return std::all_of(problem_.matrix.begin(), problem_.matrix.end(), finite) &&
         std::all_of(problem_.offset.begin(), problem_.offset.end(), finite) &&
         std::all_of(problem_.impulse.begin(), problem_.impulse.end(), finite);
}

bool Island::solve()
{
  if (problem_.rows == 0) return true;
  const bool converged = solve_island(problem_, arena_).converged;
  apply();
  if (pass_ != PASS_BOUNCING && rows_.bounces()) note_highest();
  return converged;
}

/* Pushes b, and a the other way. */
IslandRow Island::row_between(uint32_t a, uint32_t b, const vec3 &direction, const vec3 &turn_a, const vec3 &turn_b,
                              double &impulse)
{
  IslandRow row;
  row.impulse = &impulse;
  row.add_side(a, negate(direction), negate(turn_a));
  row.add_side(b, direction, turn_b);
  return row;
}

void Island::add_row(const IslandRow &row, double bias)
{
  list_.push_back(row);
  problem_.offset.push_back(bias);
  problem_.impulse.push_back(*row.impulse);
}

void Island::add_contact(uint32_t i)
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
  if (manifold.twists) add_row(row_between(c.a, c.b, {0, 0, 0}, c.normal, c.normal, rows_.friction_impulse[i].z), 0);
  problem_.manifolds.push_back(manifold);
}

/* The complementarity law of one point in this pass, as in normal_impulse() of shared/solve/contact_normals.h but
 * rigid; returns false if the point takes no part. */
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
      add_row(row_between(c.a, c.b, c.normal, s.r_cross_n_a[k], s.r_cross_n_b[k],
                          *component_of(rows_.normal_impulse[i], k)),
              bias);
  }
}

void Island::add_friction(uint32_t i, const contact &c, arm_shift shift)
{
  const vec4 center = load_float4(rows_.center.data(), i), offset = load_float4(rows_.offset.data(), i);
  const vec3 arm_a = add(xyz(center), shift.a), arm_b = add(xyz(center_of_b(center, offset)), shift.b);
  const tangents t = tangents_of(c.normal);
  float4 &kept = rows_.friction_impulse[i];
  add_row(row_between(c.a, c.b, t.first, cross3(arm_a, t.first), cross3(arm_b, t.first), kept.x), 0);
  add_row(row_between(c.a, c.b, t.second, cross3(arm_a, t.second), cross3(arm_b, t.second), kept.y), 0);
}

double Island::speed_of(const IslandRow &row) const
{
  double speed = 0;
  for (uint32_t k = 0; k < row.count; ++k) {
    const RowSide &side = row.sides[k];
    const spatial_velocity moving = load_velocity(rows_.velocity.data(), side.body);
    speed += dot3(side.direction, moving.linear) + dot3(side.turn, moving.angular);
  }
  return speed;
}

/* Computes W and the speeds without any impulse: the present speeds minus the effect of the present impulses. */
void Island::assemble()
{
  const size_t n = problem_.rows;
  problem_.matrix.assign(n * n, 0.0);
  for (size_t r = 0; r < n; ++r)
    for (uint32_t k = 0; k < list_[r].count; ++k) {
      const RowSide &pushed_side = list_[r].sides[k];
      if (!rows_.moves(pushed_side.body)) continue;
      const vec3 turn = rows_.turned_by(pushed_side.body, pushed_side.turn);
      const vec3 pushing = rows_.free_part(pushed_side.body, pushed_side.direction);
      for (size_t s = r; s < n; ++s)
        for (uint32_t l = 0; l < list_[s].count; ++l) {
          const RowSide &side = list_[s].sides[l];
          if (side.body != pushed_side.body) continue;
          problem_.matrix[r * n + s] +=
              rows_.velocity[2 * side.body].w * dot3(pushing, side.direction) + dot3(turn, side.turn);
        }
    }
  for (size_t r = 0; r < n; ++r)
    for (size_t s = r + 1; s < n; ++s) problem_.matrix[s * n + r] = problem_.matrix[r * n + s];
  for (size_t r = 0; r < n; ++r) {
    problem_.offset[r] += speed_of(list_[r]);
    for (size_t s = 0; s < n; ++s) problem_.offset[r] -= problem_.matrix[s * n + r] * problem_.impulse[s];
  }
}

void Island::soften()
{
  const size_t n = problem_.rows;
  for (size_t r = 0; r < n; ++r) {
    double &own = problem_.matrix[r * n + r];
    const IslandRow &row = list_[r];
    const double most = row.kept_speed / own;
    problem_.offset[r] -= row.change_share * own * std::clamp(problem_.impulse[r], -most, most);
    own += (row.share + row.change_share) * own + row.compliance;
  }
}

void Island::push(const RowSide &side, double impulse)
{
  if (!rows_.moves(side.body)) return;
  spatial_velocity m = load_velocity(rows_.velocity.data(), side.body);
  m.linear = pushed(m.linear, rows_.locks(side.body), side.direction, m.inverse_mass * impulse);
  m.angular = add_scaled(m.angular, rows_.turned_by(side.body, side.turn), impulse);
  store_velocity(rows_.velocity.data(), side.body, m);
}

void Island::apply()
{
  for (size_t r = 0; r < list_.size(); ++r) {
    const double change = problem_.impulse[r] - *list_[r].impulse;
    if (change == 0) continue;
    *list_[r].impulse = problem_.impulse[r];
    for (uint32_t k = 0; k < list_[r].count; ++k) push(list_[r].sides[k], change);
  }
  for (const LimitRows &limit : limits_)
    if (limit.impulse) *limit.impulse = limit.lower - limit.upper;
}

/* Only points that carried an impulse in some pass may get restitution. */
void Island::note_highest()
{
  for (const uint32_t edge : edges_) {
    if (!rows_.is_contact(edge)) continue;
    for (uint32_t k = 0; k < 4; ++k) {
      double *const highest = component_of(rows_.restitution[rows_.count + edge], k);
      *highest = std::max(*highest, value_of(rows_.normal_impulse[edge], k));
    }
  }
}

} // namespace tandem
