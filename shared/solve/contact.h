/* contact.h - the soft-step contact solver: projected Gauss-Seidel over one colour at a time.
 *
 * Each substep: warm start, solve with soft bias, move bodies, solve again without bias (relax). The bias
 * treats penetration as an overdamped spring, so pushing bodies apart adds no energy; relaxing takes the
 * bias velocity out again. Separations are updated from the motion since the step began:
 *
 *     s = s0 + n . (dx_b - dx_a) + (r_b x n) . dtheta_b - (r_a x n) . dtheta_a
 *
 * After Catto, "Soft Contact" and "Substepping" (Box2D version 3, Solver2D, 2024); Macklin et al., "Small
 * Steps in Physics Simulation", 2019. Constraints of one colour share no moving body.
 */
#ifndef TANDEM_SHARED_SOLVE_CONTACT_H
#define TANDEM_SHARED_SOLVE_CONTACT_H

#include "shared/setup/contact.h"
#include "shared/solve/pass.h"

typedef struct {
  natural a, b;
  motion motion_a, motion_b;
  symmetric3 inertia_a, inertia_b;
  vec3 normal;
  real friction;
  real follows; /* 1: arms follow what the bodies slide past each other; 0: they stay as they are, of bodies that pass
                   each other fast */
} contact;

SHARED contact load_contact(read_contacts contacts, GLOBAL const row *solver_velocity, GLOBAL const row *solver_inertia,
                            item_index i)
{
  contact c;
  c.a = load_natural(contacts.a, i);
  c.b = load_natural(contacts.b, i);
  c.motion_a = load_motion(solver_velocity, c.a);
  c.motion_b = load_motion(solver_velocity, c.b);
  c.inertia_a = load_inertia(solver_inertia, c.a);
  c.inertia_b = load_inertia(solver_inertia, c.b);
  vec4 normal = load_row(contacts.normal, i);
  c.normal = xyz(normal);
  c.friction = friction_of(normal.w);
  c.follows = choose(normal.w < R(0.0), (real)R(0.0), (real)R(1.0));
  return c;
}

/* Bodies that cannot move are shared by constraints of one colour, so they are never written. */
SHARED void store_contact_motion_if(mask wanted, GLOBAL row *solver_velocity, contact c)
{
  store_motion_if(wanted & (c.motion_a.inverse_mass > R(0.0)), solver_velocity, c.a, c.motion_a);
  store_motion_if(wanted & (c.motion_b.inverse_mass > R(0.0)), solver_velocity, c.b, c.motion_b);
}
SHARED void store_contact_motion(GLOBAL row *solver_velocity, contact c)
{
  store_motion_if(c.motion_a.inverse_mass > R(0.0), solver_velocity, c.a, c.motion_a);
  store_motion_if(c.motion_b.inverse_mass > R(0.0), solver_velocity, c.b, c.motion_b);
}

/* An impulse of 0 is not applied: adding 0 would turn -0 into +0, and so depend on what shares the lanes. */
SHARED contact with_motion_if(mask wanted, contact c, contact moved)
{
  c.motion_a.linear = choose3(wanted, moved.motion_a.linear, c.motion_a.linear);
  c.motion_a.angular = choose3(wanted, moved.motion_a.angular, c.motion_a.angular);
  c.motion_b.linear = choose3(wanted, moved.motion_b.linear, c.motion_b.linear);
  c.motion_b.angular = choose3(wanted, moved.motion_b.angular, c.motion_b.angular);
  return c;
}

SHARED contact apply_turn(contact c, vec3 turn_a, vec3 turn_b, real impulse)
{
  c.motion_a.angular = add_scaled(c.motion_a.angular, symmetric_times(c.inertia_a, turn_a), -impulse);
  c.motion_b.angular = add_scaled(c.motion_b.angular, symmetric_times(c.inertia_b, turn_b), impulse);
  return c;
}

/* Impulse along a direction through arms whose cross products with it are turn_a, turn_b. */
SHARED contact apply_impulse(contact c, vec3 direction, vec3 turn_a, vec3 turn_b, real impulse)
{
  c.motion_a.linear = add_scaled(c.motion_a.linear, direction, -(c.motion_a.inverse_mass * impulse));
  c.motion_b.linear = add_scaled(c.motion_b.linear, direction, c.motion_b.inverse_mass * impulse);
  return apply_turn(c, turn_a, turn_b, impulse);
}

