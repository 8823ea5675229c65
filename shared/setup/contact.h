/* contact.h - contact constraints from manifolds: effective masses, friction, restitution, warm start.
 *
 * Constraints stand in colour order. The points of a manifold are solved as one block; its friction is solved at its
 * centre as one cone and one twist (Catto, Box2D version 3, "Solver2D", 2024):
 *
 *            n ^   ^ twist about n, limited by friction x normal impulse x twist radius
 *       o------|------o
 *        \     +----> t1, t2: |friction impulse| <= friction x sum of normal impulses
 *         o-----------o
 */
#ifndef TANDEM_SHARED_SETUP_CONTACT_H
#define TANDEM_SHARED_SETUP_CONTACT_H

#include "shared/argument_groups.h"
#include "shared/point_rows.h"
#include "shared/records.h"
#include "shared/setup/spin_slop.h"
#include "shared/substep_classes.h"

/* Below this sliding speed contacts count as sticking, and the static coefficient holds, m/s. */
#define STICKING_SPEED R(0.01)

/* The codes of the combination rules are those of Combine in host/include/tandem/scene.h. Of two rules the one that
 * comes first in this order holds. */
SHARED real combined(uint_lanes rule_a, uint_lanes rule_b, real a, real b)
{
  uint_lanes rule = choose(rule_a < rule_b, rule_a, rule_b);
  real product = a * b;
  real result = choose(rule == 3u, product, square_root(product));
  result = choose(rule == 2u, maximum(a, b), result);
  result = choose(rule == 1u, minimum(a, b), result);
  return choose(rule == 0u, R(0.5) * (a + b), result);
}

typedef struct {
  real static_friction, dynamic_friction, restitution;
} surface;

/* material.w: friction rule + 8 restitution rule. */
SHARED surface surface_between(GLOBAL const float4 *material, uint_lanes material_a, uint_lanes material_b)
{
  vec4 a = load_float4(material, material_a), b = load_float4(material, material_b);
  uint_lanes rules_a = to_uint(a.w), rules_b = to_uint(b.w);
  surface s = {combined(rules_a & 7u, rules_b & 7u, a.x, b.x), combined(rules_a & 7u, rules_b & 7u, a.y, b.y),
               combined(rules_a >> 3u, rules_b >> 3u, a.z, b.z)};
  return s;
}

/* The two bodies of a constraint. offset: from the centre of a to the centre of b. */
typedef struct {
  uint_lanes a, b;
  spatial_velocity velocity_a, velocity_b;
  symmetric3 inertia_a, inertia_b;
  vec3 offset;
  real locks_a, locks_b; /* linear, as in solver_inertia */
} body_pair;

SHARED vec3 relative_velocity(body_pair bodies, vec3 arm_a, vec3 arm_b)
{
  return subtract(velocity_at(bodies.velocity_b, arm_b), velocity_at(bodies.velocity_a, arm_a));
}

/* The part of the linear motion in `response`. */
SHARED real linear_response(body_pair bodies, vec3 first, vec3 second)
{
  real mass_a = bodies.velocity_a.inverse_mass, mass_b = bodies.velocity_b.inverse_mass;
  real free = (mass_a + mass_b) * dot3(first, second);
  mask locked = (bodies.locks_a + bodies.locks_b) > R(0.0);
  if (!MAY_OCCUR(LOCKS) || !any_of(locked)) return free;
  return choose(locked,
                mass_a * dot3(without_locked_axes(first, to_uint(bodies.locks_a)), second) +
                    mass_b * dot3(without_locked_axes(first, to_uint(bodies.locks_b)), second),
                free);
}

/* The relative velocity along `second` that a unit impulse along `first` gives. */
SHARED real response(body_pair bodies, vec3 arm_a, vec3 arm_b, vec3 first, vec3 second)
{
  vec3 inertia_cross_a = symmetric_times(bodies.inertia_a, cross3(arm_a, first));
  vec3 inertia_cross_b = symmetric_times(bodies.inertia_b, cross3(arm_b, first));
  return linear_response(bodies, first, second) + dot3(inertia_cross_a, cross3(arm_a, second)) +
         dot3(inertia_cross_b, cross3(arm_b, second));
}

