/* island_joints.cpp - the rows of joints and couplings in the dense problem of an island; see island.h.
 *
 * They are those of shared/joints/, with some differences. They are nearly rigid: in a pass with bias a row yields by a
 * ten-thousandth of its own response, so that joints that contradict each other pull with a bounded force. A row that
 * moves next to nothing takes no part. The rows of a limit are two, one for each end; a soft one that is still ahead
 * keeps the impulse of the iterative pass.
 *
 * Motors are weaker than all that holds. A motor yields to a hundredth, but only to changes of its impulse, so that it
 * does not creep under a load, until that impulse would give what it turns 200 rad/s in a substep: a load of thousands
 * of times its mass, or something that it can never move. It is no faster than limits and speed of its axis let it be.
 */
#include <cmath>
#include <limits>

#include "host/pipeline/solvers/island.h"

namespace tandem {
namespace {

using namespace in_double;

constexpr double joint_share = 1e-4, motor_share = 1e-2, motor_kept_speed = 200;
/* A row whose response is below the rounding of its bodies' tensors takes no part, as a lock or inertia without end
 * leaves it none. */
constexpr double least_response = 0x1p-22;
constexpr double unbounded = std::numeric_limits<double>::infinity();
/* A limit that is farther away than this, m or rad, is none: kernels have a number in place of an infinite one. */
constexpr double farthest_limit = 1e20;

vec3 axis_of(const mat3 &axes, uint32_t k) { return k == 0 ? axis_x(axes) : k == 1 ? axis_y(axes) : axis_z(axes); }
double entry_of(const vec3 &v, uint32_t k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; }
vec3 unit_vector(uint32_t k) { return {k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0}; }

IslandRow opposite_of(IslandRow row)
{
  for (uint32_t k = 0; k < row.count; ++k) {
    row.sides[k].direction = negate(row.sides[k].direction);
    row.sides[k].turn = negate(row.sides[k].turn);
  }
  return row;
}

/* Pushes side b at the origin of frame b, and a the other way. */
IslandRow row_of_joint(const joint &j, const vec3 &direction, const vec3 &moment_a, const vec3 &moment_b)
{
  IslandRow row;
  if (!j.a.is_world) row.add_side(j.a.body, negate(direction), negate(moment_a));
  if (!j.b.is_world) row.add_side(j.b.body, direction, moment_b);
  return row;
}

/* The speed at which a row closes what is open, in a pass with bias. */
double closing_of(const Parameters &parameters, double open)
{
  const double push = parameters.joint_bias_rate * open;
  return push * share_of_closing(push);
}

/* The speed up to which a motor may go towards a limit that is `open` away, so that it does not contradict the limit.
 */
double speed_to(const Parameters &parameters, double open, uint32_t pass)
{
  if (open > 0) return open * parameters.inverse_substep;
  return pass == PASS_BIASED ? closing_of(parameters, open) : 0;
}

/* A spring and damper over a substep, as rows have it: speed + bias + compliance * impulse = 0. */
struct ImplicitSpring {
  double compliance = 0, bias = 0;
  bool acts = false;
};
ImplicitSpring spring_of(const Parameters &parameters, double stiffness, double damping, double open,
                         double target_speed)
{
  const double sum = damping + parameters.substep * stiffness;
  if (!(sum > 0)) return {};
  return {parameters.inverse_substep / sum, (stiffness * open - damping * target_speed) / sum, true};
}

} // namespace

bool Island::responds(const IslandRow &row) const
{
  double response = 0, free = 0;
  for (uint32_t k = 0; k < row.count; ++k) {
    const RowSide &side = row.sides[k];
    if (!rows_.moves(side.body)) continue;
    const double inverse_mass = rows_.velocity[2 * side.body].w;
    response += inverse_mass * dot3(rows_.free_part(side.body, side.direction), side.direction) +
                dot3(rows_.turned_by(side.body, side.turn), side.turn);
    double trace = 0;
    for (uint32_t l = 0; l < 3; ++l) trace += entry_of(rows_.turned_by(side.body, unit_vector(l)), l);
    free += inverse_mass * dot3(side.direction, side.direction) + trace * dot3(side.turn, side.turn);
  }
  return response > least_response * free;
}

void Island::add_bounded(const IslandRow &row, double bias, double lower, double upper)
{
  if (!responds(row)) return;
  problem_.bounded.push_back({static_cast<uint32_t>(list_.size()), lower, upper});
  add_row(row, bias);
}

/* A row that closes a gap in a pass with bias, and rests in others. lower: of its impulse. */
void Island::add_position(IslandRow row, double closing, double lower)
{
  const bool biased = pass_ == PASS_BIASED;
  if (biased) row.share = joint_share;
  add_bounded(row, biased ? closing : 0, lower, unbounded);
}

void Island::add_joint(uint32_t i)
{
  const read_turning_bodies bodies = rows_.turning_bodies();
  const joint j = load_joint(&rows_.parameters, rows_.tables.joints(), bodies, rows_.velocity.data(), i);
  const joint_frames f = frames_of(&rows_.parameters, j, rows_.tables.joints(), i);
  if (HAS_FEATURE(&rows_.parameters, JOINT_AXES)) add_axes(i, j, f);
  add_angular_block(i, j, f);
  add_linear_block(i, j, f);
}

void Island::add_angular_block(uint32_t i, const joint &j, const joint_frames &f)
{
  const uint32_t locked = j.modes >> JOINT_ANGULAR_SHIFT;
  if (locked == 0) return;
  const vec3 open = along_axes(locked, turn_between(f.relative, locked));
  const vec3 closing = soft_rows_of(plain_softness(&rows_.parameters), open, JOINT_CLOSING, LEAST_LEAK).closing;
  for (uint32_t k = 0; k < 3; ++k) {
    if (!(locked >> k & 1)) continue;
    const vec3 axis = axis_of(f.axes, k);
    IslandRow row = row_of_joint(j, {0, 0, 0}, axis, axis);
    row.impulse = component_of(rows_.tables.angular[i], k);
    add_position(row, entry_of(closing, k), -unbounded);
  }
}

void Island::add_linear_block(uint32_t i, const joint &j, const joint_frames &f)
{
  const uint32_t locked = j.modes & JOINT_XYZ;
  const bool whole = locked == JOINT_XYZ; /* in axes of the world */
  const vec3 open = whole ? j.gap : along_axes(locked, rotate_back(f.axes, j.gap));
  const vec3 closing = soft_rows_of(plain_softness(&rows_.parameters), open, JOINT_CLOSING, LEAST_LEAK).closing;
  for (uint32_t k = 0; k < 3; ++k) {
    if (!(locked >> k & 1)) continue;
    const vec3 axis = whole ? unit_vector(k) : axis_of(f.axes, k);
    IslandRow row = row_of_joint(j, axis, cross3(j.a.arm, axis), cross3(j.b.arm, axis));
    row.impulse = component_of(rows_.tables.linear[i], k);
    add_position(row, entry_of(closing, k), -unbounded);
  }
}

void Island::add_axes(uint32_t i, const joint &j, const joint_frames &f)
{
  for (uint32_t k = 0; k < rows_.parameters.joint_axes; ++k) {
    const joint_axis axis = load_axis(&rows_.parameters, rows_.tables.axes(), k, i);
    if (axis.kind == JOINT_AXIS_NONE) continue;
    const axis_row r = row_of_axis(j, f, axis.kind);
    const IslandRow along = row_of_joint(j, r.at.direction, r.moment_a, r.moment_b);
    float4 &kept = rows_.tables.axis[joint_plane(&rows_.parameters, k) + i];
    const double value = value_near_range(&r, &axis);
    add_drive(along, axis, value, kept);
    add_friction_of_axis(along, axis, kept);
    add_largest_speed(along, axis.largest_speed);
    add_limits(along, axis, value, kept);
  }
}

void Island::add_motor(IslandRow row, const joint_axis &axis, double value, double most)
{
  double target = std::clamp(axis.target_speed, -axis.largest_speed, axis.largest_speed);
  if (!(axis.limit_stiffness > 0)) {
    if (axis.lower == axis.upper) return; /* it is held there */
    target = std::min(target, speed_to(rows_.parameters, axis.upper - value, pass_));
    target = std::max(target, -speed_to(rows_.parameters, value - axis.lower, pass_));
  }
  row.change_share = motor_share;
  row.kept_speed = motor_kept_speed;
  add_bounded(row, -target, -most, most);
}

void Island::add_drive(const IslandRow &along, const joint_axis &axis, double value, float4 &kept)
{
  IslandRow row = along;
  row.impulse = &kept.x;
  const double most = axis.largest_force * rows_.parameters.substep;
  if (axis.damping < 0) {
    add_motor(row, axis, value, most);
    return;
  }
  const double open = distance_from(kept.w, axis.target, is_rotation(axis.kind));
  const ImplicitSpring spring = spring_of(rows_.parameters, axis.stiffness, axis.damping, open, axis.target_speed);
  if (!spring.acts) return;
  row.compliance = spring.compliance;
  add_bounded(row, spring.bias, -most, most);
}

void Island::add_friction_of_axis(const IslandRow &along, const joint_axis &axis, float4 &kept)
{
  const double most = axis.friction * rows_.parameters.substep;
  if (!(most > 0)) return;
  IslandRow row = along;
  row.impulse = &kept.z;
  add_bounded(row, 0, -most, most);
}

/* What brakes it is kept by no pass, and so begins at 0. */
void Island::add_largest_speed(const IslandRow &along, double largest)
{
  if (largest > farthest_limit) return;
  LimitRows &limit = limits_.emplace_back();
  IslandRow row = along;
  row.impulse = &limit.lower;
  add_bounded(row, largest, 0, unbounded);
  row = opposite_of(along);
  row.impulse = &limit.upper;
  add_bounded(row, largest, 0, unbounded);
}

void Island::add_limits(const IslandRow &along, const joint_axis &axis, double value, float4 &kept)
{
  IslandRow row = along;
  if (axis.lower == axis.upper) {
    row.impulse = &kept.y;
    add_held(row, value - axis.lower, axis);
    return;
  }
  LimitRows &limit = limits_.emplace_back();
  limit.lower = std::max(kept.y, 0.0);
  limit.upper = std::max(-kept.y, 0.0);
  limit.impulse = &kept.y;
  row.impulse = &limit.lower;
  add_stop(row, axis, value - axis.lower);
  row = opposite_of(along);
  row.impulse = &limit.upper;
  add_stop(row, axis, axis.upper - value);
}

/* lower: of its impulse. */
void Island::add_soft_limit(IslandRow row, const joint_axis &axis, double open, double lower)
{
  const ImplicitSpring spring = spring_of(rows_.parameters, axis.limit_stiffness, axis.limit_damping, open, 0);
  row.compliance = spring.compliance;
  add_bounded(row, spring.bias, lower, unbounded);
}

void Island::add_held(IslandRow row, double open, const joint_axis &axis)
{
  if (axis.limit_stiffness > 0) add_soft_limit(row, axis, open, -unbounded);
  else add_position(row, closing_of(rows_.parameters, open), -unbounded);
}

/* One end of a range. open: the way that is left, negative beyond it. */
void Island::add_stop(IslandRow row, const joint_axis &axis, double open)
{
  if (open > farthest_limit) return;
  const bool ahead = open > 0;
  if (axis.limit_stiffness > 0) {
    if (!ahead) add_soft_limit(row, axis, open, 0);
    return;
  }
  if (!ahead) add_position(row, closing_of(rows_.parameters, open), 0);
  else if (pass_ == PASS_BIASED || *row.impulse > 0)
    add_bounded(row, open * rows_.parameters.inverse_substep, 0, unbounded);
}

void Island::add_coupling(uint32_t i)
{
  const coupling c = load_coupling(&rows_.parameters, rows_.tables.couplings(), rows_.tables.joints(),
                                   rows_.turning_bodies(), rows_.velocity.data(), i);
  if (!c.awake) return;
  IslandRow row;
  for (const coupled_side *side : {&c.aa, &c.ab, &c.ba, &c.bb})
    if (side->acts && !side->side.is_world) row.add_side(side->side.body, side->impulse, side->moment);
  row.impulse = &rows_.tables.coupling_impulse[i];
  const bool one_sided = (rows_.tables.coupling_kind[i] & COUPLING_ONE_SIDED) != 0;
  joint_axis rigid{};
  if (one_sided) add_stop(row, rigid, c.open);
  else add_held(row, c.open, rigid);
}

} // namespace tandem
