/* contact.h - contacts of which a side is a link: the rows of solve/contact.h, with the response of the tree.
 *
 *   load     velocities with all that is pending in the trees      O(depth)
 *   solve    friction at the centre, then the normals as a block, against the inverse inertias of the sides
 *   pass on  the sum of the impulses, through the trees            O(depth)
 *
 * An articulation is one node of the graph of contacts, so a contact of a colour has its trees for itself, and every
 * contact sees all that the others have done: nothing lags. Two links of one tree push each other through it as well.
 * What each row leaves out then, at most doubles its response, so their masses are half of what they were apart
 * (|2 x C y| <= x A x + y B y), and the velocities are read again between friction and normals.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_CONTACT_H
#define TANDEM_SHARED_ARTICULATIONS_CONTACT_H

#include "shared/articulations/row.h"
#include "shared/solve/contact.h"

typedef struct {
  mask wanted; /* others write nothing */
  pushed_pair ends;
  contact shape; /* as the bodies alone would have it; the ends have velocities and inertias */
  arm_shift shift;
  vec4 offset, center_a, center_b;
  delta_pose moved;
} link_contact;

SHARED link_contact load_link_contact(mask wanted, GLOBAL const Parameters *parameters, read_contacts contacts,
                                      read_patches patches, read_turning_bodies bodies, read_links links,
                                      write_link_states states, GLOBAL const float4 *solver_velocity, uint pass,
                                      uint_lanes i)
{
  link_contact c;
  c.wanted = wanted;
  c.shape = load_contact(parameters, contacts, solver_velocity, bodies.inertia, i);
  c.shape.velocity_a.inverse_mass = zero_if(!wanted, c.shape.velocity_a.inverse_mass);
  c.shape.velocity_b.inverse_mass = zero_if(!wanted, c.shape.velocity_b.inverse_mass);
  mask links_a = wanted & is_link(links.of_body, c.shape.a), links_b = wanted & is_link(links.of_body, c.shape.b);
  pushed_side a =
      pushed_side_of(links_a, links, states, c.shape.a, c.shape.velocity_a, c.shape.inertia_a, c.shape.locks_a, pass);
  pushed_side b =
      pushed_side_of(links_b, links, states, c.shape.b, c.shape.velocity_b, c.shape.inertia_b, c.shape.locks_b, pass);
  c.ends = pushed_pair_of(a, b);
  c.moved = load_delta_pose(bodies.delta, c.shape);
  c.shift = shift_of_contact(c.shape, c.moved.translation);
  c.offset = load_float4(patches.offset, i);
  c.center_a = load_float4(patches.center, i);
  c.center_b = center_of_b(c.center_a, c.offset);
  return c;
}

/* What is within one tree is bounded, not computed. */
SHARED real response_of_rows(const link_contact *c, row_of_pair first, row_of_pair second)
{
  real apart = response_apart(&c->ends, first, second);
  return choose(c->ends.is_within, R(2.0) * apart, apart);
}

/* --- friction ------------------------------------------------------------------------------------------------- */
SHARED real twist_of_contact(link_contact *c, real old, real limit)
{
  row_of_pair r = row_about(c->shape.normal);
  real mass = inverse_or_zero(response_of_rows(c, r, r));
  real twist = clamped(old - mass * speed_of_row(&c->ends, r), -limit, limit);
  push_row(&c->ends, r, twist - old);
  return twist;
}

/* As friction_mass in setup/contact.h, where the tree stands now. */
SHARED real sliding_mass(const link_contact *c, row_of_pair first, row_of_pair second)
{
  real one = response_of_rows(c, first, first), other = response_of_rows(c, second, second);
  real mixed = response_of_rows(c, first, second), difference = one - other;
  return inverse_or_zero(R(0.5) * (one + other + square_root(difference * difference + R(4.0) * mixed * mixed)));
}

/* impulse: along the tangents and about the normal; the radius of the patch. */
SHARED vec4 solve_link_friction(link_contact *c, vec4 impulse, real normal_impulse_sum)
{
  real limit = c->shape.friction * normal_impulse_sum;
  real twist = twist_of_contact(c, impulse.z, limit * impulse.w);
  tangents t = tangents_of(c->shape.normal);
  vec3 arm_a = add(xyz(c->center_a), c->shift.a), arm_b = add(xyz(c->center_b), c->shift.b);
  row_of_pair first = row_along(arm_a, arm_b, t.first), second = row_along(arm_a, arm_b, t.second);
  real mass = sliding_mass(c, first, second);
  real x = impulse.x - mass * speed_of_row(&c->ends, first), y = impulse.y - mass * speed_of_row(&c->ends, second);
  real squared = x * x + y * y;
  mask slips = squared > limit * limit;
  real shrink = choose(slips, limit / square_root(choose(slips, squared, (real)R(1.0))), (real)R(1.0));
  x = x * shrink;
  y = y * shrink;
  push_row(&c->ends, row_along(arm_a, arm_b, add(scale(t.first, x - impulse.x), scale(t.second, y - impulse.y))),
           R(1.0));
  return make_vec4(x, y, twist, impulse.w);
}