SHARED real speed_along(contact c, vec3 direction, vec3 turn_a, vec3 turn_b)
{
  return inner(direction, subtract(c.motion_b.linear, c.motion_a.linear)) + inner(turn_b, c.motion_b.angular) -
         inner(turn_a, c.motion_a.angular);
}

/* What the bodies have moved since the step began. */
typedef struct {
  vec3 translation, rotation_a, rotation_b;
} drift;

SHARED drift load_drift(GLOBAL const row *solver_delta, contact c)
{
  drift d = {subtract(xyz(load_row(solver_delta, c.b * 2u)), xyz(load_row(solver_delta, c.a * 2u))),
             xyz(load_row(solver_delta, c.a * 2u + 1u)), xyz(load_row(solver_delta, c.b * 2u + 1u))};
  return d;
}

SHARED arm_shift shift_of_contact(contact c, vec3 slid)
{
  return shift_of_arms(c.motion_a, c.motion_b, scale(slid, c.follows));
}

SHARED arm_shift load_arm_shift(GLOBAL const row *solver_delta, contact c)
{
  return shift_of_contact(c, subtract(xyz(load_row(solver_delta, c.b * 2u)), xyz(load_row(solver_delta, c.a * 2u))));
}

/* The four points of a manifold as one: their turns, masses and impulses. */
typedef struct {
  vec3 turn_a[4], turn_b[4];
  real mass[4], impulse[4];
} support;

/* Turns, masses and impulses of the points; separations as the step began stay with the caller. */
SHARED support load_support(GLOBAL const row *constraint_points, uint stride, contact c, arm_shift shift, vec4 impulses,
                            item_index i)
{
  support s;
  for (uint k = 0; k < 4u; ++k) {
    vec4 point_b = load_row(constraint_points, stride * (k + 4u) + i);
    s.turn_a[k] = outer(add(xyz(load_row(constraint_points, stride * k + i)), shift.a), c.normal);
    s.turn_b[k] = outer(add(xyz(point_b), shift.b), c.normal);
    s.mass[k] = point_b.w;
    s.impulse[k] = component(impulses, (natural)k);
  }
  return s;
}

/* What a manifold's impulses amount to: one impulse, and its moments about the two bodies. */
typedef struct {
  vec3 impulse, turn_a, turn_b;
} wrench;

/* friction: along the two tangents at the centre, and about the normal. */
SHARED wrench wrench_of(contact c, support s, vec3 center_a, vec3 center_b, vec4 friction)
{
  tangents t = tangents_of(c.normal);
  vec3 slide = add(scale(t.first, friction.x), scale(t.second, friction.y));
  wrench w = {slide, add(outer(center_a, slide), scale(c.normal, friction.z)),
              add(outer(center_b, slide), scale(c.normal, friction.z))};
  for (uint k = 0; k < 4u; ++k) {
    w.impulse = add_scaled(w.impulse, c.normal, s.impulse[k]);
    w.turn_a = add_scaled(w.turn_a, s.turn_a[k], s.impulse[k]);
    w.turn_b = add_scaled(w.turn_b, s.turn_b[k], s.impulse[k]);
  }
  return w;
}

/* The first substep of a step: the impulses of the last step. Later ones find theirs in solver_push. */
SHARED void warm_start_item(read_contacts contacts, read_patches patches, GLOBAL const row *constraint_normal_impulse,
                            GLOBAL const row *constraint_friction_impulse, GLOBAL const row *solver_inertia,
                            GLOBAL const row *solver_delta, GLOBAL const uint *counts, GLOBAL row *solver_velocity,
                            item_index i)
{
  uint stride = counts[CAPACITY_PAIRS];
  contact c = load_contact(contacts, solver_velocity, solver_inertia, i);
  arm_shift shift = load_arm_shift(solver_delta, c);
  support s = load_support(patches.points, stride, c, shift, load_row(constraint_normal_impulse, i), i);
  vec3 center_a = add(xyz(load_row(patches.center, i)), shift.a),
       center_b = add(xyz(load_row(patches.center, stride + i)), shift.b);
  wrench w = wrench_of(c, s, center_a, center_b, load_row(constraint_friction_impulse, i));
  store_contact_motion(solver_velocity, apply_impulse(c, w.impulse, w.turn_a, w.turn_b, R(1.0)));
}

/* The warm start of the next substep, gathered while the last pass of this one knows all that it takes: the impulse and
 * the moment that each body's constraints will push it by, in the order of the colours. A pass of its own would read
 * every constraint once more. */