SHARED real inverse_or_zero(real x)
{
  return choose(x > R(0.0), R(1.0) / choose(x > R(0.0), x, (real)R(1.0)), (real)R(0.0));
}

/* The effective mass along a normal. Locks can leave next to nothing of the mobility along it, when a normal differs
 * from a locked axis by little more than rounding. Such a row would throw the body aside with a huge impulse, so it
 * takes no part, as a row between bodies that cannot be pushed. */
#define LEAST_MOBILITY R(0.01)
SHARED real normal_mass(body_pair bodies, vec3 arm_a, vec3 arm_b, vec3 normal)
{
  real mobility = response(bodies, arm_a, arm_b, normal, normal);
  if (MAY_OCCUR(LOCKS)) {
    mask stuck = ((bodies.locks_a + bodies.locks_b) > R(0.0)) &
                 (mobility < LEAST_MOBILITY * (bodies.velocity_a.inverse_mass + bodies.velocity_b.inverse_mass));
    mobility = zero_if(stuck, mobility);
  }
  return inverse_or_zero(mobility);
}

/* One mass serves every direction of the tangent plane. It is the smallest, 1 / the largest eigenvalue of the 2 x 2
 * response, so that the cone can be projected as a circle and the iteration contracts. */
SHARED real friction_mass(body_pair bodies, vec3 arm_a, vec3 arm_b, vec3 normal)
{
  tangents t = tangents_of(normal);
  real first = response(bodies, arm_a, arm_b, t.first, t.first);
  real second = response(bodies, arm_a, arm_b, t.second, t.second);
  real mixed = response(bodies, arm_a, arm_b, t.first, t.second);
  real difference = first - second;
  return inverse_or_zero(R(0.5) * (first + second + square_root(difference * difference + R(4.0) * mixed * mixed)));
}

SHARED real twist_mass(body_pair bodies, vec3 normal)
{
  return inverse_or_zero(dot3(normal, symmetric_times(bodies.inertia_a, normal)) +
                         dot3(normal, symmetric_times(bodies.inertia_b, normal)));
}

/* The target velocity of a point is restitution x speed of impact. A point that touches only later in the step has
 * fallen further by then, v^2 + 2 g s, so that a ball returns to e^2 of its height. A negative value means that the
 * point does not bounce. */
SHARED real target_velocity_of(GLOBAL const Parameters *parameters, real restitution, real approach, real pull,
                               real separation)
{
  real ahead = maximum(separation, R(0.0));
  real squared = maximum(approach * approach - R(2.0) * pull * ahead, R(0.0));
  real impact = square_root(squared);
  mask bounces = (restitution > R(0.0)) & (approach < R(0.0)) & (impact > parameters->restitution_speed);
  return choose(bounces, restitution * impact, (real)R(-1.0));
}

SHARED uint_lanes slot_of(uint_lanes feature, uint_lanes point) { return (feature >> (point * 2u)) & 3u; }

/* The impulse that the same feature carried in the last step; unused slots of the cache hold 0. */
SHARED real cached_impulse(uint_lanes feature, uint_lanes point, uint_lanes old_feature, vec4 old)
{
  uint_lanes slot = slot_of(feature, point);
  real found = R(0.0);
  for (uint k = 0; k < 4u; ++k)
    found = choose(slot_of(old_feature, k) == slot, maximum(found, component(old, k)), found);
  return choose((feature >> 8u) == (old_feature >> 8u), found, (real)R(0.0));
}

SHARED body_pair load_body_pair(GLOBAL const Parameters *parameters, GLOBAL const uint *pair_a,
                                GLOBAL const uint *pair_b, read_touching_bodies touching, uint_lanes pair)
{
  body_pair bodies;
  bodies.a = load_uint(pair_a, pair);
  bodies.b = load_uint(pair_b, pair);
  bodies.velocity_a = load_velocity(touching.velocity, bodies.a);
  bodies.velocity_b = load_velocity(touching.velocity, bodies.b);
  bodies.inertia_a = load_inertia_and_locks(parameters, touching.inertia, bodies.a, bodies.velocity_a, &bodies.locks_a);
  bodies.inertia_b = load_inertia_and_locks(parameters, touching.inertia, bodies.b, bodies.velocity_b, &bodies.locks_b);
  bodies.offset = offset_between(touching.position, bodies.a, bodies.b);
  return bodies;
}

