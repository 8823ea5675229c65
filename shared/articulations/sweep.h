/* sweep.h - from link to link of a tree, so that rows at each link see all that the rows before it have done.
 *
 *           0          arrive at a link   its change of velocity follows from that of its parent
 *         /   \        push it            what the push does to the link itself is known at once (link_inertia.h)
 *        1     3       leave it           what its joint does not take of the pushes goes to its parent, which is then
 *        |    / \                         as if it had been pushed itself
 *        2   4   5
 *                      0  1  2  (2 1)  3  4  (4)  5  (5 3 0)     in brackets: left
 *
 * The links of a tree stand in the order in which this way comes to them. A sweep over all of them costs as much as two
 * walks over the tree, however many rows there are.
 *
 * WORK_CHANGE is the change of a link since the tree was settled; it holds between arriving and leaving. WORK_FORCE is
 * what has pushed the link since the sweep arrived. After the sweep all that the rows have done is pending.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_SWEEP_H
#define TANDEM_SHARED_ARTICULATIONS_SWEEP_H

#include "shared/articulations/respond.h"

/* A link at which the sweep is, or one beyond which it is, as an impulse on it needs it. */
typedef struct {
  symmetric6 inverse;
  spatial_motion change;
  spatial_force force; /* WORK_FORCE */
} way_link;

SHARED way_link load_way_link(const articulation *t, shape_uint k)
{
  way_link w = {load_symmetric6(t, k), load_motion(t, k, (uint)WORK_CHANGE), load_force(t, k, (uint)WORK_FORCE)};
  return w;
}

/* The change of link k then. */
SHARED spatial_motion push_way_link_if(mask wanted, const articulation *t, shape_uint k, const way_link *w,
                                       spatial_force impulse)
{
  spatial_motion pushed = add_motions(w->change, inverse_times(&w->inverse, impulse));
  store_motion(wanted, t, k, (uint)WORK_CHANGE, pushed);
  store_force(wanted, t, k, (uint)WORK_FORCE, add_forces(w->force, impulse));
  return choose_motion(wanted, pushed, w->change);
}
SHARED void push_on_way_if(mask wanted, const articulation *t, shape_uint k, spatial_force impulse)
{
  way_link w = load_way_link(t, k);
  push_way_link_if(wanted, t, k, &w, impulse);
}

/* A link at which the sweep has arrived. parent: the change of its parent. A CPU reads the rest of the parent where the
 * joint pushes it; a device has read inertias early. */
typedef struct {
  factored_joint joint;
  spatial_force pending;
  spatial_motion parent;
  pending_motion change;
#ifdef READS_AHEAD
  symmetric6 inverse;
  way_link way; /* its parent */
#endif
} visited_link;

SHARED void load_visited_link(const articulation *t, tree_link l, visited_link *v)
{
  v->joint = load_factored_joint(t, l);
  v->pending = load_pending(t, l.k);
#ifdef READS_AHEAD
  v->inverse = load_symmetric6(t, l.k);
#endif
}

/* What the sweep knows of link k - 1, which nothing has pushed since the sweep arrived there. */
typedef struct {
  spatial_motion change;
#ifdef READS_AHEAD
  symmetric6 inverse;
#endif
} link_before;

SHARED link_before link_before_of(const visited_link *v)
{
  link_before b;
  b.change = v->change.link;
#ifdef READS_AHEAD
  b.inverse = v->inverse;
#endif
  return b;
}
SHARED link_before ground_before(void)
{
  link_before b;
  b.change = no_motion();
#ifdef READS_AHEAD
  b.inverse = zero_symmetric6();
#endif
  return b;
}

/* v has been loaded. */
SHARED void arrive_at_link(const articulation *t, tree_link l, uint k, const link_before *before, visited_link *v)
{
#ifdef READS_AHEAD
  if (any_of(follows_at_once(l, k))) {
    way_link way = {before->inverse, before->change, no_force()};
    v->way = way;
  } else {
    v->way = load_way_link(t, l.parent);
    v->way.change = choose_motion(l.is_root, no_motion(), v->way.change);
  }
  v->parent = v->way.change;
#else
  v->parent = motion_of_parent(t, l, k, before->change, (uint)WORK_CHANGE);
#endif
  v->change = link_change(t, l, &v->joint, v->pending, v->parent);
}