SHARED void add_push_if(mask wanted, GLOBAL row *solver_push, contact c, wrench w)
{
  mask moves_a = wanted & (c.motion_a.inverse_mass > R(0.0)), moves_b = wanted & (c.motion_b.inverse_mass > R(0.0));
  vec3 impulse_a = subtract(xyz(load_row(solver_push, c.a * 2u)), w.impulse),
       turn_a = subtract(xyz(load_row(solver_push, c.a * 2u + 1u)), w.turn_a);
  vec3 impulse_b = add(xyz(load_row(solver_push, c.b * 2u)), w.impulse),
       turn_b = add(xyz(load_row(solver_push, c.b * 2u + 1u)), w.turn_b);
  store_row_if(moves_a, solver_push, c.a * 2u, extend(impulse_a, R(0.0)));
  store_row_if(moves_a, solver_push, c.a * 2u + 1u, extend(turn_a, R(0.0)));
  store_row_if(moves_b, solver_push, c.b * 2u, extend(impulse_b, R(0.0)));
  store_row_if(moves_b, solver_push, c.b * 2u + 1u, extend(turn_b, R(0.0)));
}

typedef struct {
  contact c;
  vec4 impulse;
} solved;

/* Bodies that have turned by less, in radians, or slid by a smaller share of their arms, are as heavy to each other as
 * when the step began. Of a thin rod that is much: its axis has left the arm of its end by a part of its thickness. */
#define SAME_PLACE R(0.02)
/* So much more mobility than that of the stored mass does not make an iteration diverge. */
#define SAME_MOBILITY R(1.05)

SHARED mask masses_are_stale(drift moved, arm_shift shift, vec4 center_a, vec4 center_b)
{
  real turned = length_squared(moved.rotation_a) + length_squared(moved.rotation_b), limit = SAME_PLACE * SAME_PLACE;
  real slid = length_squared(shift.a) + length_squared(shift.b);
  return (turned > limit) | (slid > limit * (length_squared(xyz(center_a)) + length_squared(xyz(center_b))));
}

/* The bodies of a contact as setup has them, but for the offset, which serves no mass. */
SHARED body_pair bodies_of(contact c)
{
  body_pair bodies = {c.a, c.b, c.motion_a, c.motion_b, c.inertia_a, c.inertia_b, c.normal};
  return bodies;
}

/* What has turned, or whose arms have followed it, would be turned faster by an impulse for the stored mass than it
 * slides, each time more: it gets the mass of its slide now. slide: along the tangents. */
SHARED real friction_mass_now(contact c, mask stale, real stored, vec3 slide, vec3 arm_a, vec3 arm_b)
{
  if (!any_of(stale)) return stored;
  real squared = length_squared(slide), mobility = response(bodies_of(c), arm_a, arm_b, slide, slide);
  mask diverges = stale & (stored * mobility > SAME_MOBILITY * squared);
  return choose(diverges, squared / choose(diverges, mobility, (real)R(1.0)), stored);
}

/* Twist about the normal and the cone of sliding friction at the centre of the manifold. stale: whether the masses
 * are. */
SHARED solved solve_friction(contact c, mask stale, arm_shift shift, vec4 center_a, vec4 center_b, vec4 impulse,
                             real pressure)
{
  real limit = c.friction * pressure;
  real spin = inner(c.normal, subtract(c.motion_b.angular, c.motion_a.angular));
  real twist_limit = limit * impulse.w;
  real twist = clamped(impulse.z - center_b.w * spin, -twist_limit, twist_limit);
  c = apply_turn(c, c.normal, c.normal, twist - impulse.z);

  tangents t = tangents_of(c.normal);
  vec3 arm_a = add(xyz(center_a), shift.a), arm_b = add(xyz(center_b), shift.b);
  vec3 slide = subtract(velocity_at(c.motion_b, arm_b), velocity_at(c.motion_a, arm_a));
  real slide_first = inner(slide, t.first), slide_second = inner(slide, t.second);
  vec3 along = add(scale(t.first, slide_first), scale(t.second, slide_second));
  real mass = friction_mass_now(c, stale, center_a.w, along, arm_a, arm_b);
  real first = impulse.x - mass * slide_first, second = impulse.y - mass * slide_second;
  real squared = first * first + second * second;
  mask slips = squared > limit * limit;
  real shrink = choose(slips, limit / square_root(choose(slips, squared, (real)R(1.0))), (real)R(1.0));
  first = first * shrink;
  second = second * shrink;
  vec3 change = add(scale(t.first, first - impulse.x), scale(t.second, second - impulse.y));
  solved s = {apply_impulse(c, change, outer(arm_a, change), outer(arm_b, change), R(1.0)),
              {first, second, twist, impulse.w}};
  return s;
}

