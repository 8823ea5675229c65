/* joint_forces.h - what the joint of each link pushed it with in the last substep of a step, for programs that read it
 * as a sensor of force and torque. No motion depends on it.
 *
 * Joints of trees have no impulses. But the momentum that a link has gained, less what gravity, forces, contacts and
 * other joints gave it, came from its own joint and from those of its children:
 *
 *     begin_tree_balance    before the substep:    - momentum - gravity and forces over the substep
 *     split_tree_balance    before the tree moves: + momentum; another balance begins with its opposite
 *     sum_tree_balance      after the last pass:   - impulses of contacts and of joints from outside; the other one
 *                           + momentum. From the leaves inward, what a link has from its joint is added to its parent's
 *     commit_tree_balance   of the links that kernels run, to their bodies; of all other bodies 0
 *
 * Forces, contacts and rows act where the tree stands before it moves, so the arms of the first balance are those from
 * before. The motion is a symmetric rule, half of which is where it began and half where it ends (free_motion.h), so
 * the arms of the other one are means. With one kind of arms for both, the torque about the axis of a hinge was off by
 * a term of first order. STATE_FORCE and STATE_MOMENT have been cleared in the substep, and hold at its end what a pass
 * of warm starts has gathered.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_JOINT_FORCES_H
#define TANDEM_SHARED_ARTICULATIONS_JOINT_FORCES_H

#include "shared/articulations/bodies.h"

/* Of a link, two rows each: impulses at its centre before and while the tree moves, the first at last the force of its
 * joint at frame b; then the arms of its joint before the substep. */
enum {
  BALANCE_STANDING,
  BALANCE_MOVING = BALANCE_STANDING + 2,
  BALANCE_FROM_PARENT = BALANCE_MOVING + 2,
  BALANCE_TO_CENTER,
  BALANCE_ROWS
};

SHARED vec3 load_balance(GLOBAL const float4 *balance, const articulation *t, shape_uint k, uint row)
{
  return xyz(load_row(balance, tree_row(t, (uint)BALANCE_ROWS, k, row)));
}
SHARED void store_balance_if(mask m, GLOBAL float4 *balance, const articulation *t, shape_uint k, uint row, vec3 value)
{
  store_row_if(m, balance, tree_row(t, (uint)BALANCE_ROWS, k, row), extend(value, R(0.0)));
}
/* Two rows: a moment and a force. */
SHARED spatial_force load_impulse(GLOBAL const float4 *balance, const articulation *t, shape_uint k, uint row)
{
  spatial_force f = {load_balance(balance, t, k, row), load_balance(balance, t, k, row + 1u)};
  return f;
}
SHARED void store_impulse_if(mask m, GLOBAL float4 *balance, const articulation *t, shape_uint k, uint row,
                             spatial_force f)
{
  store_balance_if(m, balance, t, k, row, f.moment);
  store_balance_if(m, balance, t, k, row + 1u, f.force);
}

/* Gravity, and what programs and modules push the body with. */
SHARED spatial_force given_force_of_link(read_links links, GLOBAL const float4 *body_mass,
                                         GLOBAL const float4 *solver_force, const articulation *t, tree_link l,
                                         vec3 gravity, uint has_forces)
{
  uint_lanes body = body_of_link(links, t, l.k);
  spatial_force f = {zero3(), scale(gravity, mass_of_link(t, l) * load_float4(body_mass, body).w)};
  if (has_forces) {
    f.force = add(f.force, xyz(load_float4(solver_force, body * 2u)));
    f.moment = xyz(load_float4(solver_force, body * 2u + 1u));
  }
  return f;
}

/* An item is a tree, as it is before accelerate_articulations. has_forces: whether the scene has forces. */
SHARED void begin_tree_balance_item(GLOBAL const Parameters *parameters, read_links links,
                                    GLOBAL const float4 *body_mass, GLOBAL const float4 *body_gravity,
                                    GLOBAL const float4 *solver_force, write_link_states states,
                                    GLOBAL float4 *link_balance, uint has_forces, item_index i)
{
  articulation t = articulation_at(links, states, (uint_lanes)i);
  vec3 gravity = gravity_at(parameters, body_gravity, body_of_link(links, &t, 0u));
  for (uint k = 0; k < t.most_links; ++k) {
    tree_link l = tree_link_of(&t, k);
    spatial_force given = given_force_of_link(links, body_mass, solver_force, &t, l, gravity, has_forces);
    spatial_force begun = add_forces(own_momentum_of_link(&t, l), scaled_force(given, parameters->substep));
    placed_joint j = load_placed_joint(&t, l);
    store_impulse_if(l.exists, link_balance, &t, l.k, (uint)BALANCE_STANDING, scaled_force(begun, R(-1.0)));
    store_balance_if(l.exists, link_balance, &t, l.k, (uint)BALANCE_FROM_PARENT, j.from_parent);
    store_balance_if(l.exists, link_balance, &t, l.k, (uint)BALANCE_TO_CENTER, j.to_center);
  }
}

