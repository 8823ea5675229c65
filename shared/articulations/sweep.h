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

/* An impulse on a link at which the sweep is, or on one beyond which it is. change: of the link before; that after. */
SHARED spatial_motion push_visited_if(mask wanted, const articulation *t, shape_uint k, spatial_motion change,
                                      spatial_force impulse)
{
  symmetric6 inverse = load_symmetric6(t, k);
  spatial_motion pushed = add_motions(change, inverse_times(&inverse, impulse));
  store_motion(wanted, t, k, (uint)WORK_CHANGE, pushed);
  add_to_force(wanted, t, k, (uint)WORK_FORCE, impulse);
  return choose_motion(wanted, pushed, change);
}
SHARED void push_on_way_if(mask wanted, const articulation *t, shape_uint k, spatial_force impulse)
{
  push_visited_if(wanted, t, k, load_motion(t, k, (uint)WORK_CHANGE), impulse);
}

/* A link at which the sweep has arrived. parent: the change of its parent. */
typedef struct {
  factored_joint joint;
  spatial_force pending;
  spatial_motion parent;
  pending_motion change;
} visited_link;

SHARED void load_visited_link(const articulation *t, tree_link l, visited_link *v)
{
  v->joint = load_factored_joint(t, l);
  v->pending = load_pending(t, l.k);
}

/* before: the change of link k - 1. v has been loaded. */
SHARED void arrive_at_link(const articulation *t, tree_link l, uint k, spatial_motion before, visited_link *v)
{
  v->parent = motion_of_parent(t, l, k, before, (uint)WORK_CHANGE);
  v->change = link_change(t, l, &v->joint, v->pending, v->parent);
}

/* An impulse of the joint at which the sweep has arrived, in its numbers; of one degree of freedom. */
SHARED void push_joint_on_way_if(mask wanted, const articulation *t, tree_link l, visited_link *v, real impulse)
{
  joint_share s = share_of_joint(t, l, &v->joint, no_force(), make_vec3(impulse, R(0.0), R(0.0)));
  spatial_force of_joint = {s.pending, zero3()};
  v->pending = choose_force(wanted, add_forces(v->pending, of_joint), v->pending);
  store_force(wanted, t, l.k, (uint)WORK_PENDING, v->pending);
  mask inner = wanted & !l.is_root;
  if (any_of(inner)) v->parent = push_visited_if(inner, t, l.parent, v->parent, s.rest);
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

SHARED void leave_link_if(mask wanted, const articulation *t, tree_link l)
{
  spatial_force pushed = load_force(t, l.k, (uint)WORK_FORCE);
  wanted = wanted & (is_nonzero(pushed.force) | is_nonzero(pushed.moment));
  if (!any_of(wanted)) return;
  factored_joint f = load_factored_joint(t, l);
  joint_share s = share_of_joint(t, l, &f, pushed, zero3());
  add_to_force(wanted, t, l.k, (uint)WORK_PENDING, pending_share(l, s, pushed));
  push_on_way_if(wanted & !l.is_root, t, l.parent, s.rest);
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