typedef struct {
  real rate, mass_scale, impulse_scale;
} softness;

SHARED softness softness_of(GLOBAL const Parameters *parameters, contact c)
{
  mask against_fixed = (c.motion_a.inverse_mass == R(0.0)) | (c.motion_b.inverse_mass == R(0.0));
  softness s = {choose(against_fixed, (real)parameters->static_bias_rate, (real)parameters->bias_rate),
                choose(against_fixed, (real)parameters->static_mass_scale, (real)parameters->mass_scale),
                choose(against_fixed, (real)parameters->static_impulse_scale, (real)parameters->impulse_scale)};
  return s;
}

/* One normal row. Ahead of contact the bodies may close the gap but not more; in penetration the bias
 * pushes them apart, unless relaxing: then a point still ahead that has carried nothing stays so, for the motion it
 * would limit comes later. Returns the new accumulated impulse, which may pull: press_together cuts that off. */
SHARED real normal_impulse(GLOBAL const Parameters *parameters, softness soft, real slop_or_deep, real separation,
                           real speed, real mass, real old, uint biased)
{
  mask ahead = separation > R(0.0);
  real push =
      maximum(soft.rate * minimum(separation + slop_of(slop_or_deep), R(0.0)), -push_limit(parameters, slop_or_deep));
  mask rigid = ahead | (push == R(0.0));
  real bias = choose(ahead, separation * parameters->inverse_substep, biased != 0u ? push : (real)R(0.0));
  real mass_scale = biased != 0u ? choose(rigid, (real)R(1.0), soft.mass_scale) : (real)R(1.0);
  real impulse_scale = biased != 0u ? choose(rigid, (real)R(0.0), soft.impulse_scale) : (real)R(0.0);
  real impulse = old - mass * mass_scale * (speed + bias) - impulse_scale * old;
  return biased != 0u ? impulse : choose(ahead & (old == R(0.0)), old, impulse);
}

/* Gives all points their wished impulses at once, so that a box on four corners does not tilt towards the one that is
 * solved first. Wishes that pull end at 0. The changes are one direction; the share of it that brings the points as
 * near to their wishes as they can come together is own / whole: the energy that the wishes, uncut, would do along it
 * with the points apart, over its energy with them coupled. */
SHARED contact press_together(contact c, support *s, const real *wished)
{
  real change[4], sum = R(0.0), own = R(0.0);
  vec3 turn_a = make_vec3(R(0.0), R(0.0), R(0.0)), turn_b = turn_a;
  for (uint k = 0; k < 4u; ++k) {
    mask used = s->mass[k] > R(0.0);
    change[k] = choose(used, maximum(wished[k], R(0.0)) - s->impulse[k], (real)R(0.0));
    sum = sum + change[k];
    own = own + change[k] * (wished[k] - s->impulse[k]) / choose(used, s->mass[k], (real)R(1.0));
    turn_a = add_scaled(turn_a, s->turn_a[k], change[k]);
    turn_b = add_scaled(turn_b, s->turn_b[k], change[k]);
  }
  real whole = (c.motion_a.inverse_mass + c.motion_b.inverse_mass) * sum * sum +
               inner(turn_a, symmetric_times(c.inertia_a, turn_a)) +
               inner(turn_b, symmetric_times(c.inertia_b, turn_b));
  real share = minimum(own / choose(whole > R(0.0), whole, (real)R(1.0)), R(2.0));
  mask pulls = s->impulse[0] + share * change[0] < R(0.0);
  for (uint k = 1; k < 4u; ++k) pulls = pulls | (s->impulse[k] + share * change[k] < R(0.0));
  share = choose(pulls, minimum(share, R(1.0)), share);
  for (uint k = 0; k < 4u; ++k) s->impulse[k] = s->impulse[k] + share * change[k];
  c.motion_a.linear = add_scaled(c.motion_a.linear, c.normal, -(c.motion_a.inverse_mass * (share * sum)));
  c.motion_b.linear = add_scaled(c.motion_b.linear, c.normal, c.motion_b.inverse_mass * (share * sum));
  return apply_turn(c, turn_a, turn_b, share);
}