/* Once a visit: the next push would need what this one has written. */
SHARED void push_parent_on_way_if(mask wanted, const articulation *t, tree_link l, visited_link *v,
                                  spatial_force impulse)
{
  if (!any_of(wanted)) return;
#ifdef READS_AHEAD
  way_link way = v->way;
#else
  way_link way = {load_symmetric6(t, l.parent), v->parent, load_force(t, l.parent, (uint)WORK_FORCE)};
#endif
  v->parent = push_way_link_if(wanted, t, l.parent, &way, impulse);
}

/* An impulse of the joint at which the sweep has arrived, in its numbers; of one degree of freedom. */
SHARED void push_joint_on_way_if(mask wanted, const articulation *t, tree_link l, visited_link *v, real impulse)
{
  joint_share s = share_of_joint(t, l, &v->joint, no_force(), make_vec3(impulse, R(0.0), R(0.0)));
  spatial_force of_joint = {s.pending, zero3()};
  v->pending = choose_force(wanted, add_forces(v->pending, of_joint), v->pending);
  store_force(wanted, t, l.k, (uint)WORK_PENDING, v->pending);
  push_parent_on_way_if(wanted & !l.is_root, t, l, v, s.rest);
  pending_motion change = link_change(t, l, &v->joint, v->pending, v->parent);
  v->change.link = choose_motion(wanted, change.link, v->change.link);
  v->change.joint = choose3(wanted, change.joint, v->change.joint);
}

/* Before the sweep goes on. */
SHARED void store_visit(const articulation *t, tree_link l, const visited_link *v)
{
  store_motion(l.exists, t, l.k, (uint)WORK_CHANGE, v->change.link);
  store_force(l.exists, t, l.k, (uint)WORK_FORCE, no_force());
}

/* Most links that are left have been pushed on a device, by one of the trees of a warp, so it reads all of it at
 * once. */
SHARED void leave_link_if(mask wanted, const articulation *t, tree_link l)
{
  spatial_force pushed = load_force(t, l.k, (uint)WORK_FORCE);
  wanted = wanted & (is_nonzero(pushed.force) | is_nonzero(pushed.moment));
#ifndef READS_AHEAD
  if (!any_of(wanted)) return;
#endif
  factored_joint f = load_factored_joint(t, l);
  spatial_force pending = load_pending(t, l.k);
  way_link parent = load_way_link(t, l.parent);
  if (!any_of(wanted)) return;
  joint_share s = share_of_joint(t, l, &f, pushed, zero3());
  store_force(wanted, t, l.k, (uint)WORK_PENDING, add_forces(pending, pending_share(l, s, pushed)));
  push_way_link_if(wanted & !l.is_root, t, l.parent, &parent, s.rest);
}

/* Leaves links from `at` on towards the root until the sweep is at `next`. */
SHARED void return_to_link_if(mask wanted, const articulation *t, shape_uint at, shape_uint next)
{
  for (mask beyond = wanted & (at != next); any_of(beyond); beyond = beyond & (at != next)) {
    tree_link l = tree_link_of(t, at);
    leave_link_if(beyond, t, l);
    at = l.parent;
  }
}

/* To link k, l, from link k - 1. */
SHARED void go_to_link_if(mask wanted, const articulation *t, tree_link l, uint k)
{
  if (k > 0u) return_to_link_if(wanted & l.exists, t, k - 1u, l.parent);
}

/* From the last link to the root, which is left too. */
SHARED void end_sweep_if(mask wanted, const articulation *t)
{
  wanted = wanted & has_links(t);
  return_to_link_if(wanted, t, last_link_of(&t->place, t->links, t->most_links), 0u);
  leave_link_if(wanted, t, tree_link_of(t, 0u));
}

#endif
