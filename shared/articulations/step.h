/* step.h - the kernels of articulations in a step: an item is a tree (substep.h has the order of a substep).
 *
 *   begin_articulations         coordinates from bodies; the tree is factored
 *   each substep
 *     accelerate_articulations  gravity, forces, drives, and the warm start of contacts and rows
 *     solve_articulations       rows of joints; with the contacts of links (contact.h) before it, what is pending
 *                               becomes velocities
 *     move_articulations        to the next configuration
 *     solve_articulations       relaxing
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_STEP_H
#define TANDEM_SHARED_ARTICULATIONS_STEP_H

#include "shared/articulations/bodies.h"
#include "shared/articulations/rows.h"

SHARED void begin_articulations_item(GLOBAL const Parameters *parameters, read_links links, read_bodies bodies,
                                     write_link_states states, write_moved_bodies moved, item_index i)
{
  articulation t = articulation_at(links, states, (uint_lanes)i);
  for (uint word = 0u; word < TREE_COLOR_WORDS; ++word)
    store_uint(states.colors, TREE_COLOR_WORDS * (uint_lanes)i + word, (uint_lanes)0u);
  read_articulation(links, bodies, &t, parameters->substep);
  factor_tree(&t);
  invert_link_inertias(&t);
  write_bodies(links, bodies, &t, moved);
}

/* What pushes a link besides the gravity that all links have: from outside, the force on its body, and the share of
 * gravity by which its factor differs from 1. has_forces: whether the scene has forces. */
SHARED spatial_force load_body_force(read_links links, GLOBAL const float4 *body_mass,
                                     GLOBAL const float4 *solver_force, const articulation *t, tree_link l,
                                     vec3 gravity, uint has_forces)
{
  uint_lanes body = body_of_link(links, t, l.k);
  spatial_force f = load_outside_force(t, l);
  f.force = add_scaled(f.force, gravity, mass_of_link(t, l) * (load_float4(body_mass, body).w - R(1.0)));
  if (!has_forces) return f;
  f.force = add(f.force, xyz(load_float4(solver_force, body * 2u)));
  f.moment = add(f.moment, xyz(load_float4(solver_force, body * 2u + 1u)));
  return f;
}

/* STATE_FORCE and STATE_MOMENT hold what the contacts of the last substep pushed with; those of this one are gathered
 * anew. */
SHARED void clear_outer_force(const articulation *t, tree_link l)
{
  vec4 none = extend(zero3(), R(0.0));
  store_state(l.exists, t, l.k, (uint)STATE_FORCE, none);
  store_state(l.exists, t, l.k, (uint)STATE_MOMENT, none);
}

SHARED void accelerate_articulations_item(GLOBAL const Parameters *parameters, read_links links,
                                          GLOBAL const float4 *body_mass, GLOBAL const float4 *body_gravity,
                                          GLOBAL const float4 *solver_force, write_link_states states,
                                          GLOBAL float4 *solver_velocity, uint has_forces, item_index i)
{
  articulation t = articulation_at(links, states, (uint_lanes)i);
  vec3 gravity = gravity_at(parameters, body_gravity, body_of_link(links, &t, 0u));
  for (uint k = 0; k < t.most_links; ++k) {
    tree_link l = tree_link_of(&t, k);
    spatial_force f = load_body_force(links, body_mass, solver_force, &t, l, gravity, has_forces);
    load_forces_of_link(&t, l, with_weight(&t, l, f, gravity), parameters->substep);
    clear_outer_force(&t, l);
  }
  push_links_and_joints(&t);
  settle_tree(&t);
  write_velocities(links, &t, solver_velocity);
}

/* Solves the rows of joints, which PASS_BOUNCING has not, and settles what these and the contacts have pushed. */
SHARED void solve_articulations_item(GLOBAL const Parameters *parameters, read_links links, write_link_states states,
                                     GLOBAL float4 *solver_velocity, uint pass, item_index i)
{
  articulation t = articulation_in_pass(links, states, (uint_lanes)i, pass);
  if (pass == (uint)PASS_BOUNCING) settle_tree(&t);
  else solve_tree_rows(parameters, &t, kind_of_pass(pass));
  write_velocities(links, &t, solver_velocity);
}

/* Whether a free tree falls as one body does whose contacts are out of reach (integrate/positions.h): all of its links
 * have the gravity of the world, and no contact bears or has pushed any. */
SHARED mask tree_falls_freely(read_links links, GLOBAL const float4 *body_mass, GLOBAL const uint *body_falls,
                              const articulation *t)
{
  mask falls = tree_link_of(t, 0u).is_free & !is_pushed(t) & has_links(t);
  if (!any_of(falls)) return falls;
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    uint_lanes body = body_of_link(links, t, l.k);
    mask touches = load_uint(body_falls, body) == 0u, has_own_gravity = load_float4(body_mass, body).w != R(1.0);
    falls = falls & !(l.exists & (touches | has_own_gravity));
  }
  return falls;
}

/* Takes back what the symplectic Euler step falls too far, so that the tree moves on the exact parabola. */
SHARED void return_to_parabola_if(mask falls, const articulation *t, vec3 gravity, real h)
{
  double_float3 at = moved_position(root_position(t), scale(gravity, R(-0.5) * h * h));
  store_root(falls, t, (uint)ROOT_POSITION, extend(at.high, R(0.0)));
  store_root(falls, t, (uint)ROOT_POSITION + 1u, extend(at.low, R(0.0)));
}

SHARED void move_articulations_item(GLOBAL const Parameters *parameters, read_links links, read_bodies bodies,
                                    GLOBAL const float4 *body_mass, GLOBAL const uint *body_falls,
                                    write_link_states states, write_moved_bodies moved, item_index i)
{
  articulation t = articulation_at(links, states, (uint_lanes)i);
  move_tree_freely(&t, parameters->substep);
  vec3 gravity = gravity_at(parameters, bodies.gravity, body_of_link(links, &t, 0u));
  return_to_parabola_if(tree_falls_freely(links, body_mass, body_falls, &t), &t, gravity, parameters->substep);
  note_pushed_if(has_links(&t), &t, R(0.0));
  store_uint(states.colors, TREE_COLOR_WORDS * (uint_lanes)i, (uint_lanes)0u); /* its paths are another's: path.h */
  write_bodies(links, bodies, &t, moved);
}

#endif