/* One pass over the points, as they are after the bodies have moved. */
SHARED contact press_once(GLOBAL const Parameters *parameters, contact c, support *s, drift moved,
                          GLOBAL const row *constraint_points, uint stride, real slop, uint biased, item_index i)
{
  softness soft = softness_of(parameters, c);
  real closed = inner(c.normal, moved.translation), wished[4];
  for (uint k = 0; k < 4u; ++k) {
    real started = load_row(constraint_points, stride * k + i).w;
    real separation =
        started + closed + (inner(s->turn_b[k], moved.rotation_b) - inner(s->turn_a[k], moved.rotation_a));
    real speed = speed_along(c, c.normal, s->turn_a[k], s->turn_b[k]);
    wished[k] = normal_impulse(parameters, soft, slop, separation, speed, s->mass[k], s->impulse[k], biased);
  }
  return press_together(c, s, wished);
}

/* The points of an impact are coupled, and one pass would leave a fast body on its way: further ones bring all of them
 * to rest. */
#define IMPACT_ROUNDS 15u

/* Impulses that change the rows of a manifold, at once, so that momentum is rounded once. */
SHARED contact apply_changes(contact c, const support *s, vec4 changes)
{
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0)), turn_a = none, turn_b = none;
  for (uint k = 0; k < 4u; ++k) {
    real change = component(changes, (natural)k);
    turn_a = add_scaled(turn_a, s->turn_a[k], change);
    turn_b = add_scaled(turn_b, s->turn_b[k], change);
  }
  real sum = (changes.x + changes.y) + (changes.z + changes.w);
  c.motion_a.linear = add_scaled(c.motion_a.linear, c.normal, -(c.motion_a.inverse_mass * sum));
  c.motion_b.linear = add_scaled(c.motion_b.linear, c.normal, c.motion_b.inverse_mass * sum);
  return apply_turn(c, turn_a, turn_b, R(1.0));
}

SHARED vec4 impulses_of(const support *s)
{
  return make_vec4(s->impulse[0], s->impulse[1], s->impulse[2], s->impulse[3]);
}

/* The most that each point has carried within the step: only what was pressed bounces. */
SHARED vec4 highest_impulses(vec4 highest, vec4 pressed)
{
  return make_vec4(maximum(highest.x, pressed.x), maximum(highest.y, pressed.y), maximum(highest.z, pressed.z),
                   maximum(highest.w, pressed.w));
}

SHARED void keep_highest_impulses(GLOBAL const Parameters *parameters, GLOBAL row *constraint_bounce, uint stride,
                                  vec4 pressed, item_index i)
{
  if (HAS_FEATURE(parameters, RESTITUTION))
    store_row(constraint_bounce, stride + i, highest_impulses(load_row(constraint_bounce, stride + i), pressed));
}

/* After the pass that all contacts get. Everything is loaded once more: few contacts are those of an impact, and the
 * others pay for no register of it. */
SHARED void settle_impact(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                          GLOBAL const row *solver_inertia, GLOBAL const row *solver_delta, uint stride,
                          write_contact_impulses contact_impulses, GLOBAL row *solver_velocity, GLOBAL row *solver_push,
                          uint pass, item_index i)
{
  contact c = load_contact(contacts, solver_velocity, solver_inertia, i);
  mask at_impact = c.follows == R(0.0);
  drift moved = load_drift(solver_delta, c);
  arm_shift shift = shift_of_contact(c, moved.translation);
  vec4 before = load_row(contact_impulses.normal, i);
  support s = load_support(patches.points, stride, c, shift, before, i);
  real slop = load_real(patches.slop, i);
  uint biased = pass == PASS_BIASED ? 1u : 0u;
  for (uint round = 0; round < IMPACT_ROUNDS; ++round)
    c = press_once(parameters, c, &s, moved, patches.points, stride, slop, biased, i);
  vec4 pressed = impulses_of(&s);
  store_row_if(at_impact, contact_impulses.normal, i, pressed);
  if (HAS_FEATURE(parameters, RESTITUTION))
    store_row_if(at_impact, contact_impulses.bounce, stride + i,
                 highest_impulses(load_row(contact_impulses.bounce, stride + i), pressed));
  vec4 changes = make_vec4(pressed.x - before.x, pressed.y - before.y, pressed.z - before.z, pressed.w - before.w);
  c = load_contact(contacts, solver_velocity, solver_inertia, i);
  c = apply_changes(c, &s, changes);
  store_contact_motion_if(at_impact, solver_velocity, c);
  vec3 center_a = add(xyz(load_row(patches.center, i)), shift.a),
       center_b = add(xyz(load_row(patches.center, stride + i)), shift.b);
  if (pass == PASS_RELAXING)
    add_push_if(at_impact, solver_push, c, wrench_of(c, s, center_a, center_b, load_row(contact_impulses.friction, i)));
}

