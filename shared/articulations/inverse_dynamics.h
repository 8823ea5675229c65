/* inverse_dynamics.h - the forces of the joints that give a tree the accelerations that are asked for (recursive
 * Newton-Euler: accelerations outward, forces inward).
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_INVERSE_DYNAMICS_H
#define TANDEM_SHARED_ARTICULATIONS_INVERSE_DYNAMICS_H

#include "shared/articulations/loads.h"

/* What the numbers of WORK_PENDING say of a joint: an acceleration at frame b. */
SHARED spatial_motion joint_acceleration(const articulation *t, tree_link l, placed_joint j)
{
  spatial_force numbers = load_pending(t, l.k);
  return joint_motion(l, vector_of_numbers(l, j.frame, numbers.moment), numbers.force);
}

SHARED spatial_force numbers_of_force(tree_link l, placed_joint j, spatial_force at_b)
{
  spatial_force numbers = {numbers_of_vector(l, j.frame, choose3(l.is_slider, at_b.force, at_b.moment)), zero3()};
  return choose_force(l.is_free, at_b, numbers);
}

/* WORK_PENDING: accelerations, in the numbers of the joints' velocities, that become forces. The tree is placed with an
 * h of 0 and moved (kinematics.h). Outer forces and gravity help; drives are not counted. */
SHARED void find_joint_forces(const articulation *t, vec3 gravity)
{
  circling_link c = circling_ground();
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    circling_record moves;
    load_circling_record(t, l, &moves);
    circling_link parent = circling_parent(t, l, k, &c, (uint)WORK_CHANGE);
    c.velocity = moves.velocity;
    c.acceleration = link_acceleration(l, &moves, &parent, joint_acceleration(t, l, moves.joint));
    store_motion(l.exists, t, l.k, (uint)WORK_CHANGE, c.acceleration);
    spatial_force needs = subtract_forces(force_to_accelerate(&moves, c.acceleration), outer_force(t, l, gravity));
    store_force(l.exists, t, l.k, (uint)WORK_FORCE, needs);
  }
  for (uint n = t->most_links; n > 0u; --n) {
    tree_link l = tree_link_of(t, n - 1u);
    placed_joint j = load_placed_joint(t, l);
    spatial_force at_b = force_at(load_force(t, l.k, (uint)WORK_FORCE), negate(j.to_center));
    spatial_force armature = scaled_force(load_pending(t, l.k), choose(l.is_free, (real)R(0.0), j.implicit_inertia));
    store_force(l.exists, t, l.k, (uint)WORK_PENDING, add_forces(numbers_of_force(l, j, at_b), armature));
    add_to_force(l.exists & !l.is_root, t, l.parent, (uint)WORK_FORCE, force_at(at_b, negate(j.from_parent)));
  }
}

#endif
