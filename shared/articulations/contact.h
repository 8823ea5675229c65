/* contact.h - contacts of which a side is a link: the rows of solve/soft_step.h, with the response of the tree.
 *
 *   load     the velocity and the inverse inertia of the two bodies as one (relative.h)
 *   solve    friction at the centre, then the normals as a block
 *   pass on  the sum of the impulses, through the trees
 *
 * An articulation is one node of the graph of contacts, so a contact of a colour has its trees for itself, and every
 * contact sees all that the others have done: nothing lags. A tree that has its contacts for itself solves them by a
 * table (tree_contacts.h). Contacts of other trees walk to the root and back for velocities and pushes, O(depth) each.
 * Two links of one tree push each other through it as well. What each row of a walking contact leaves out then, at most
 * doubles its response, so their masses are half of what they were apart (|2 x C y| <= x A x + y B y), and the
 * velocities are read again between friction and normals.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_CONTACT_H
#define TANDEM_SHARED_ARTICULATIONS_CONTACT_H

#include "shared/articulations/relative.h"
#include "shared/solve/soft_step.h"

typedef struct {
  mask wanted; /* others write nothing */
  pushed_side a, b;
  mask walks_within; /* both are links of one tree, which is walked */
  relative_body body;
  contact shape; /* as the bodies alone would have it */
  arm_shift shift;
  vec4 offset, center_a, center_b;
  delta_pose moved;
} link_contact;

/* The bodies alone; one that is not wanted cannot move. */
SHARED contact load_shape_of_contact(mask wanted, GLOBAL const Parameters *parameters, read_contacts contacts,
                                     read_turning_bodies bodies, GLOBAL const float4 *solver_velocity, any_index i)
{
  contact c = load_contact(parameters, contacts, solver_velocity, bodies.inertia, i);
  c.velocity_a.inverse_mass = zero_if(!wanted, c.velocity_a.inverse_mass);
  c.velocity_b.inverse_mass = zero_if(!wanted, c.velocity_b.inverse_mass);
  return c;
}

/* Its two bodies as one are at rest as yet. */
SHARED link_contact load_contact_of_sides(mask wanted, contact shape, pushed_side a, pushed_side b,
                                          read_patches patches, read_turning_bodies bodies, any_index i)
{
  link_contact c;
  c.wanted = wanted;
  c.shape = shape;
  c.a = a;
  c.b = b;
  c.walks_within = a.is_link & b.is_link & (a.tree.number == b.tree.number);
  c.moved = load_delta_pose(bodies.delta, shape);
  c.shift = shift_of_contact(shape, c.moved.translation);
  c.offset = load_float4(patches.offset, i);
  c.center_a = load_float4(patches.center, i);
  c.center_b = center_of_b(c.center_a, c.offset);
  c.body = relative_body_of(b.is_link, add(xyz(c.offset), subtract(c.shift.a, c.shift.b)));
  return c;
}

/* --- by walks ------------------------------------------------------------------------------------------------- */
SHARED link_contact load_walking_contact(mask wanted, GLOBAL const Parameters *parameters, read_contacts contacts,
                                         read_patches patches, read_turning_bodies bodies, read_links links,
                                         write_link_states states, GLOBAL const float4 *solver_velocity, uint pass,
                                         uint_lanes i)
{
  contact c = load_shape_of_contact(wanted, parameters, contacts, bodies, solver_velocity, i);
  mask links_a = wanted & is_link(links.of_body, c.a), links_b = wanted & is_link(links.of_body, c.b);
  pushed_side a = pushed_side_of(links_a, links, states, c.a, c.velocity_a, c.inertia_a, c.locks_a, pass);
  pushed_side b = pushed_side_of(links_b, links, states, c.b, c.velocity_b, c.inertia_b, c.locks_b, pass);
  return load_contact_of_sides(wanted, c, a, b, patches, bodies, i);
}

SHARED void see_velocities(link_contact *c)
{
  mask is_b = c->body.is_b;
  c->body.velocity = motion_seen(&c->body, choose_motion(is_b, c->b.velocity, c->a.velocity),
                                 choose_motion(is_b, c->a.velocity, c->b.velocity));
}

