/* load_rate.h - the rate of substeps that what a joint bears needs, where a world chooses its substeps.
 *
 *   opening   A soft joint whose force accelerates its bodies by a against each other is open by a / w^2, and joints
 *             may be as stiff as w h = 2 pi / 4, h the substep.
 *   curving   The end of an arm r of a body that spins at w leaves its circle by r w^2 h^2 / 2 in a substep, and so
 *             does what circles at the end of a rod. A pass closes a share of what is open.
 *   turning   The force T of a joint that pulls at the end of an arm r turns a body back as a spring of T r does, and
 *             Euler's method of a spring is stable for sqrt(T r / J) h < 2, J the moment of inertia.
 *
 *        ( J )-----r----->o---> T
 *
 * A load is what a joint bore in the last substep of this step, but no more than twice that of the step before, because
 * blows last a substep, and their forces grow with the rate of substeps. The first step of a world has none before it,
 * and ends while loads still come along chains. docs/stability.md has the cases that gave the bounds.
 */
#ifndef TANDEM_SHARED_JOINTS_LOAD_RATE_H
#define TANDEM_SHARED_JOINTS_LOAD_RATE_H

#include "shared/joints/solve.h"
#include "shared/load_rate.h"

/* (w h)^2 of the stiffest joints, 2 pi / 4, and of those of a crowd, 2 pi 0.19. */
#define STIFFEST_JOINT R(2.4674011)
#define STIFFEST_IN_CROWD R(1.4251708)
/* Half of 1 / the share of what is open that a pass of the stiffest joints closes, 0.28. */
#define LEFT_OPEN R(1.77)
/* What gaps may be, of what contacts are deep at rest; and rad, what held rotations may give way by. */
#define BEARABLE_GAP R(0.5)
#define BEARABLE_TURN R(0.01)
/* How much loads may grow in a step, and from the end of the first step on. */
#define GROWTH_OF_LOADS R(2.0)
#define LOAD_TO_COME R(4.0)

/* What a joint bears, N and N m in axes of the world: its held rows, and the pull of all that it has. */
typedef struct {
  vec3 force, moment;
  real pull;
} joint_load;

/* per_second: what makes forces of the impulses. */
SHARED joint_load load_borne(GLOBAL const Parameters *parameters, joint j, joint_frames f, read_joint_axes axes,
                             joint_impulses p, GLOBAL const float4 *of_axes, real per_second, item_index i)
{
  joint_wrench w = joint_wrench_of(parameters, j, f, p);
  joint_load load = {scale(w.impulse, per_second), make_vec3(R(0.0), R(0.0), R(0.0)), R(0.0)};
  if (HAS_FEATURE(parameters, JOINT_FRAMES)) load.moment = scale(rotate(f.axes, p.angular), per_second);
  if (HAS_FEATURE(parameters, JOINT_AXES)) w = with_wrench_of_axes(parameters, j, f, axes, of_axes, w, i);
  load.pull = length_of(w.impulse) * per_second;
  return load;
}

/* The vector, or as much of it as is no longer than the other. */
SHARED vec3 no_longer_than(vec3 v, vec3 other)
{
  real squared = length_squared(v), most = length_squared(other);
  mask longer = squared > most;
  return scale(v, choose(longer, square_root(most / choose(longer, squared, (real)R(1.0))), (real)R(1.0)));
}

SHARED joint_load limited_load(joint_load load, joint_load most)
{
  joint_load limited = {no_longer_than(load.force, most.force), no_longer_than(load.moment, most.moment),
                        minimum(load.pull, most.pull)};
  return limited;
}

/* The square of the rate of substeps, 1/s^2, at which the stiffest joint gives way by `bearable`. give: how fast its
 * force moves the coordinate that it holds, m/s^2 or rad/s^2. */
SHARED real rate_of_opening(real give, real bearable, mask crowded)
{
  return give / (bearable * choose(crowded, (real)STIFFEST_IN_CROWD, (real)STIFFEST_JOINT));
}

/* How fast the force moves what it holds, along itself. */
SHARED real give_along(symmetric3 response, vec3 force)
{
  real size = length_of(force);
  mask acts = size > R(0.0);
  return choose(acts, dot3(force, symmetric_times(response, force)) / choose(acts, size, (real)R(1.0)), (real)R(0.0));
}

SHARED real rate_of_held(joint j, const joint_load *load, real way)
{
  mask crowded = is_crowded(&j);
  symmetric3 response = add_symmetric(response_of_side(j.a), response_of_side(j.b)),
             turning = add_symmetric(scaled_tensor(j.a.inertia, j.a.sharing), scaled_tensor(j.b.inertia, j.b.sharing));
  return maximum(rate_of_opening(give_along(response, load->force), way, crowded),
                 rate_of_opening(give_along(turning, load->moment), BEARABLE_TURN, crowded));
}