/* An item is a tree, which has not moved yet. */
SHARED void split_tree_balance_item(read_links links, write_link_states states, GLOBAL float4 *link_balance,
                                    item_index i)
{
  articulation t = articulation_at(links, states, (uint_lanes)i);
  for (uint k = 0; k < t.most_links; ++k) {
    tree_link l = tree_link_of(&t, k);
    spatial_force now = own_momentum_of_link(&t, l),
                  begun = load_impulse(link_balance, &t, l.k, (uint)BALANCE_STANDING);
    store_impulse_if(l.exists, link_balance, &t, l.k, (uint)BALANCE_STANDING, add_forces(begun, now));
    store_impulse_if(l.exists, link_balance, &t, l.k, (uint)BALANCE_MOVING, scaled_force(now, R(-1.0)));
  }
}

/* What a link has from its joint, at the joint; it is added to what its parent has. */
SHARED spatial_force pass_balance_inward(GLOBAL float4 *link_balance, const articulation *t, tree_link l, uint row,
                                         spatial_force at_center, vec3 from_parent, vec3 to_center)
{
  spatial_force at_joint = force_at(at_center, negate(to_center));
  spatial_force parents = load_impulse(link_balance, t, l.parent, row);
  parents = add_forces(parents, force_at(at_joint, negate(from_parent)));
  store_impulse_if(l.exists & !l.is_root, link_balance, t, l.parent, row, parents);
  return at_joint;
}

/* The links beyond this one have been summed. */
SHARED void sum_balance_of_link(GLOBAL const Parameters *parameters, GLOBAL float4 *link_balance, const articulation *t,
                                tree_link l)
{
  placed_joint j = load_placed_joint(t, l);
  vec3 from_parent = load_balance(link_balance, t, l.k, (uint)BALANCE_FROM_PARENT),
       to_center = load_balance(link_balance, t, l.k, (uint)BALANCE_TO_CENTER);
  spatial_force outer = {xyz(load_state(t, l.k, (uint)STATE_MOMENT)), xyz(load_state(t, l.k, (uint)STATE_FORCE))};
  spatial_force standing = subtract_forces(load_impulse(link_balance, t, l.k, (uint)BALANCE_STANDING),
                                           scaled_force(outer, parameters->substep));
  spatial_force moving =
      add_forces(load_impulse(link_balance, t, l.k, (uint)BALANCE_MOVING), own_momentum_of_link(t, l));
  standing = pass_balance_inward(link_balance, t, l, (uint)BALANCE_STANDING, standing, from_parent, to_center);
  moving =
      pass_balance_inward(link_balance, t, l, (uint)BALANCE_MOVING, moving,
                          scale(add(from_parent, j.from_parent), R(0.5)), scale(add(to_center, j.to_center), R(0.5)));
  spatial_force force = scaled_force(add_forces(standing, moving), parameters->inverse_substep);
  store_impulse_if(l.exists, link_balance, t, l.k, (uint)BALANCE_STANDING, force);
}

/* An item is a tree. */
SHARED void sum_tree_balance_item(GLOBAL const Parameters *parameters, read_links links, write_link_states states,
                                  GLOBAL float4 *link_balance, item_index i)
{
  articulation t = articulation_at(links, states, (uint_lanes)i);
  for (uint n = t.most_links; n > 0u; --n) sum_balance_of_link(parameters, link_balance, &t, tree_link_of(&t, n - 1u));
}

#ifndef TANDEM_LANES /* ITEM kernels take one item at a time */
/* An item is a body. A tree in quarantine has no links. */
SHARED void commit_tree_balance_item(read_links links, GLOBAL const float4 *link_balance,
                                     GLOBAL float4 *body_joint_force, uint i)
{
  vec4 force = extend(zero3(), R(0.0)), torque = force;
  GLOBAL const uint *place = links.place;
  if (is_link(links.of_body, i)) place = links.place + (uint)PLACE_WORDS * articulation_of_body(links.of_body, i);
  if (is_link(links.of_body, i) && place[3] > 0u) {
    tree_place at = place_beside(place[0], place[1], place[2]);
    uint k = links.of_body[LINK_WORDS * i + 2u], rows = (uint)BALANCE_ROWS;
    torque = load_row(link_balance, row_in(&at, place[0], rows, k, rows, (uint)BALANCE_STANDING));
    force = load_row(link_balance, row_in(&at, place[0], rows, k, rows, (uint)BALANCE_STANDING + 1u));
  }
  store_float4(body_joint_force, i * 2u, force);
  store_float4(body_joint_force, i * 2u + 1u, torque);
}
#endif

#endif