/* What is within one tree is bounded, not computed. */
SHARED void see_sides(link_contact *c)
{
  mask is_b = c->body.is_b;
  symmetric6 seen = choose_symmetric6(is_b, c->b.inverse, c->a.inverse),
             other = choose_symmetric6(is_b, c->a.inverse, c->b.inverse);
  see_velocities(c);
  symmetric6 sum = add_symmetric6(seen, symmetric6_at(other, c->body.to_seen));
  c->body.inverse = sum;
  c->body.response = choose_symmetric6(c->walks_within, add_symmetric6(sum, sum), sum);
}

SHARED void push_sides(link_contact *c)
{
  mask is_b = c->body.is_b;
  spatial_force seen = c->body.pushed, other = push_back(&c->body, seen);
  push_side_of_pair(&c->a, choose_force(is_b, other, seen));
  push_side_of_pair(&c->b, choose_force(is_b, seen, other));
  c->body.pushed = no_force();
}

/* Within one tree each side has what the other one pushed it with. */
SHARED void push_each_other_within(link_contact *c)
{
  mask moved = c->walks_within & is_push(c->body.pushed);
  if (!any_of(moved)) return;
  link_contact pushed = *c;
  push_sides(&pushed);
  push_into_tree_if(moved, &pushed.a);
  push_into_tree_if(moved, &pushed.b);
  pushed.a.velocity = pending_velocity_if(moved, &pushed.a.tree, pushed.a.k);
  pushed.b.velocity = pending_velocity_if(moved, &pushed.b.tree, pushed.b.k);
  see_velocities(&pushed);
  c->body = choose_relative(moved, pushed.body, c->body);
}

SHARED void store_sides(link_contact *c, GLOBAL float4 *solver_velocity)
{
  push_sides(c);
  store_side_of_pair(&c->a, solver_velocity);
  store_side_of_pair(&c->b, solver_velocity);
}

/* --- friction ------------------------------------------------------------------------------------------------- */
SHARED real twist_of_contact(link_contact *c, real old, real limit)
{
  spatial_force r = twist_seen(&c->body, c->shape.normal);
  real mass = inverse_or_zero(response_seen(&c->body, r, r));
  real twist = clamped(old - mass * power_of(r, c->body.velocity), -limit, limit);
  push_seen(&c->body, scaled_force(r, twist - old));
  return twist;
}

/* As friction_mass in setup/contact.h, where the tree stands now: of the responses of both directions, and of the two
 * together. */
SHARED real mass_of_sliding(vec3 response)
{
  real difference = response.x - response.y;
  real root = square_root(difference * difference + R(4.0) * response.z * response.z);
  return inverse_or_zero(R(0.5) * (response.x + response.y + root));
}

SHARED spatial_force row_at_center(const link_contact *c, vec3 direction)
{
  return row_seen(&c->body, add(xyz(c->center_a), c->shift.a), add(xyz(c->center_b), c->shift.b), direction);
}

/* impulse: along the tangents and about the normal; the radius of the patch. */
SHARED vec4 solve_link_friction(link_contact *c, vec4 impulse, real normal_impulse_sum)
{
  real limit = c->shape.friction * normal_impulse_sum;
  real twist = twist_of_contact(c, impulse.z, limit * impulse.w);
  tangents t = tangents_of(c->shape.normal);
  spatial_force first = row_at_center(c, t.first), second = row_at_center(c, t.second);
  real mass = mass_of_sliding(make_vec3(response_seen(&c->body, first, first), response_seen(&c->body, second, second),
                                        response_seen(&c->body, first, second)));
  real x = impulse.x - mass * power_of(first, c->body.velocity),
       y = impulse.y - mass * power_of(second, c->body.velocity);
  real shrink = share_within_cone(x, y, limit);
  x = x * shrink;
  y = y * shrink;
  push_seen(&c->body, add_forces(scaled_force(first, x - impulse.x), scaled_force(second, y - impulse.y)));
  return make_vec4(x, y, twist, impulse.w);
}

/* --- normals -------------------------------------------------------------------------------------------------- */
typedef struct {
  spatial_force row[4];
  real mass[4], impulse[4], separation[4];
} link_normals;

typedef struct {
  vec3 a, b;
} point_arms;

SHARED point_arms load_point_arms(const link_contact *c, read_patches patches, point_planes planes, uint k, any_index i)
{
  vec3 arm_a = load_arm_of_a(patches.points, planes, k, i), arm_b = subtract(arm_a, xyz(c->offset));
  point_arms arms = {add(arm_a, c->shift.a), add(arm_b, c->shift.b)};
  return arms;
}

