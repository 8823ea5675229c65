/* couplings.h - gears, racks, pulleys: what couples a coordinate of one joint with a coordinate of another.
 *
 *   row = of_a q_a + of_b q_b - offset      0, but for whole periods; of a rope at least 0
 *
 *        frame            The two joints have four sides: here a wheel and the frame, and the other wheel and the
 *      |       |          frame. Each has its part of the Jacobian of the row. A body on both joints has the sum of
 *     (o)     (o)         its two parts, which are added before the mass of the row is computed: the impulse would
 *    wheel   wheel        otherwise be that of another mechanism, in which the frame is two bodies.
 *
 * Angles are known but for whole turns. A gear with teeth_a and teeth_b teeth holds teeth_a q_a + teeth_b q_b but for
 * whole turns of that sum, which are whole teeth; so it remembers no turns and slips by none, and a load that forces
 * it by more than half a tooth makes it skip one.
 *
 * The row is a soft constraint, as those of a joint are (joints/axes.h). A coupling one of whose joints sleeps is left
 * as it is.
 */
#ifndef TANDEM_SHARED_JOINTS_COUPLINGS_H
#define TANDEM_SHARED_JOINTS_COUPLINGS_H

#include "shared/joints/axes.h"
#include "shared/joints/coupling_codes.h"
#include "shared/joints/solve.h"

/* A body of a coupled joint, and what a unit impulse of the coupling gives it. acts: no side before it stands for the
 * same body. */
typedef struct {
  joint_side side;
  vec3 impulse, moment;
  mask acts;
} coupled_side;

typedef struct {
  coupled_side aa, ab, ba, bb; /* joint a: its bodies a and b; joint b: the same */
  mask awake;
  real open; /* m or rad: the value of the row */
} coupling;

/* a, b: the places of joints. */
SHARED mask are_awake(uint_lanes a, uint_lanes b)
{
  mask a_is = a != (uint_lanes)INDEX_NONE, b_is = b != (uint_lanes)INDEX_NONE;
  return a_is & b_is;
}

SHARED joint load_coupled_joint(GLOBAL const Parameters *parameters, read_joints joints, read_turning_bodies bodies,
                                GLOBAL const float4 *solver_velocity, uint_lanes place)
{
  joint_side a = load_side(parameters, bodies, solver_velocity, load_uint(joints.a, place),
                           load_float4(joints.arm_a, place)),
             b = load_side(parameters, bodies, solver_velocity, load_uint(joints.b, place),
                           load_float4(joints.arm_b, place));
  return joint_between(a, b, load_uint(joints.modes, place), xyz(load_float4(joints.offset, place)));
}

SHARED joint_frames load_coupled_frames(read_joints joints, joint j, uint_lanes place)
{
  return frames_between(j, quat_from(load_float4(joints.frame_a, place)),
                        quat_from(load_float4(joints.frame_b, place)));
}

SHARED coupled_side coupled_side_of(joint_side s, vec3 direction, vec3 turn, real factor, mask awake)
{
  coupled_side c = {s, scale(direction, factor), scale(add(cross3(s.arm, direction), turn), factor), awake};
  return c;
}

/* If both sides are of one body, the first one gets the parts of both. */
SHARED void unite_sides(coupled_side *first, coupled_side *second)
{
  mask same = first->acts & second->acts & (first->side.body == second->side.body) & !first->side.is_world &
              !second->side.is_world;
  if (!any_of(same)) return;
  first->impulse = choose3(same, add(first->impulse, second->impulse), first->impulse);
  first->moment = choose3(same, add(first->moment, second->moment), first->moment);
  first->side.sharing = choose(same, maximum(first->side.sharing, second->side.sharing), first->side.sharing);
  second->acts = second->acts & !same;
}

SHARED real coupling_value(real sum, real period)
{
  mask turns = period > R(0.0);
  return choose(turns, sum - period * nearest_integer(sum / choose(turns, period, (real)R(1.0))), sum);
}

