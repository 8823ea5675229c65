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

/* What the rows of a joint need, without its implicit drive, which is no row. kept: their impulses. */
typedef struct {
  joint_axis axis;
  vec4 kept;
  real value, speed; /* speed: when the tree was settled */
} joint_rows;

SHARED joint_rows load_joint_rows(const articulation *t, tree_link l)
{
  mask implicit = load_link(t, l.k, (uint)LINK_MOMENTS).w > R(0.0);
  joint_rows r = {load_tree_axis(t, l), load_state(t, l.k, (uint)STATE_ROW_IMPULSE),
                  load_state(t, l.k, (uint)STATE_JOINT_POSITION).x, load_state(t, l.k, (uint)STATE_JOINT_VELOCITY).x};
  r.axis.stiffness = zero_if(implicit, r.axis.stiffness);
  r.axis.damping = zero_if(implicit, r.axis.damping);
  return r;
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
SHARED mask has_late_row(GLOBAL const Parameters *parameters, real lower, real upper, real value, real speed,
                         real limit)
{
  real end = value + speed * parameters->substep;
  return ((end < lower) | (end > upper)) & (limit == R(0.0));
}

/* change: of the velocity of the joint since the tree was settled. */
SHARED axis_row row_of_joint_axis(const joint_rows *of, const single_factor *factor, real change)
{
  axis_row r;
  r.at.value = of->value;
  r.at.direction = r.at.turn = r.moment_a = r.moment_b = zero3();
  r.response = r.shared_response = factor->response;
  r.mass = inverse_if_positive(r.response);
  r.leak = R(1.0);
  r.crowded = never_crowded();
  r.speed = of->speed + change;
  return r;
}

/* Which rows a sweep solves. */
enum { ROWS_IN_REACH, ROWS_FOUND_LATE };

/* What the sweep reads of a link. A CPU reads the rows where the sweep has arrived. */
typedef struct {
  visited_link link;
  joint_rows rows;
} swept_link;

SHARED void load_swept_link(const articulation *t, tree_link l, swept_link *s)
{
  load_visited_link(t, l, &s->link);
#ifdef READS_AHEAD
  s->rows = load_joint_rows(t, l);
#endif
}
SHARED void load_rows_of_swept_link(const articulation *t, tree_link l, swept_link *s)
{
#ifdef READS_AHEAD
  (void)t, (void)l, (void)s;
#else
  s->rows = load_joint_rows(t, l);
#endif
}

/* At a link at which the sweep has arrived. Whether the rows have pushed. */
SHARED mask solve_rows_at_link(GLOBAL const Parameters *parameters, const articulation *t, tree_link l, swept_link *at,
                               uint pass, uint which)
{
  mask wanted = l.exists & has_one_freedom(l), pushes = wanted & !wanted;
  if (!any_of(wanted)) return pushes;
  load_rows_of_swept_link(t, l, at);
  visited_link *v = &at->link;
  joint_rows *rows = &at->rows;
  axis_row r = row_of_joint_axis(rows, &v->joint.single, v->change.joint.x);
  wanted = wanted & (which == (uint)ROWS_IN_REACH ? has_row_in_reach(parameters, &rows->axis, &r, rows->kept.y, pass)
                                                  : has_late_row(parameters, rows->axis.lower, rows->axis.upper,
                                                                 r.at.value, r.speed, rows->kept.y));
  if (!any_of(wanted)) return pushes;
  real sum = solve_rows_of_axis(parameters, &r, &rows->axis, &rows->kept, pass);
  store_state(wanted, t, l.k, (uint)STATE_ROW_IMPULSE, rows->kept);
  pushes = wanted & (sum != R(0.0));
  if (any_of(pushes)) push_joint_on_way_if(pushes, t, l, v, sum);
  return pushes;
}

/* Whether rows have pushed. */
CALLED mask sweep_rows_if(mask wanted, GLOBAL const Parameters *parameters, const articulation *tree, uint pass,
                          uint which)
{
  articulation own = *tree;
  const articulation *t = &own;
  mask pushed = wanted & !wanted;
  link_before before = ground_before();
  BEGIN_WALK(swept_link, load_swept_link, t, 0u);
  for (uint k = 0; k < t->most_links; ++k) {
    WALK_TO(swept_link, load_swept_link, t, k, k + 1u);
    l.exists = l.exists & wanted;
    go_to_link_if(wanted, t, l, k);
    arrive_at_link(t, l, k, &before, &now.link);
    pushed = pushed | solve_rows_at_link(parameters, t, l, &now, pass, which);
    store_visit(t, l, &now.link);
    before = link_before_of(&now.link);
  }
  end_sweep_if(wanted, t);
  return pushed;
}

/* Of a settled link. */
SHARED mask joint_has_late_row(GLOBAL const Parameters *parameters, const articulation *t, tree_link l)
{
  vec4 range = load_row(t->range, tree_row(t, 1u, l.k, 0u));
  real value = load_state(t, l.k, (uint)STATE_JOINT_POSITION).x, speed = load_joint_velocity(t, l).x;
  return l.exists & has_one_freedom(l) &
         has_late_row(parameters, range.x, range.y, value, speed, load_state(t, l.k, (uint)STATE_ROW_IMPULSE).y);
}
CALLED mask has_rows_found_late(GLOBAL const Parameters *parameters, const articulation *tree)
{
  articulation own = *tree;
  const articulation *t = &own;
  mask late = has_links(t) & !has_links(t);
  for (uint k = 0; k < t->most_links; ++k) late = late | joint_has_late_row(parameters, t, tree_link_of(t, k));
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
