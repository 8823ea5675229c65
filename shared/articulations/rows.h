/* rows.h - limits, friction, motors and drives with a largest force of the joints of a tree: constraint rows of one
 * degree of freedom each, solved one after another (Gauss-Seidel) by impulses that the whole tree answers.
 *
 * A row is that of a maximal joint (shared/joints/axes.h); only its response and its speed come from the tree. What is
 * pending of a settled tree (respond.h) is what the rows of a pass have done so far. Most limits are far away, so most
 * passes push nothing, and then no row walks through the tree.
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

/* Beyond this, in m or rad, m/s or rad/s, nothing is a limit. */
#define UNLIMITED R(1e18)

SHARED mask has_rows(tree_link l, joint_axis a)
{
  mask limited = (a.lower > -UNLIMITED) | (a.upper < UNLIMITED) | (a.largest_speed < UNLIMITED);
  mask driven = (a.stiffness != R(0.0)) | (a.damping != R(0.0)) | (a.friction > R(0.0));
  return l.exists & has_one_freedom(l) & (limited | driven);
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
SHARED mask solve_rows_of_link(GLOBAL const Parameters *parameters, const articulation *t, tree_link l,
                               const joint_axis *axis, uint pass, mask is_pending)
{
  axis_row r = row_of_link(t, l, is_pending);
  vec4 kept = load_state(t, l.k, (uint)STATE_ROW_IMPULSE);
  real sum = solve_rows_of_axis(parameters, &r, axis, &kept, pass);
  store_state(l.exists, t, l.k, (uint)STATE_ROW_IMPULSE, kept);
  mask pushes = l.exists & (sum != R(0.0));
  if (any_of(pushes)) push_link_if(pushes, t, l.k, no_force(), make_vec3(sum, R(0.0), R(0.0)));
  return is_pending | pushes;
}

/* One pass over a settled tree, which it leaves settled. */
SHARED void solve_tree_rows(GLOBAL const Parameters *parameters, const articulation *t, uint pass)
{
  mask has_tree = has_links(t), is_pending = has_tree & !has_tree;
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    joint_axis axis = axis_of_rows(t, l);
    l.exists = has_rows(l, axis);
    if (any_of(l.exists)) is_pending = solve_rows_of_link(parameters, t, l, &axis, pass, is_pending);
  }
  if (any_of(is_pending)) settle_tree_if(is_pending, t);
}

#endif