/* The acceleration of b relative to a along the normal under gravity. */
SHARED real relative_pull(vec3 gravity, GLOBAL const float4 *body_mass, body_pair bodies, vec3 normal)
{
  real a = choose(bodies.velocity_a.inverse_mass > R(0.0), load_float4(body_mass, bodies.a).w, (real)R(0.0));
  real b = choose(bodies.velocity_b.inverse_mass > R(0.0), load_float4(body_mass, bodies.b).w, (real)R(0.0));
  real pull = (b - a) * dot3(gravity, normal);
  mask locked = (bodies.locks_a + bodies.locks_b) > R(0.0);
  if (!MAY_OCCUR(LOCKS) || !any_of(locked)) return pull;
  return choose(locked,
                b * dot3(without_locked_axes(gravity, to_uint(bodies.locks_b)), normal) -
                    a * dot3(without_locked_axes(gravity, to_uint(bodies.locks_a)), normal),
                pull);
}

/* constraint_normal stores friction beside the normal, as a negative number if the arms do not follow the bodies. */
SHARED real packed_friction(real friction, mask arms_stay) { return choose(arms_stay, R(-1.0) - friction, friction); }
SHARED real friction_of(real packed) { return choose(packed < R(0.0), R(-1.0) - packed, packed); }

/* A share of the size of a pair. Bodies that pass each other by more than this within a substep keep the arms of their
 * impact, or of the start where they touch already. Arms that follow would be off by that much in the substep of the
 * impact, and would lie far outside the bodies afterwards. */
#define FOLLOWED_SHARE R(1.0)

/* How far a gap may close within the step, m. If gravity separates the two, it does so only later and does not count.
 * The gap closes along the symplectic Euler step, as a contact looks ahead (closing_beyond_mean of
 * narrowphase/time_of_impact.h). speed, pull: of b relative to a along the normal. */
SHARED real farthest_closed(GLOBAL const Parameters *parameters, real substep, real speed, real pull)
{
  real fall = R(0.5) * (parameters->step * parameters->step + substep * substep);
  return maximum(R(0.0) - pull, R(0.0)) * fall - speed * parameters->step;
}

/* Whether a contact may bear weight: its normal force bears at most the square of the cosine between normal and
 * gravity. */
SHARED mask bears_weight(vec3 gravity, vec3 normal)
{
  real along = dot3(gravity, normal);
  return along * along > WEIGHTLESS * length_squared(gravity);
}

/* The displacement of the arms of two bodies that slide past each other. */
typedef struct {
  vec3 a, b;
} arm_shift;

SHARED arm_shift shift_of_arms(spatial_velocity velocity_a, spatial_velocity velocity_b, vec3 slid)
{
  real share = share_of_slide(velocity_a, velocity_b);
  arm_shift s = {scale(slid, share), scale(slid, share - R(1.0))};
  return s;
}

/* A spinning ball that cannot be pushed moves its surface along itself. Its arm therefore does not follow a body that
 * slides over it; the plane of the contact would turn with the arm into the other body. */
SHARED mask is_driven_ball(uint_lanes flags, spatial_velocity m)
{
  return (m.inverse_mass == R(0.0)) & (shape_of(flags) == (uint_lanes)(uint)SHAPE_SPHERE);
}

/* The point at which friction acts: the centre of the points about to touch, and their mean distance from it, which is
 * the arm of the twist. The manifold of a fast spinning box also holds corners that are far ahead; they take part only
 * if no point is near. */
typedef struct {
  vec3 center;
  real radius;
} friction_patch;

