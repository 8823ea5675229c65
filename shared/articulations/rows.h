/* rows.h - limits, friction, motors and drives with a largest force of the joints of a tree: constraint rows of one
 * degree of freedom each, solved one after another (Gauss-Seidel) by impulses that the whole tree answers.
 *
 * A row is that of a maximal joint (shared/joints/axes.h); only its response and its speed come from the tree. What is
 * pending of a settled tree (respond.h) is what the rows of a pass have done so far. If none has pushed, none walks
 * through the tree.
 *
 *   rows in reach    drives, friction, held joints, and stops that a joint may come to in this substep
 *   rows found late  of joints that would pass a stop because the rows in reach have pushed them; in biased passes
 *
 * Most stops are far away. Trees beside each other each go on to their own next row, so lanes and work-items wait for
 * the most rows that a tree has in reach, not for all joints that have a row in some tree.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_ROWS_H
#define TANDEM_SHARED_ARTICULATIONS_ROWS_H

#include "shared/articulations/loads.h"

/* Without its implicit drive, which is no row. */
SHARED joint_axis axis_of_rows(const articulation *t, tree_link l)
{
  joint_axis a = load_tree_axis(t, l);
  mask implicit = load_link(t, l.k, (uint)LINK_MOMENTS).w > R(0.0);
  a.stiffness = zero_if(implicit, a.stiffness);
  a.damping = zero_if(implicit, a.damping);
  return a;
}

/* rad/s and m/s. A stop is in reach if the joint gets there in the substep with twice its speed and this much more. */
#define STOP_REACH R(20.0)

SHARED mask always_has_row(const joint_axis *a)
{
  return (a->stiffness != R(0.0)) | (a->damping != R(0.0)) | (a->friction > R(0.0)) | (a->largest_speed < UNLIMITED) |
         (a->lower == a->upper);
}

/* A hard stop that is ahead does nothing in a relaxing pass. */
SHARED real stop_reach(GLOBAL const Parameters *parameters, const joint_axis *a, real speed, uint pass)
{
  real reach = (STOP_REACH + R(2.0) * magnitude(speed)) * parameters->substep;
  if (pass == (uint)PASS_BIASED) return reach;
  return choose(a->limit_stiffness > R(0.0), reach, (real)R(0.0));
}

/* Whether the joint may get an impulse from a row in this pass, or has one. */
SHARED mask has_row_in_reach(GLOBAL const Parameters *parameters, const articulation *t, tree_link l,
                             const joint_axis *a, uint pass)
{
  real value = load_state(t, l.k, (uint)STATE_JOINT_POSITION).x,
       speed = load_state(t, l.k, (uint)STATE_JOINT_VELOCITY).x;
  mask near = minimum(value - a->lower, a->upper - value) <= stop_reach(parameters, a, speed, pass);
  return always_has_row(a) | (load_state(t, l.k, (uint)STATE_ROW_IMPULSE).y != R(0.0)) | near;
}

/* Whether the joint passes a stop in this substep that has done nothing to it so far. */
SHARED mask has_late_row(GLOBAL const Parameters *parameters, const articulation *t, tree_link l, const joint_axis *a)
{
  real value = load_state(t, l.k, (uint)STATE_JOINT_POSITION).x,
       way = load_state(t, l.k, (uint)STATE_JOINT_VELOCITY).x * parameters->substep;
  mask passes = (value + way < a->lower) | (value + way > a->upper);
  return passes & (load_state(t, l.k, (uint)STATE_ROW_IMPULSE).y == R(0.0));
}

/* The first link from k on that has a row in reach, or in the second round one found late; the number of links if none
 * has. */
SHARED uint_lanes next_with_row(GLOBAL const Parameters *parameters, const articulation *t, uint_lanes k, uint pass,
                                uint round)
{
  mask searches = k < t->links;
  while (any_of(searches)) {
    tree_link l = tree_link_of(t, k);
    joint_axis axis = axis_of_rows(t, l);
    mask found = round == 0u ? has_row_in_reach(parameters, t, l, &axis, pass) : has_late_row(parameters, t, l, &axis);
    searches = searches & !(found & has_one_freedom(l));
    k = choose(searches, k + 1u, k);
    searches = searches & (k < t->links);
  }
  return k;
}

/* is_pending: whether rows have pushed the tree. */
SHARED axis_row row_of_link(const articulation *t, tree_link l, mask is_pending)
{
  vec3 change = zero3();
  mask walks = l.exists & is_pending;
  if (any_of(walks)) pending_change(t, choose(walks, l.k, t->links), &change);
  axis_row r;
  r.at.value = load_state(t, l.k, (uint)STATE_JOINT_POSITION).x;
  r.at.direction = r.at.turn = r.moment_a = r.moment_b = zero3();
  r.response = r.shared_response = load_single_factor(t, l).response;
  r.mass = inverse_if_positive(r.response);
  r.speed = load_state(t, l.k, (uint)STATE_JOINT_VELOCITY).x + change.x;
  return r;
}

/* Whether rows have pushed now. */
SHARED mask solve_rows_of_link(GLOBAL const Parameters *parameters, const articulation *t, tree_link l, uint pass,
                               mask is_pending)
{
  axis_row r = row_of_link(t, l, is_pending);
  joint_axis axis = axis_of_rows(t, l);
  vec4 kept = load_state(t, l.k, (uint)STATE_ROW_IMPULSE);
  real sum = solve_rows_of_axis(parameters, &r, &axis, &kept, pass);
  store_state(l.exists, t, l.k, (uint)STATE_ROW_IMPULSE, kept);
  mask pushes = l.exists & (sum != R(0.0));
  if (any_of(pushes)) push_link_if(pushes, t, l.k, no_force(), make_vec3(sum, R(0.0), R(0.0)));
  return is_pending | pushes;
}

/* One pass over a settled tree, which it leaves settled. A tree that no row has pushed finds none late. */
SHARED void solve_tree_rows(GLOBAL const Parameters *parameters, const articulation *t, uint pass)
{
  mask goes_on = has_links(t), none = goes_on & !goes_on;
  uint rounds = pass == (uint)PASS_BIASED ? 2u : 1u;
  for (uint round = 0u; round < rounds && any_of(goes_on); ++round) {
    mask is_pending = none;
    uint_lanes k = next_with_row(parameters, t, choose(goes_on, (uint_lanes)0u, t->links), pass, round);
    while (any_of(k < t->links)) {
      is_pending = solve_rows_of_link(parameters, t, tree_link_of(t, k), pass, is_pending);
      k = next_with_row(parameters, t, choose(k < t->links, k + 1u, k), pass, round);
    }
    if (any_of(is_pending)) settle_tree_if(is_pending, t);
    goes_on = is_pending;
  }
}

#endif