/* --- normals -------------------------------------------------------------------------------------------------- */
typedef struct {
  row_of_pair row[4];
  real mass[4], impulse[4], separation[4];
} link_normals;

SHARED row_of_pair load_normal_row(const link_contact *c, read_patches patches, point_planes planes, uint k,
                                   uint_lanes i)
{
  vec3 arm_a = load_arm_of_a(patches.points, planes, k, i), arm_b = subtract(arm_a, xyz(c->offset));
  return row_along(add(arm_a, c->shift.a), add(arm_b, c->shift.b), c->shape.normal);
}

SHARED link_normals load_link_normals(const link_contact *c, read_patches patches, point_planes planes, vec4 impulses,
                                      uint_lanes i)
{
  link_normals s;
  for (uint k = 0; k < 4u; ++k) {
    s.row[k] = load_normal_row(c, patches, planes, k, i);
    mask used = load_point_mass(patches.points, planes, k, i) > R(0.0);
    s.mass[k] = choose(used, inverse_or_zero(response_of_rows(c, s.row[k], s.row[k])), (real)R(0.0));
    s.impulse[k] = component(impulses, k);
    s.separation[k] = load_separation(patches.points, planes, k, i) + dot3(c->shape.normal, c->moved.translation) +
                      (dot3(s.row[k].b.moment, c->moved.rotation_b) - dot3(s.row[k].a.moment, c->moved.rotation_a));
  }
  return s;
}

/* block_solve_normals of solve/contact.h: all points move towards their targets along one direction. */
SHARED void block_solve_link_normals(link_contact *c, link_normals *s, const real *target)
{
  real change[4], own = R(0.0);
  row_of_pair sum = {no_force(), no_force()};
  for (uint k = 0; k < 4u; ++k) {
    mask used = s->mass[k] > R(0.0);
    change[k] = choose(used, maximum(target[k], R(0.0)) - s->impulse[k], (real)R(0.0));
    own = own + change[k] * (target[k] - s->impulse[k]) / choose(used, s->mass[k], (real)R(1.0));
    sum = add_rows(sum, scaled_row(s->row[k], change[k]));
  }
  real whole = response_of_rows(c, sum, sum);
  real share = minimum(own / choose(whole > R(0.0), whole, (real)R(1.0)), R(2.0));
  mask pulls = s->impulse[0] + share * change[0] < R(0.0);
  for (uint k = 1; k < 4u; ++k) pulls = pulls | (s->impulse[k] + share * change[k] < R(0.0));
  share = choose(pulls, minimum(share, R(1.0)), share);
  for (uint k = 0; k < 4u; ++k) s->impulse[k] = s->impulse[k] + share * change[k];
  push_row(&c->ends, sum, share);
}

SHARED void solve_link_normals(GLOBAL const Parameters *parameters, link_contact *c, link_normals *s, real slop,
                               uint biased)
{
  softness soft = softness_of(parameters, c->shape);
  real target[4];
  for (uint k = 0; k < 4u; ++k)
    target[k] = normal_impulse(parameters, soft, slop, s->separation[k], speed_of_row(&c->ends, s->row[k]), s->mass[k],
                               s->impulse[k], biased);
  block_solve_link_normals(c, s, target);
}

/* Towards the target velocities of restitution, as apply_restitution_item of solve/contact.h. */
SHARED void bounce_link_normals(link_contact *c, link_normals *s, vec4 target_velocity, vec4 highest)
{
  real wanted[4];
  for (uint k = 0; k < 4u; ++k) {
    real target = component(target_velocity, k);
    mask applies = (target >= R(0.0)) & (component(highest, k) > R(0.0));
    wanted[k] =
        choose(applies, s->impulse[k] - s->mass[k] * (speed_of_row(&c->ends, s->row[k]) - target), s->impulse[k]);
  }
  block_solve_link_normals(c, s, wanted);
}

SHARED vec4 impulses_of_normals(const link_normals *s)
{
  return make_vec4(s->impulse[0], s->impulse[1], s->impulse[2], s->impulse[3]);
}

/* --- kernels -------------------------------------------------------------------------------------------------- */
/* All impulses of the contact. */
SHARED row_of_pair row_of_impulses(const link_contact *c, const row_of_pair *normals, vec4 normal, vec4 friction)
{
  tangents t = tangents_of(c->shape.normal);
  vec3 slide = add(scale(t.first, friction.x), scale(t.second, friction.y));
  row_of_pair r = row_along(add(xyz(c->center_a), c->shift.a), add(xyz(c->center_b), c->shift.b), slide);
  r = add_rows(r, row_about(scale(c->shape.normal, friction.z)));
  for (uint k = 0; k < 4u; ++k) r = add_rows(r, scaled_row(normals[k], component(normal, k)));
  return r;
}