SHARED friction_patch patch_of(const vec4 *point, uint_lanes points, real near)
{
  real weight[4], sum = R(0.0);
  mask none = point[0].w > near;
  for (uint k = 1; k < 4u; ++k) none = none & ((points <= (uint_lanes)k) | (point[k].w > near));
  for (uint k = 0; k < 4u; ++k) {
    weight[k] = choose((points > (uint_lanes)k) & (none | (point[k].w <= near)), (real)R(1.0), (real)R(0.0));
    sum = sum + weight[k];
  }
  real share = R(1.0) / sum; /* a constraint has at least one point */
  vec3 center = choose3(weight[0] > R(0.0), xyz(point[0]), make_vec3(R(0.0), R(0.0), R(0.0)));
  for (uint k = 1; k < 4u; ++k) center = choose3(weight[k] > R(0.0), add(center, xyz(point[k])), center);
  friction_patch patch = {scale(center, share), R(0.0)};
  for (uint k = 0; k < 4u; ++k) {
    if (!any_of(weight[k] > R(0.0))) continue;
    patch.radius =
        patch.radius + choose(weight[k] > R(0.0), length_of(subtract(xyz(point[k]), patch.center)), (real)R(0.0));
  }
  patch.radius = patch.radius * share;
  return patch;
}

/* The content of constraint_slop. It is the penetration left in place so that contacts persist, which is less for small
 * bodies, or DEEP if a point starts the step deeper than DEEP_SHARE of the pair's size. No impact brings bodies that
 * deep, only a bad initial state or a load beyond what the settings carry. */
#define DEEP R(-1.0)
#define DEEP_SHARE R(0.1)
SHARED real slop_or_deep(GLOBAL const Parameters *parameters, real size, real deepest)
{
  return choose(deepest < -DEEP_SHARE * size, (real)DEEP, minimum(parameters->slop, parameters->slop_share * size));
}
SHARED real slop_of(real slop_or_deep) { return maximum(slop_or_deep, R(0.0)); }

/* Penetration is never removed faster than this. The push speeds of layers of bodies add up, and the part that one
 * relaxing pass cannot take out of a long chain stays as energy, which grows with their square. Bodies deep in one
 * another are therefore separated slowly. */
#define DEEP_PUSH R(0.1)
SHARED real push_limit(GLOBAL const Parameters *parameters, real slop_or_deep)
{
  return parameters->push_speed * choose(slop_or_deep < R(0.0), (real)DEEP_PUSH, (real)R(1.0));
}

/* A pair of bodies during the setup of its constraint. If the bodies meet within the step, arms and masses are those of
 * that moment. The stored arms are such that the solver's shift of arms brings them to that moment, or the arms of that
 * moment themselves if arms do not follow. arms_back: from the arms of that moment to the stored ones. at: where the
 * constraint stands in colour order, if it is wanted, because the pair touches. */
typedef struct {
  uint_lanes pair, at, points, feature;
  mask wanted;
  body_pair bodies;
  vec3 normal, gravity;
  surface between;
  real size, pull, substep;
  mask arms_stay;
  arm_shift arms_back;
} contact_setup;

/* Balls that are children of a compound turn with it, so their arms follow. */
SHARED mask one_is_driven_ball(body_pair bodies, uint_lanes shape_a, uint_lanes shape_b, uint_lanes flags_a,
                               uint_lanes flags_b)
{
  return ((shape_a == bodies.a) & is_driven_ball(flags_a, bodies.velocity_a)) |
         ((shape_b == bodies.b) & is_driven_ball(flags_b, bodies.velocity_b));
}

/* s, of the pair's island. */
SHARED real substep_of_pair(GLOBAL const Parameters *parameters, GLOBAL const uint *body_class, body_pair bodies)
{
  real few = parameters->substep;
  if (!(parameters->few_share < R(1.0))) return few;
  mask of_many = is_of_many(larger_class(load_uint(body_class, bodies.a), load_uint(body_class, bodies.b)));
  return choose(of_many, few * parameters->few_share, few);
}