/* The mean of the inverse moments about the two axes across the arm, times T r. */
SHARED real rate_of_turning(joint_side s, real pull)
{
  real squared = length_squared(s.arm), arm = square_root(squared);
  real across = (s.inertia.xx + s.inertia.yy + s.inertia.zz) * squared - dot3(s.arm, symmetric_times(s.inertia, s.arm));
  mask has_arm = arm > R(0.0);
  return choose(has_arm, R(0.5) * across / choose(has_arm, arm, (real)R(1.0)) * pull, (real)R(0.0));
}

/* By how fast the ends of both arms leave their circles against each other. */
SHARED real rate_of_curving(joint j, real way)
{
  vec3 w_a = j.a.velocity.angular, w_b = j.b.velocity.angular, arm_a = subtract(j.a.arm, j.gap);
  vec3 of_a = cross3(w_a, cross3(w_a, arm_a)), of_b = cross3(w_b, cross3(w_b, j.b.arm));
  return LEFT_OPEN * length_of(subtract(of_b, of_a)) / way;
}

/* What limits may give way by. What a rod holds circles. */
SHARED real bearable_of_axis(uint_lanes kind, real way)
{
  mask is_rod = kind == (uint_lanes)(uint)JOINT_AXIS_DISTANCE;
  real of_rod = way / (R(1.0) + LEFT_OPEN * STIFFEST_JOINT);
  return choose(is_rotation(kind), (real)BEARABLE_TURN, choose(is_rod, of_rod, way));
}

/* most: impulses of which only `growth` times as much counts. Limits that are springs give way as they are told to. */
SHARED real rate_of_limits(GLOBAL const Parameters *parameters, joint j, joint_frames f, read_joint_axes axes,
                           GLOBAL const float4 *impulse, GLOBAL const float4 *most, real growth, real way, item_index i)
{
  real rate = R(0.0);
  for (uint k = 0; k < parameters->joint_axes; ++k) {
    joint_axis axis = load_axis(parameters, axes, k, i);
    item_index at = joint_plane(parameters, k) + i;
    real limited = minimum(magnitude(load_float4(impulse, at).y), growth * magnitude(load_float4(most, at).y));
    mask rigid = (axis.kind != (uint_lanes)(uint)JOINT_AXIS_NONE) & !(axis.limit_stiffness > R(0.0));
    if (!any_of(rigid & (limited > R(0.0)))) continue;
    axis_row r = row_of_axis(j, f, axis.kind);
    real give = limited * parameters->inverse_substep * r.shared_response;
    rate = choose(rigid, maximum(rate, rate_of_opening(give, bearable_of_axis(axis.kind, way), r.crowded)), rate);
  }
  return rate;
}

/* The world has no size. */
SHARED real smaller_of_sides(GLOBAL const float4 *body_shape, joint j)
{
  uint_lanes a = choose(j.a.is_world, j.b.body, j.a.body), b = choose(j.b.is_world, j.a.body, j.b.body);
  return size_between(body_shape, a, b);
}

SHARED void weigh_joints_item(GLOBAL const Parameters *parameters, read_joints joints, read_turning_bodies bodies,
                              read_joint_axes axes, read_joint_impulses impulses, read_cached_joint_impulses cached,
                              GLOBAL const float4 *body_shape, GLOBAL const float4 *solver_velocity,
                              GLOBAL uint *body_wish, GLOBAL uint *counts, uint starts, item_index i)
{
  joint j = load_joint(parameters, joints, bodies, solver_velocity, i);
  joint_frames f = frames_of(parameters, j, joints, i);
  real way = BEARABLE_GAP * bearable_way(parameters, smaller_of_sides(body_shape, j)),
       per_second = parameters->inverse_substep,
       growth = starts != 0u ? R(1.0) : GROWTH_OF_LOADS * parameters->warm_start_scale;
  joint_impulses p = load_joint_impulses(parameters, impulses.linear, impulses.angular, i),
                 before = load_joint_impulses(parameters, cached.linear, cached.angular, i);
  joint_load load = load_borne(parameters, j, f, axes, p, impulses.axis, per_second, i);
  if (starts == 0u)
    load = limited_load(load, load_borne(parameters, j, f, axes, before, cached.axis, growth * per_second, i));
  real rate =
      maximum(rate_of_held(j, &load, way), maximum(rate_of_turning(j.a, load.pull), rate_of_turning(j.b, load.pull)));
  if (HAS_FEATURE(parameters, JOINT_AXES))
    rate = maximum(rate, rate_of_limits(parameters, j, f, axes, impulses.axis,
                                        starts != 0u ? impulses.axis : cached.axis, growth, way, i));
  rate = maximum(starts != 0u ? LOAD_TO_COME * rate : rate, rate_of_curving(j, way));
  mask noted = note_rate(parameters, rate > R(0.0), rate, counts);
  note_wishes(parameters, noted, rate, body_wish, choose(j.a.is_world, j.b.body, j.a.body),
              choose(j.b.is_world, j.a.body, j.b.body));
}

#endif