SHARED vec4 solve_link_friction_if(mask rough, link_contact *c, vec4 friction, vec4 normal)
{
  link_contact slid = *c;
  vec4 solved = solve_link_friction(&slid, friction, (normal.x + normal.y) + (normal.z + normal.w));
  c->ends.a = choose_side(rough, slid.ends.a, c->ends.a);
  c->ends.b = choose_side(rough, slid.ends.b, c->ends.b);
  push_each_other_if(rough, &c->ends);
  return choose4(rough, solved, friction);
}

/* Contacts of an impact have more rounds. */
SHARED void solve_rounds_of_normals(GLOBAL const Parameters *parameters, link_contact *c, link_normals *s, real slop,
                                    uint biased)
{
  solve_link_normals(parameters, c, s, slop, biased);
  mask at_impact = c->shape.follows == R(0.0);
  if (!any_of(at_impact)) return;
  pushed_side a = c->ends.a, b = c->ends.b;
  vec4 once = impulses_of_normals(s);
  for (uint round = 0; round < IMPACT_ROUNDS; ++round) solve_link_normals(parameters, c, s, slop, biased);
  c->ends.a = choose_side(at_impact, c->ends.a, a);
  c->ends.b = choose_side(at_impact, c->ends.b, b);
  vec4 often = choose4(at_impact, impulses_of_normals(s), once);
  for (uint k = 0; k < 4u; ++k) s->impulse[k] = component(often, k);
}

/* Rows of impulses are read and written by the kernels below as those of solve/contact.h do. */
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
  add_warm_start_of_pair(&c->ends, row_of_impulses(c, s.row, normal, friction), parameters->inverse_substep,
                         warm_start_impulse);
}

SHARED void warm_start_link_contact(GLOBAL const Parameters *parameters, link_contact *c, read_patches patches,
                                    point_planes planes, write_contact_impulses impulses,
                                    GLOBAL float4 *warm_start_impulse, uint_lanes i)
{
  row_of_pair normals[4];
  for (uint k = 0; k < 4u; ++k) normals[k] = load_normal_row(c, patches, planes, k, i);
  row_of_pair all =
      row_of_impulses(c, normals, load_float4(impulses.normal, i), load_friction(parameters, impulses.friction, i));
  add_warm_start_of_pair(&c->ends, all, parameters->inverse_substep, warm_start_impulse);
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
  pushed_side a = c->ends.a, b = c->ends.b;
  link_normals s = load_link_normals(c, patches, planes, load_float4(impulses.normal, i), i);
  for (uint round = 0; round < RESTITUTION_ROUNDS; ++round) bounce_link_normals(c, &s, target_velocity, highest);
  c->ends.a = choose_side(bounces, c->ends.a, a);
  c->ends.b = choose_side(bounces, c->ends.b, b);
  store_float4_if(c->wanted & bounces, impulses.normal, i, impulses_of_normals(&s));
}

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
  point_planes planes = planes_of(counts);
  mask wanted = i != (uint_lanes)INDEX_NONE;
  i = choose(wanted, i, (uint_lanes)0u);
  link_contact c =
      load_link_contact(wanted, parameters, contacts, patches, bodies, links, states, solver_velocity, pass, i);
  if (pass == (uint)PASS_WARM_STARTING) {
    warm_start_link_contact(parameters, &c, patches, planes, contact_impulses, warm_start_impulse, i);
    return;
  }
  if (pass == (uint)PASS_BOUNCING) bounce_link_contact(&c, patches, planes, contact_impulses, i);
  else solve_link_contact(parameters, &c, patches, planes, contact_impulses, warm_start_impulse, pass, i);
  store_pair(&c.ends, solver_velocity);
}

SHARED void solve_link_contacts_item(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                                     read_turning_bodies bodies, read_links links, GLOBAL const uint *counts,
                                     write_link_states states, write_contact_impulses contact_impulses,
                                     GLOBAL float4 *solver_velocity, GLOBAL float4 *warm_start_impulse, uint pass,
                                     item_index i)
{
  uint_lanes a = load_uint(contacts.a, i), b = load_uint(contacts.b, i), link = choose(is_link(links.of_body, a), a, b);
  mask wanted = is_mixed(states, articulation_of_body(links.of_body, link));
  if (any_of(wanted))
    solve_link_contact_at(parameters, contacts, patches, bodies, links, counts, states, contact_impulses,
                          solver_velocity, warm_start_impulse, pass, choose(wanted, i, (uint_lanes)INDEX_NONE));
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