SHARED contact_setup begin_setup(GLOBAL const Parameters *parameters, GLOBAL const float4 *material,
                                 read_touching_bodies touching, read_part_pairs part_pairs, read_manifolds manifolds,
                                 uint_lanes at, uint_lanes pair)
{
  contact_setup s;
  s.pair = pair;
  s.at = at;
  s.wanted = at != (uint_lanes)INDEX_NONE;
  s.points = load_uint(manifolds.count, pair);
  s.feature = 0u;
  if (HAS_FEATURE(parameters, SEVERAL_POINTS)) s.feature = load_uint(manifolds.feature, pair);
  s.bodies = load_body_pair(parameters, part_pairs.a, part_pairs.b, touching, pair);
  s.size = size_between(touching.shape, s.bodies.a, s.bodies.b);
  s.substep = substep_of_pair(parameters, touching.substep_class, s.bodies);
  uint_lanes shape_a = shape_in_pair(parameters, part_pairs.leaf, pair, 0u, s.bodies.a),
             shape_b = shape_in_pair(parameters, part_pairs.leaf, pair, 1u, s.bodies.b);
  uint_lanes flags_a = load_uint(touching.flags, shape_a), flags_b = load_uint(touching.flags, shape_b);
  s.between = surface_between(material, material_of(flags_a), material_of(flags_b));
  vec4 manifold = load_float4(manifolds.normal, pair);
  s.normal = xyz(manifold);
  s.gravity = gravity_at(parameters, touching.gravity, s.bodies.a);
  s.pull = relative_pull(s.gravity, touching.mass, s.bodies, s.normal);
  vec3 passing = subtract(s.bodies.velocity_b.linear, s.bodies.velocity_a.linear);
  s.arms_stay = keeps_arms(manifold.w) | (length_of(passing) * s.substep > FOLLOWED_SHARE * s.size) |
                one_is_driven_ball(s.bodies, shape_a, shape_b, flags_a, flags_b);
  vec3 slid = scale(passing, moment_of(manifold.w)), none = make_vec3(R(0.0), R(0.0), R(0.0));
  s.bodies.offset = add(s.bodies.offset, slid);
  s.arms_back = shift_of_arms(s.bodies.velocity_a, s.bodies.velocity_b, choose3(s.arms_stay, none, negate(slid)));
  return s;
}

/* The impulses of the same pair in the last step; 0 for a new one, so that no other pair's numbers decide the signs of
 * zeros. Where the first body came whose pairs have several points, the others still have their single impulse. */
typedef struct {
  mask is_cached;
  uint_lanes feature;
  vec4 normal, friction;
} old_impulses;

SHARED old_impulses load_old_impulses(GLOBAL const Parameters *parameters, read_cached_contacts cached_contacts,
                                      uint_lanes cached)
{
  mask is_cached = cached != (uint_lanes)INDEX_NONE;
  uint_lanes from = choose(is_cached, cached, (uint_lanes)0u);
  vec4 none = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
  real single = load_real(cached_contacts.single_impulse, from);
  old_impulses old = {is_cached, 0u, make_vec4(single, R(0.0), R(0.0), R(0.0)), none};
  if (HAS_FEATURE(parameters, SEVERAL_POINTS)) {
    old.feature = load_uint(cached_contacts.feature, from);
    old.normal = load_float4(cached_contacts.normal_impulse, from);
    old.normal.x = choose(single > R(0.0), single, old.normal.x);
  }
  if (HAS_FEATURE(parameters, FRICTION))
    old.friction = choose4(is_cached, load_float4(cached_contacts.friction_impulse, from), none);
  return old;
}

/* The initial values of the points of a manifold. near: whether one of them may close within the step. */
typedef struct {
  real impulse[4], target_velocity[4], deepest;
  mask near;
} points_setup;

/* Of a point that no lane uses. */
SHARED void leave_point_out(const contact_setup *s, uint k, point_planes planes, points_setup *points,
                            GLOBAL memory_real *constraint_points)
{
  store_point_if(s->wanted, constraint_points, planes, k, s->at, make_vec3(R(0.0), R(0.0), R(0.0)), R(0.0), R(0.0));
  points->impulse[k] = R(0.0);
  points->target_velocity[k] = R(-1.0);
}