/* one, other: the places of the joints. */
SHARED uint_lanes class_of_coupling(GLOBAL const uint *joint_a, GLOBAL const uint *joint_b, read_turning_bodies bodies,
                                    uint_lanes one, uint_lanes other)
{
  return larger_class(class_of_joint(bodies, load_uint(joint_a, one), load_uint(joint_b, one)),
                      class_of_joint(bodies, load_uint(joint_a, other), load_uint(joint_b, other)));
}

SHARED coupling load_coupling(GLOBAL const Parameters *parameters, read_couplings couplings, read_joints joints,
                              read_turning_bodies bodies, GLOBAL const float4 *solver_velocity, item_index i)
{
  coupling c;
  uint_lanes a = load_uint(couplings.a, i), b = load_uint(couplings.b, i), kind = load_uint(couplings.kind, i);
  vec4 row = load_float4(couplings.row, i);
  c.awake = are_awake(a, b);
  a = choose(c.awake, a, (uint_lanes)0u);
  b = choose(c.awake, b, (uint_lanes)0u);
  if (moves_one_class(parameters))
    c.awake = c.awake & is_of_pass(parameters, class_of_coupling(joints.a, joints.b, bodies, a, b));
  joint one = load_coupled_joint(parameters, joints, bodies, solver_velocity, a),
        other = load_coupled_joint(parameters, joints, bodies, solver_velocity, b);
  joint_coordinate of_a = coordinate_of(one, load_coupled_frames(joints, one, a), kind & (uint)COUPLING_KIND_MASK),
                   of_b = coordinate_of(other, load_coupled_frames(joints, other, b),
                                        (kind >> (uint)COUPLING_KIND_B_SHIFT) & (uint)COUPLING_KIND_MASK);
  c.open = coupling_value((row.x * of_a.value + row.y * of_b.value) - row.z, row.w);
  c.aa = coupled_side_of(one.a, of_a.direction, of_a.turn, -row.x, c.awake);
  c.ab = coupled_side_of(one.b, of_a.direction, of_a.turn, row.x, c.awake);
  c.ba = coupled_side_of(other.a, of_b.direction, of_b.turn, -row.y, c.awake);
  c.bb = coupled_side_of(other.b, of_b.direction, of_b.turn, row.y, c.awake);
  unite_sides(&c.aa, &c.ba);
  unite_sides(&c.aa, &c.bb);
  unite_sides(&c.ab, &c.ba);
  unite_sides(&c.ab, &c.bb);
  return c;
}

SHARED void add_side_to_row(axis_row *r, const coupled_side *s)
{
  real response = choose(s->acts, response_along(s->side, s->impulse, s->moment), (real)R(0.0));
  real speed = dot3(s->impulse, s->side.velocity.linear) + dot3(s->moment, s->side.velocity.angular);
  r->response = r->response + response;
  r->shared_response = r->shared_response + s->side.sharing * response;
  r->crowded = r->crowded | (s->acts & (s->side.sharing > R(1.0)));
  r->speed = r->speed + choose(s->acts, speed, (real)R(0.0));
}

/* Of the row of an axis, all but what belongs to one joint. */
SHARED axis_row row_of_coupling(const coupling *c)
{
  axis_row r;
  r.response = r.shared_response = r.speed = R(0.0);
  r.leak = R(1.0);
  r.crowded = never_crowded();
  add_side_to_row(&r, &c->aa);
  add_side_to_row(&r, &c->ab);
  add_side_to_row(&r, &c->ba);
  add_side_to_row(&r, &c->bb);
  mask moves = r.shared_response > R(0.0);
  r.mass = choose(moves, R(1.0) / choose(moves, r.shared_response, (real)R(1.0)), (real)R(0.0));
  return r;
}

SHARED void push_coupled_side(GLOBAL float4 *solver_velocity, coupled_side s, real impulse)
{
  push_side(&s.side, scale(s.impulse, impulse), scale(s.moment, impulse), R(1.0));
  store_velocity_if(s.acts & (s.side.velocity.inverse_mass > R(0.0)), solver_velocity, s.side.body, s.side.velocity);
}