/* A point that is not used has no row. */
SHARED void load_link_point(const link_contact *c, link_normals *s, read_patches patches, point_planes planes, uint k,
                            uint_lanes i)
{
  vec3 n = c->shape.normal;
  s->row[k] = no_force();
  s->mass[k] = s->separation[k] = R(0.0);
  mask used = load_point_mass(patches.points, planes, k, i) > R(0.0);
  if (!any_of(used)) return;
  point_arms arms = load_point_arms(c, patches, planes, k, i);
  s->row[k] = choose_force(used, row_seen(&c->body, arms.a, arms.b, n), no_force());
  s->mass[k] = choose(used, inverse_or_zero(response_seen(&c->body, s->row[k], s->row[k])), (real)R(0.0));
  real separation = load_separation(patches.points, planes, k, i) + dot3(n, c->moved.translation) +
                    (dot3(cross3(arms.b, n), c->moved.rotation_b) - dot3(cross3(arms.a, n), c->moved.rotation_a));
  s->separation[k] = choose(used, separation, (real)R(0.0));
}

SHARED link_normals load_link_normals(const link_contact *c, read_patches patches, point_planes planes, vec4 impulses,
                                      uint_lanes i)
{
  link_normals s;
  for (uint k = 0; k < 4u; ++k) {
    load_link_point(c, &s, patches, planes, k, i);
    s.impulse[k] = component(impulses, k);
  }
  return s;
}

/* block_solve_normals of solve/contact_normals.h: all points move towards their targets along one direction. */
SHARED void block_solve_link_normals(link_contact *c, link_normals *s, const real *target)
{
  real change[4], own = R(0.0);
  spatial_force sum = no_force();
  for (uint k = 0; k < 4u; ++k) {
    mask used = s->mass[k] > R(0.0);
    change[k] = choose(used, maximum(target[k], R(0.0)) - s->impulse[k], (real)R(0.0));
    own = own + change[k] * (target[k] - s->impulse[k]) / choose(used, s->mass[k], (real)R(1.0));
    sum = add_forces(sum, scaled_force(s->row[k], change[k]));
  }
  real whole = response_seen(&c->body, sum, sum);
  real share = minimum(own / choose(whole > R(0.0), whole, (real)R(1.0)), R(2.0));
  mask pulls = s->impulse[0] + share * change[0] < R(0.0);
  for (uint k = 1; k < 4u; ++k) pulls = pulls | (s->impulse[k] + share * change[k] < R(0.0));
  share = choose(pulls, minimum(share, R(1.0)), share);
  for (uint k = 0; k < 4u; ++k) s->impulse[k] = s->impulse[k] + share * change[k];
  push_seen(&c->body, scaled_force(sum, share));
}

SHARED void solve_link_normals(GLOBAL const Parameters *parameters, link_contact *c, link_normals *s, real slop,
                               uint biased)
{
  softness soft = softness_of(parameters, c->shape);
  real target[4];
  for (uint k = 0; k < 4u; ++k)
    target[k] = normal_impulse(parameters, soft, slop, s->separation[k], power_of(s->row[k], c->body.velocity),
                               s->mass[k], s->impulse[k], biased);
  block_solve_link_normals(c, s, target);
}

/* Towards the target velocities of restitution, as apply_restitution_item of solve/restitution.h. */
SHARED void bounce_link_normals(link_contact *c, link_normals *s, vec4 target_velocity, vec4 highest)
{
  real wanted[4];
  for (uint k = 0; k < 4u; ++k) {
    real speed = power_of(s->row[k], c->body.velocity);
    wanted[k] =
        bouncing_impulse(component(target_velocity, k), component(highest, k), speed, s->mass[k], s->impulse[k]);
  }
  block_solve_link_normals(c, s, wanted);
}

SHARED vec4 impulses_of_normals(const link_normals *s)
{
  return make_vec4(s->impulse[0], s->impulse[1], s->impulse[2], s->impulse[3]);
}

/* --- passes --------------------------------------------------------------------------------------------------- */
/* All impulses of the contact. */
SHARED spatial_force sum_of_impulses(const link_contact *c, const spatial_force *normals, vec4 normal, vec4 friction)
{
  tangents t = tangents_of(c->shape.normal);
  spatial_force sum = row_at_center(c, add(scale(t.first, friction.x), scale(t.second, friction.y)));
  sum = add_forces(sum, twist_seen(&c->body, scale(c->shape.normal, friction.z)));
  for (uint k = 0; k < 4u; ++k) sum = add_forces(sum, scaled_force(normals[k], component(normal, k)));
  return sum;
}