SHARED void solve_contacts_item(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                                GLOBAL const row *solver_inertia, GLOBAL const row *solver_delta,
                                GLOBAL const uint *counts, write_contact_impulses contact_impulses,
                                GLOBAL row *solver_velocity, GLOBAL row *solver_push, uint pass, item_index i)
{
  uint stride = counts[CAPACITY_PAIRS];
  uint biased = pass == PASS_BIASED ? 1u : 0u;
  contact c = load_contact(contacts, solver_velocity, solver_inertia, i);
  vec4 impulses = load_row(contact_impulses.normal, i), friction = load_row(contact_impulses.friction, i);
  vec4 center_a = load_row(patches.center, i), center_b = load_row(patches.center, stride + i);
  drift moved = load_drift(solver_delta, c);
  arm_shift shift = shift_of_contact(c, moved.translation);
  mask rough = c.friction > R(0.0);
  if (HAS_FEATURE(parameters, FRICTION) && any_of(rough)) {
    real pressure = (impulses.x + impulses.y) + (impulses.z + impulses.w);
    mask stale = masses_are_stale(moved, shift, center_a, center_b);
    solved sliding = solve_friction(c, stale, shift, center_a, center_b, friction, pressure);
    c = with_motion_if(rough, c, sliding.c);
    friction = choose4(rough, sliding.impulse, friction);
    store_row(contact_impulses.friction, i, friction);
  }

  real slop = load_real(patches.slop, i);
  support s = load_support(patches.points, stride, c, shift, impulses, i);
  c = press_once(parameters, c, &s, moved, patches.points, stride, slop, biased, i);
  vec4 pressed = impulses_of(&s);
  store_row(contact_impulses.normal, i, pressed);
  keep_highest_impulses(parameters, contact_impulses.bounce, stride, pressed, i);
  store_contact_motion(solver_velocity, c);
  mask at_impact = c.follows == R(0.0);
  if (pass == PASS_RELAXING)
    add_push_if(!at_impact, solver_push, c,
                wrench_of(c, s, add(xyz(center_a), shift.a), add(xyz(center_b), shift.b), friction));
  if (any_of(at_impact))
    settle_impact(parameters, contacts, patches, solver_inertia, solver_delta, stride, contact_impulses,
                  solver_velocity, solver_push, pass, i);
}

/* The points of a manifold are coupled; a few rounds bring all of them to their speeds. */
#define RESTITUTION_ROUNDS 8u

/* After the last substep: points that were pressed part at their wished speed. */
SHARED void apply_restitution_item(read_contacts contacts, GLOBAL const row *constraint_points,
                                   GLOBAL const row *constraint_bounce, GLOBAL const row *solver_inertia,
                                   GLOBAL const row *solver_delta, GLOBAL const uint *counts,
                                   GLOBAL row *constraint_normal_impulse, GLOBAL row *solver_velocity, item_index i)
{
  uint stride = counts[CAPACITY_PAIRS];
  vec4 wished = load_row(constraint_bounce, i), highest = load_row(constraint_bounce, stride + i);
  mask bounces = (wished.x >= R(0.0)) | (wished.y >= R(0.0)) | (wished.z >= R(0.0)) | (wished.w >= R(0.0));
  if (!any_of(bounces)) return;
  contact c = load_contact(contacts, solver_velocity, solver_inertia, i);
  contact before = c;
  vec4 impulses = load_row(constraint_normal_impulse, i);
  arm_shift shift = load_arm_shift(solver_delta, c);
  support s = load_support(constraint_points, stride, c, shift, impulses, i);
  for (uint round = 0; round < RESTITUTION_ROUNDS; ++round) {
    real pressed[4];
    for (uint k = 0; k < 4u; ++k) {
      real target = component(wished, (natural)k);
      mask applies = (target >= R(0.0)) & (component(highest, (natural)k) > R(0.0));
      real wanted = s.impulse[k] - s.mass[k] * (speed_along(c, c.normal, s.turn_a[k], s.turn_b[k]) - target);
      pressed[k] = choose(applies, wanted, s.impulse[k]);
    }
    c = press_together(c, &s, pressed);
  }
  store_row_if(bounces, constraint_normal_impulse, i,
               make_vec4(s.impulse[0], s.impulse[1], s.impulse[2], s.impulse[3]));
  store_contact_motion(solver_velocity, with_motion_if(bounces, before, c));
}

#endif