SHARED void push_coupled(GLOBAL float4 *solver_velocity, const coupling *c, real impulse)
{
  push_coupled_side(solver_velocity, c->aa, impulse);
  push_coupled_side(solver_velocity, c->ab, impulse);
  push_coupled_side(solver_velocity, c->ba, impulse);
  push_coupled_side(solver_velocity, c->bb, impulse);
}

/* What does not act counts as one that cannot move, which add_to_warm_start passes over. */
SHARED void add_coupled_to_warm_start(GLOBAL float4 *warm_start_impulse, coupled_side s, real impulse)
{
  s.side.velocity.inverse_mass = choose(s.acts, s.side.velocity.inverse_mass, (real)R(0.0));
  add_to_warm_start(warm_start_impulse, s.side, scale(s.impulse, impulse), scale(s.moment, impulse), R(1.0));
}

SHARED void prepare_couplings_item(GLOBAL const Parameters *parameters, GLOBAL const uint *coupling_a,
                                   GLOBAL const uint *coupling_b, GLOBAL const memory_real *cached,
                                   GLOBAL memory_real *impulse, item_index i)
{
  mask awake = are_awake(load_uint(coupling_a, i), load_uint(coupling_b, i));
  store_real(impulse, i, choose(awake, (real)parameters->warm_start_scale, (real)R(1.0)) * load_real(cached, i));
}

/* For a solver that begins each substep without impulses. */
SHARED void clear_couplings_item(GLOBAL const uint *coupling_a, GLOBAL const uint *coupling_b,
                                 GLOBAL memory_real *impulse, item_index i)
{
  mask awake = are_awake(load_uint(coupling_a, i), load_uint(coupling_b, i));
  store_real(impulse, i, choose(awake, (real)R(0.0), load_real(impulse, i)));
}

/* Applies the impulses of the last step or substep. */
SHARED void warm_start_couplings_item(GLOBAL const Parameters *parameters, read_couplings couplings, read_joints joints,
                                      read_turning_bodies bodies, GLOBAL const memory_real *impulse,
                                      GLOBAL float4 *solver_velocity, item_index i)
{
  coupling c = load_coupling(parameters, couplings, joints, bodies, solver_velocity, i);
  push_coupled(solver_velocity, &c, load_real(impulse, i));
}

SHARED void solve_couplings_item(GLOBAL const Parameters *parameters, read_couplings couplings, read_joints joints,
                                 read_turning_bodies bodies, GLOBAL memory_real *impulse,
                                 GLOBAL float4 *solver_velocity, GLOBAL float4 *warm_start_impulse, uint pass,
                                 item_index i)
{
  coupling c = load_coupling(parameters, couplings, joints, bodies, solver_velocity, i);
  if (!any_of(c.awake)) return;
  mask one_sided = (load_uint(couplings.kind, i) & (uint)COUPLING_ONE_SIDED) != 0u;
  axis_row r = row_of_coupling(&c);
  real old = load_real(impulse, i);
  real held = old + hold_change(parameters, &r, c.open, old, pass),
       pulled = maximum(old + stop_change(parameters, &r, c.open, old, pass), R(0.0));
  real now = choose(c.awake, choose(one_sided, pulled, held), old);
  store_real(impulse, i, now);
  push_coupled(solver_velocity, &c, now - old);
  if (pass != PASS_RELAXING) return;
  add_coupled_to_warm_start(warm_start_impulse, c.aa, now);
  add_coupled_to_warm_start(warm_start_impulse, c.ab, now);
  add_coupled_to_warm_start(warm_start_impulse, c.ba, now);
  add_coupled_to_warm_start(warm_start_impulse, c.bb, now);
}

SHARED void cache_couplings_item(GLOBAL const memory_real *impulse, GLOBAL memory_real *cached, item_index i)
{
  store_real(cached, i, load_real(impulse, i));
}

#endif