/* Adds to what the next substep starts with. */
SHARED void add_warm_start(const link_contact *c, spatial_force seen, real inverse_substep,
                           GLOBAL float4 *warm_start_impulse)
{
  mask is_b = c->body.is_b;
  spatial_force other = push_back(&c->body, seen);
  add_warm_start_of_side(&c->a, choose_force(is_b, other, seen), inverse_substep, warm_start_impulse);
  add_warm_start_of_side(&c->b, choose_force(is_b, seen, other), inverse_substep, warm_start_impulse);
}

SHARED vec4 solve_link_friction_if(mask rough, link_contact *c, vec4 friction, vec4 normal)
{
  relative_body body = c->body;
  vec4 solved = solve_link_friction(c, friction, (normal.x + normal.y) + (normal.z + normal.w));
  c->body = choose_relative(rough, c->body, body);
  push_each_other_within(c);
  return choose4(rough, solved, friction);
}

/* Contacts of an impact have more rounds. */
SHARED void solve_rounds_of_normals(GLOBAL const Parameters *parameters, link_contact *c, link_normals *s, real slop,
                                    uint biased)
{
  solve_link_normals(parameters, c, s, slop, biased);
  mask at_impact = c->shape.follows == R(0.0);
  if (!any_of(at_impact)) return;
  relative_body body = c->body;
  vec4 once = impulses_of_normals(s);
  for (uint round = 0; round < IMPACT_ROUNDS; ++round) solve_link_normals(parameters, c, s, slop, biased);
  c->body = choose_relative(at_impact, c->body, body);
  vec4 often = choose4(at_impact, impulses_of_normals(s), once);
  for (uint k = 0; k < 4u; ++k) s->impulse[k] = component(often, k);
}

/* Rows of impulses are read and written by the functions below as those of solve/soft_step.h do. */
SHARED void solve_link_contact(GLOBAL const Parameters *parameters, link_contact *c, read_patches patches,
                               point_planes planes, write_contact_impulses impulses, GLOBAL float4 *warm_start_impulse,
                               uint pass, uint_lanes i)
{
  vec4 normal = load_float4(impulses.normal, i), friction = load_friction(parameters, impulses.friction, i);
  mask rough = c->shape.friction > R(0.0);
  if (HAS_FEATURE(parameters, FRICTION) && any_of(rough)) {
    friction = solve_link_friction_if(rough, c, friction, normal);
    store_float4_if(c->wanted, impulses.friction, i, friction);
  }
  link_normals s = load_link_normals(c, patches, planes, normal, i);
  solve_rounds_of_normals(parameters, c, &s, load_real(patches.slop, i), pass == (uint)PASS_BIASED ? 1u : 0u);
  normal = impulses_of_normals(&s);
  store_float4_if(c->wanted, impulses.normal, i, normal);
  keep_highest_impulses_if(c->wanted, parameters, impulses.restitution, planes.stride, normal, i);
  if (pass != (uint)PASS_RELAXING) return;
  add_warm_start(c, sum_of_impulses(c, s.row, normal, friction), parameters->inverse_substep, warm_start_impulse);
}

SHARED void warm_start_link_contact(GLOBAL const Parameters *parameters, link_contact *c, read_patches patches,
                                    point_planes planes, write_contact_impulses impulses,
                                    GLOBAL float4 *warm_start_impulse, uint_lanes i)
{
  spatial_force normals[4];
  for (uint k = 0; k < 4u; ++k) {
    point_arms arms = load_point_arms(c, patches, planes, k, i);
    normals[k] = row_seen(&c->body, arms.a, arms.b, c->shape.normal);
  }
  spatial_force all =
      sum_of_impulses(c, normals, load_float4(impulses.normal, i), load_friction(parameters, impulses.friction, i));
  add_warm_start(c, all, parameters->inverse_substep, warm_start_impulse);
}