SHARED void prepare_point(GLOBAL const Parameters *parameters, const contact_setup *s, const old_impulses *old,
                          vec4 point, uint k, point_planes planes, points_setup *points,
                          GLOBAL memory_real *constraint_points)
{
  mask used = s->points > (uint_lanes)k;
  if (!any_of(used)) {
    leave_point_out(s, k, planes, points, constraint_points);
    return;
  }
  vec3 arm_a = xyz(point), arm_b = subtract(arm_a, s->bodies.offset), none = make_vec3(R(0.0), R(0.0), R(0.0));
  real mass = choose(used, normal_mass(s->bodies, arm_a, arm_b, s->normal), (real)R(0.0));
  real speed = dot3(s->normal, relative_velocity(s->bodies, arm_a, arm_b));
  store_point_if(s->wanted, constraint_points, planes, k, s->at, choose3(used, add(arm_a, s->arms_back.a), none),
                 choose(used, point.w, (real)R(0.0)), mass);
  points->impulse[k] =
      choose(used & old->is_cached,
             parameters->warm_start_scale * cached_impulse(s->feature, k, old->feature, old->normal), (real)R(0.0));
  points->target_velocity[k] =
      choose(used, target_velocity_of(parameters, s->between.restitution, speed, s->pull, point.w), (real)R(-1.0));
  points->deepest = choose(used, minimum(points->deepest, point.w), points->deepest);
  points->near = points->near | (used & (point.w <= farthest_closed(parameters, s->substep, speed, s->pull)));
}

/* Marks bodies that a contact bears, because they do not fall. */
SHARED void mark_borne(const contact_setup *s, mask near, GLOBAL uint *body_falls)
{
  mask bears = s->wanted & near & bears_weight(s->gravity, s->normal);
  atomic_clear_if(bears & (s->bodies.velocity_a.inverse_mass > R(0.0)), body_falls, s->bodies.a);
  atomic_clear_if(bears & (s->bodies.velocity_b.inverse_mass > R(0.0)), body_falls, s->bodies.b);
}

SHARED real friction_between(const contact_setup *s, vec3 center_a, vec3 center_b)
{
  vec3 slide = relative_velocity(s->bodies, center_a, center_b);
  slide = add_scaled(slide, s->normal, -dot3(slide, s->normal));
  return choose(length_of(slide) < STICKING_SPEED, s->between.static_friction, s->between.dynamic_friction);
}

/* Without -0, whatever the tangents: friction_rows.h. */
SHARED real positive_zero(mask wanted, real x) { return choose(wanted & (x == R(0.0)), (real)R(0.0), x); }

/* The friction impulse of the last step, along the tangents of this step. */
SHARED vec4 kept_friction(GLOBAL const Parameters *parameters, const contact_setup *s, const old_impulses *old,
                          real radius)
{
  tangents t = tangents_of(s->normal);
  real kept = choose(old->is_cached, (real)parameters->warm_start_scale, (real)R(0.0));
  mask smooth = (s->between.static_friction == R(0.0)) & (s->between.dynamic_friction == R(0.0));
  return make_vec4(positive_zero(smooth, kept * dot3(xyz(old->friction), t.first)),
                   positive_zero(smooth, kept * dot3(xyz(old->friction), t.second)),
                   positive_zero(smooth, kept * old->friction.w), radius);
}

SHARED void prepare_friction(GLOBAL const Parameters *parameters, const contact_setup *s, const old_impulses *old,
                             const vec4 *point, write_constraints constraints)
{
  friction_patch patch = patch_of(point, s->points, parameters->speculative_distance);
  vec3 center_a = patch.center, center_b = subtract(center_a, s->bodies.offset);
  real friction = friction_between(s, center_a, center_b);
  vec3 offset = add(s->bodies.offset, subtract(s->arms_back.a, s->arms_back.b));
  store_listed_row_if(s->wanted, constraints.normal, s->at, extend(s->normal, packed_friction(friction, s->arms_stay)));
  store_listed_row_if(s->wanted, constraints.center, s->at,
                      extend(add(center_a, s->arms_back.a), friction_mass(s->bodies, center_a, center_b, s->normal)));
  store_listed_row_if(s->wanted, constraints.offset, s->at, extend(offset, twist_mass(s->bodies, s->normal)));
  if (HAS_FEATURE(parameters, FRICTION))
    store_listed_row_if(s->wanted, constraints.friction_impulse, s->at,
                        kept_friction(parameters, s, old, patch.radius));
}

