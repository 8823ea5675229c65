/* rows.h - limits, friction, motors and drives with a largest force of the joints of a tree: constraint rows of one
 * degree of freedom each, solved one after another (Gauss-Seidel) by impulses that the whole tree answers.
 *
 * A row is that of a maximal joint (shared/joints/axes.h); only its response and its speed come from the tree. A sweep
 * (sweep.h) comes to all joints.
 *
 *   rows in reach    drives, friction, held joints, and stops that a joint may come to in this substep
 *   rows found late  of joints that would pass a stop because others have pushed them; in biased passes, a sweep of its
 *                    own
 *
 * Most stops are far away, so most joints have no row, and a tree of which nothing has pushed a joint finds none late.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_ROWS_H
#define TANDEM_SHARED_ARTICULATIONS_ROWS_H

#include "shared/articulations/loads.h"
#include "shared/articulations/sweep.h"

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

/* Whether the joint may get an impulse from a row in this pass, or has one. limit: the impulse of its limit. */
SHARED mask has_row_in_reach(GLOBAL const Parameters *parameters, const joint_axis *a, const axis_row *r, real limit,
                             uint pass)
{
  mask near = minimum(r->at.value - a->lower, a->upper - r->at.value) <= stop_reach(parameters, a, r->speed, pass);
  return always_has_row(a) | (limit != R(0.0)) | near;
}

/* Whether the joint passes a stop in this substep that has done nothing to it so far. */
SHARED mask has_late_row(GLOBAL const Parameters *parameters, const joint_axis *a, const axis_row *r, real limit)
{
  real end = r->at.value + r->speed * parameters->substep;
  return ((end < a->lower) | (end > a->upper)) & (limit == R(0.0));
}

/* change: of the velocity of the joint since the tree was settled. */
SHARED axis_row row_of_link(const articulation *t, tree_link l, real change)
{
  axis_row r;
  r.at.value = load_state(t, l.k, (uint)STATE_JOINT_POSITION).x;
  r.at.direction = r.at.turn = r.moment_a = r.moment_b = zero3();
  r.response = r.shared_response = load_single_factor(t, l).response;
  r.mass = inverse_if_positive(r.response);
  r.leak = R(1.0);
  r.crowded = never_crowded();
  r.speed = load_state(t, l.k, (uint)STATE_JOINT_VELOCITY).x + change;
  return r;
}

/* Which rows a sweep solves. */
enum { ROWS_IN_REACH, ROWS_FOUND_LATE };

/* At a link at which the sweep has arrived. Whether the rows have pushed. */
SHARED mask solve_rows_at_link(GLOBAL const Parameters *parameters, const articulation *t, tree_link l, real change,
                               uint pass, uint which)
{
  mask wanted = l.exists & has_one_freedom(l), pushes = wanted & !wanted;
  if (!any_of(wanted)) return pushes;
  axis_row r = row_of_link(t, l, change);
  joint_axis axis = axis_of_rows(t, l);
  vec4 kept = load_state(t, l.k, (uint)STATE_ROW_IMPULSE);
  wanted = wanted & (which == (uint)ROWS_IN_REACH ? has_row_in_reach(parameters, &axis, &r, kept.y, pass)
                                                  : has_late_row(parameters, &axis, &r, kept.y));
  if (!any_of(wanted)) return pushes;
  real sum = solve_rows_of_axis(parameters, &r, &axis, &kept, pass);
  store_state(wanted, t, l.k, (uint)STATE_ROW_IMPULSE, kept);
  pushes = wanted & (sum != R(0.0));
  if (any_of(pushes)) push_joint_on_way_if(pushes, t, l, sum);
  return pushes;
}

/* Whether rows have pushed. */
CALLED mask sweep_rows_if(mask wanted, GLOBAL const Parameters *parameters, const articulation *tree, uint pass,
                          uint which)
{
  articulation own = *tree;
  const articulation *t = &own;
  mask pushed = wanted & !wanted;
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = go_to_link_if(wanted, t, k);
    vec3 change = arrive_at_link(t, l);
    pushed = pushed | solve_rows_at_link(parameters, t, l, change.x, pass, which);
  }
  end_sweep_if(wanted, t);
  return pushed;
}

CALLED mask has_rows_found_late(GLOBAL const Parameters *parameters, const articulation *tree)
{
  articulation own = *tree;
  const articulation *t = &own;
  mask late = has_links(t) & !has_links(t);
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    axis_row r = row_of_link(t, l, R(0.0));
    joint_axis axis = load_tree_axis(t, l);
    mask one = l.exists & has_one_freedom(l);
    late = late | (one & has_late_row(parameters, &axis, &r, load_state(t, l.k, (uint)STATE_ROW_IMPULSE).y));
  }
  return late;
}

/* Of a settled tree, which stays settled. */
SHARED void solve_rows_found_late_if(mask wanted, GLOBAL const Parameters *parameters, const articulation *t)
{
  if (!any_of(wanted)) return;
  mask late = wanted & has_rows_found_late(parameters, t);
  if (!any_of(late)) return;
  sweep_rows_if(late, parameters, t, (uint)PASS_BIASED, (uint)ROWS_FOUND_LATE);
  settle_tree_if(late, t);
}

/* One pass, which leaves the tree settled. Contacts and joints of others may have pushed it before. */
SHARED void solve_tree_rows(GLOBAL const Parameters *parameters, const articulation *t, uint pass)
{
  mask pushed = sweep_rows_if(has_links(t), parameters, t, pass, (uint)ROWS_IN_REACH);
  settle_tree(t);
  if (pass == (uint)PASS_BIASED) solve_rows_found_late_if(pushed, parameters, t);
}

#endif
