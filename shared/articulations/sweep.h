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

/* An impulse on a link at which the sweep is, or on one beyond which it is. */
SHARED void push_on_way_if(mask wanted, const articulation *t, shape_uint k, spatial_force impulse)
{
  symmetric6 inverse = load_symmetric6(t, k);
  spatial_motion change = add_motions(load_motion(t, k, (uint)WORK_CHANGE), inverse_times(&inverse, impulse));
  store_motion(wanted, t, k, (uint)WORK_CHANGE, change);
  add_to_force(wanted, t, k, (uint)WORK_FORCE, impulse);
}

/* The change of the joint; numbers as pending has them. */
SHARED vec3 follow_parent(const articulation *t, tree_link l)
{
  vec3 change;
  store_motion(l.exists, t, l.k, (uint)WORK_CHANGE,
               link_change(t, l, load_parent_motion(t, l, (uint)WORK_CHANGE), &change));
  return change;
}

SHARED vec3 arrive_at_link(const articulation *t, tree_link l)
{
  store_force(l.exists, t, l.k, (uint)WORK_FORCE, no_force());
  return follow_parent(t, l);
}

/* An impulse of the joint at which the sweep has arrived, in its numbers; of one degree of freedom. */
SHARED void push_joint_on_way_if(mask wanted, const articulation *t, tree_link l, real impulse)
{
  joint_share s = share_of_joint(t, l, load_placed_joint(t, l), no_force(), make_vec3(impulse, R(0.0), R(0.0)));
  spatial_force pending = {s.pending, zero3()};
  add_to_force(wanted, t, l.k, (uint)WORK_PENDING, pending);
  push_on_way_if(wanted & !l.is_root, t, l.parent, s.rest);
  l.exists = wanted;
  follow_parent(t, l);
}

SHARED void leave_link_if(mask wanted, const articulation *t, tree_link l)
{
  spatial_force pushed = load_force(t, l.k, (uint)WORK_FORCE);
  wanted = wanted & (is_nonzero(pushed.force) | is_nonzero(pushed.moment));
  if (!any_of(wanted)) return;
  joint_share s = share_of_joint(t, l, load_placed_joint(t, l), pushed, zero3());
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

/* Link k, from link k - 1. */
SHARED tree_link go_to_link_if(mask wanted, const articulation *t, uint k)
{
  tree_link l = tree_link_of(t, k);
  l.exists = l.exists & wanted;
  if (k > 0u) return_to_link_if(l.exists, t, k - 1u, l.parent);
  return l;
}

/* From the last link to the root, which is left too. */
SHARED void end_sweep_if(mask wanted, const articulation *t)
{
  wanted = wanted & has_links(t);
  return_to_link_if(wanted, t, last_link_of(&t->place, t->links, t->most_links), 0u);
  leave_link_if(wanted, t, tree_link_of(t, 0u));
}

#endif