SHARED void store_restitution(const contact_setup *s, const points_setup *points, uint stride,
                              GLOBAL float4 *constraint_restitution)
{
  store_listed_row_if(s->wanted, constraint_restitution, s->at,
                      make_vec4(points->target_velocity[0], points->target_velocity[1], points->target_velocity[2],
                                points->target_velocity[3]));
  store_listed_row_if(s->wanted, constraint_restitution, (uint_lanes)stride + s->at,
                      make_vec4(R(0.0), R(0.0), R(0.0), R(0.0)));
}

/* For read_contact_orders: where the constraint of a pair stands. */
SHARED void place_constraints_item(GLOBAL const uint *sort_value, GLOBAL uint *pair_constraint, uint i)
{
  pair_constraint[sort_value[i]] = i;
}

/* The constraint at `at` of a pair; `points` is what it begins with. */
SHARED contact_setup prepare_contact(GLOBAL const Parameters *parameters, GLOBAL const float4 *material,
                                     read_touching_bodies touching_bodies, read_part_pairs part_pairs,
                                     read_manifolds manifolds, read_cached_contacts cached_contacts,
                                     point_planes planes, write_constraints constraints, GLOBAL uint *body_falls,
                                     points_setup *points, uint_lanes at, uint_lanes pair)
{
  contact_setup s = begin_setup(parameters, material, touching_bodies, part_pairs, manifolds, at, pair);
  old_impulses old = load_old_impulses(parameters, cached_contacts, load_uint(cached_contacts.of_pair, pair));
  points->deepest = R(0.0);
  points->near = s.bodies.a == s.bodies.b; /* none yet */
  vec4 point[4];
  for (uint k = 0; k < 4u; ++k) {
    point[k] = any_of(s.points > (uint_lanes)k) ? load_manifold_point(manifolds.points, planes, k, pair) : no_point();
    prepare_point(parameters, &s, &old, point[k], k, planes, points, constraints.points);
  }
  mark_borne(&s, points->near, body_falls);
  prepare_friction(parameters, &s, &old, point, constraints);

  store_listed_uint_if(s.wanted, constraints.pair, at, pair);
  store_listed_uint_if(s.wanted, constraints.a, at, s.bodies.a);
  store_listed_uint_if(s.wanted, constraints.b, at, s.bodies.b);
  store_listed_row_if(s.wanted, constraints.normal_impulse, at,
                      make_vec4(points->impulse[0], points->impulse[1], points->impulse[2], points->impulse[3]));
  store_listed_real_if(s.wanted, constraints.slop, at,
                       limited_by_spin(parameters, s.bodies.velocity_a, s.bodies.velocity_b,
                                       slop_or_deep(parameters, s.size, points->deepest)));
  if (HAS_FEATURE(parameters, RESTITUTION)) store_restitution(&s, points, planes.stride, constraints.restitution);
  return s;
}

/* by_pair: whether items are pairs, or constraints. In the order of pairs neighbours share bodies, and manifolds lie in
 * a row, so memory is read in order and only what is written is spread over the colours. It takes the pairs that do not
 * touch as well. */
SHARED void prepare_contacts_item(GLOBAL const Parameters *parameters, GLOBAL const float4 *material,
                                  read_touching_bodies touching_bodies, read_part_pairs part_pairs,
                                  read_manifolds manifolds, read_cached_contacts cached_contacts,
                                  read_contact_orders contact_orders, GLOBAL const uint *counts,
                                  write_constraints constraints, GLOBAL uint *body_falls, uint by_pair, item_index i)
{
  uint_lanes at = i, pair = i;
  if (by_pair != 0u) at = load_uint(contact_orders.constraint, i);
  else pair = load_uint(contact_orders.pair, i);
  if (!any_of(at != (uint_lanes)INDEX_NONE)) return;
  points_setup points;
  prepare_contact(parameters, material, touching_bodies, part_pairs, manifolds, cached_contacts, planes_of(counts),
                  constraints, body_falls, &points, at, pair);
}

#endif