/* Contacts of which no point bounces stay as they are. */
SHARED void bounce_link_contact(link_contact *c, read_patches patches, point_planes planes,
                                write_contact_impulses impulses, uint_lanes i)
{
  vec4 target_velocity = load_float4(impulses.restitution, i),
       highest = load_float4(impulses.restitution, planes.stride + i);
  mask bounces = (target_velocity.x >= R(0.0)) | (target_velocity.y >= R(0.0)) | (target_velocity.z >= R(0.0)) |
                 (target_velocity.w >= R(0.0));
  if (!any_of(bounces)) return;
  relative_body body = c->body;
  link_normals s = load_link_normals(c, patches, planes, load_float4(impulses.normal, i), i);
  for (uint round = 0; round < RESTITUTION_ROUNDS; ++round) bounce_link_normals(c, &s, target_velocity, highest);
  c->body = choose_relative(bounces, c->body, body);
  store_float4_if(c->wanted & bounces, impulses.normal, i, impulses_of_normals(&s));
}

/* In any pass; the body as the other one sees it has been loaded. */
SHARED void run_pass_of_link_contact(GLOBAL const Parameters *parameters, link_contact *c, read_patches patches,
                                     point_planes planes, write_contact_impulses impulses,
                                     GLOBAL float4 *warm_start_impulse, uint pass, uint_lanes i)
{
  if (pass == (uint)PASS_WARM_STARTING)
    warm_start_link_contact(parameters, c, patches, planes, impulses, warm_start_impulse, i);
  else if (pass == (uint)PASS_BOUNCING) bounce_link_contact(c, patches, planes, impulses, i);
  else solve_link_contact(parameters, c, patches, planes, impulses, warm_start_impulse, pass, i);
}

/* --- kernels -------------------------------------------------------------------------------------------------- */
/* Whether contacts of the tree are solved by colour: tree_contacts.h. */
SHARED mask is_mixed(write_link_states states, uint_lanes tree)
{
  return load_uint(states.colors, TREE_COLOR_WORDS * tree + 2u) != 0u;
}

/* Contact i, or none: INDEX_NONE. */
SHARED void solve_link_contact_at(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                                  read_turning_bodies bodies, read_links links, GLOBAL const uint *counts,
                                  write_link_states states, write_contact_impulses contact_impulses,
                                  GLOBAL float4 *solver_velocity, GLOBAL float4 *warm_start_impulse, uint pass,
                                  uint_lanes i)
{
  mask wanted = i != (uint_lanes)INDEX_NONE;
  i = choose(wanted, i, (uint_lanes)0u);
  link_contact c =
      load_walking_contact(wanted, parameters, contacts, patches, bodies, links, states, solver_velocity, pass, i);
  if (pass != (uint)PASS_WARM_STARTING) see_sides(&c);
  run_pass_of_link_contact(parameters, &c, patches, planes_of(counts), contact_impulses, warm_start_impulse, pass, i);
  if (pass != (uint)PASS_WARM_STARTING) store_sides(&c, solver_velocity);
}

SHARED void solve_link_contacts_item(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                                     read_turning_bodies bodies, read_links links, GLOBAL const uint *counts,
                                     write_link_states states, write_contact_impulses contact_impulses,
                                     GLOBAL float4 *solver_velocity, GLOBAL float4 *warm_start_impulse, uint pass,
                                     item_index i)
{
  uint_lanes a = load_uint(contacts.a, i), b = load_uint(contacts.b, i), link = choose(is_link(links.of_body, a), a, b);
  uint_lanes tree = articulation_of_body(links.of_body, link);
  mask wanted = is_mixed(states, tree) & takes_pass(states, tree, pass);
  if (any_of(wanted))
    solve_link_contact_at(parameters, contacts, patches, bodies, links, counts, states, contact_impulses,
                          solver_velocity, warm_start_impulse, kind_of_pass(pass),
                          choose(wanted, i, (uint_lanes)INDEX_NONE));
}

#ifndef TANDEM_LANES /* ITEM kernels take one item at a time */
/* The contacts of links that share colours with others, one after another. */
SHARED void solve_link_contacts_in_order_item(GLOBAL const Parameters *parameters, read_contacts contacts,
                                              read_patches patches, read_turning_bodies bodies, read_links links,
                                              GLOBAL const uint *counts, write_link_states states,
                                              write_contact_impulses contact_impulses, GLOBAL float4 *solver_velocity,
                                              GLOBAL float4 *warm_start_impulse, uint pass, uint i)
{
  (void)i;
  for (uint k = counts[LINK_COLOR_START + LINK_COLORS]; k < counts[COLOR_START + LINK_COLORS + 1u]; ++k)
    solve_link_contacts_item(parameters, contacts, patches, bodies, links, counts, states, contact_impulses,
                             solver_velocity, warm_start_impulse, pass, k);
}
#endif

#endif
