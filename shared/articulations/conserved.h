/* conserved.h - momentum and energy of a tree, which free motion keeps (free_motion.h). */
#ifndef TANDEM_SHARED_ARTICULATIONS_CONSERVED_H
#define TANDEM_SHARED_ARTICULATIONS_CONSERVED_H

#include "shared/articulations/loads.h"

/* The momentum of a link, about the point at -arm from its centre. */
SHARED spatial_force momentum_of_link(const articulation *t, tree_link l, vec3 arm)
{
  spatial_motion m = load_motion(t, l.k, (uint)WORK_VELOCITY);
  spatial_force p = {moments_times(t, l, m.angular), scale(m.linear, mass_of_link(t, l))};
  return force_at(p, negate(arm));
}
/* The momentum of the tree, and the sum of WORK_FORCE, about the centre of a free root. */
SHARED spatial_force momentum_of_tree(const articulation *t)
{
  spatial_force sum = no_force();
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    spatial_force p = momentum_of_link(t, l, xyz(load_work(t, l.k, (uint)WORK_OFFSET)));
    sum = choose_force(l.exists, add_forces(sum, p), sum);
  }
  return sum;
}
SHARED spatial_force sum_of_forces(const articulation *t)
{
  spatial_force sum = no_force();
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    spatial_force f = force_at(load_force(t, l.k, (uint)WORK_FORCE), negate(xyz(load_work(t, l.k, (uint)WORK_OFFSET))));
    sum = choose_force(l.exists, add_forces(sum, f), sum);
  }
  return sum;
}

/* Of a free root; else 0. */
SHARED vec3 root_velocity(const articulation *t)
{
  return choose3(tree_link_of(t, 0u).is_free, xyz(load_root(t, (uint)ROOT_LINEAR_VELOCITY)), zero3());
}

/* Kinetic, J, as seen from a frame that moves so, with that of armatures. */
SHARED real energy_of_link(const articulation *t, tree_link l, vec3 frame)
{
  spatial_motion m = load_motion(t, l.k, (uint)WORK_VELOCITY);
  vec3 linear = subtract(m.linear, frame), numbers = xyz(load_state(t, l.k, (uint)STATE_JOINT_VELOCITY));
  real armature = choose(l.is_free, (real)R(0.0), load_link(t, l.k, (uint)LINK_FRAME_A).w);
  return R(0.5) * (dot3(m.angular, moments_times(t, l, m.angular)) + mass_of_link(t, l) * length_squared(linear) +
                   armature * length_squared(numbers));
}
SHARED real energy_of_tree(const articulation *t, vec3 frame)
{
  real sum = R(0.0);
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    sum = sum + choose(l.exists, energy_of_link(t, l, frame), (real)R(0.0));
  }
  return sum;
}

/* The tree as one body, about the centre of its root. */
SHARED symmetric6 inertia_of_tree(const articulation *t)
{
  symmetric6 sum = zero_symmetric6();
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    symmetric6 s = symmetric6_at(inertia_of_link(t, l), negate(xyz(load_work(t, l.k, (uint)WORK_OFFSET))));
    sum = choose_symmetric6(l.exists, add_symmetric6(sum, s), sum);
  }
  return sum;
}

/* The motion that a free tree of this momentum has while its joints stand still; a tree that is held has none. */
SHARED spatial_motion motion_as_one_body(const articulation *t, spatial_force momentum)
{
  symmetric6 inverse = inverse_of_inertia(inertia_of_tree(t));
  return choose_motion(tree_link_of(t, 0u).is_free, inverse_times(&inverse, momentum), no_motion());
}

/* m, of which the part beyond `whole` is scaled. */
SHARED spatial_motion scaled_beyond(spatial_motion m, spatial_motion whole, real factor)
{
  spatial_motion r = {add_scaled(whole.angular, subtract(m.angular, whole.angular), factor),
                      add_scaled(whole.linear, subtract(m.linear, whole.linear), factor)};
  return r;
}

SHARED void scale_link_if(mask wanted, const articulation *t, tree_link l, spatial_motion whole, real factor)
{
  spatial_motion m = load_motion(t, l.k, (uint)WORK_VELOCITY);
  m = scaled_beyond(m, motion_at(whole, xyz(load_work(t, l.k, (uint)WORK_OFFSET))), factor);
  store_motion(wanted, t, l.k, (uint)WORK_VELOCITY, m);
  vec3 numbers = scale(xyz(load_state(t, l.k, (uint)STATE_JOINT_VELOCITY)), factor);
  store_state(wanted, t, l.k, (uint)STATE_JOINT_VELOCITY, extend(choose3(l.is_free, m.angular, numbers), R(0.0)));
  store_root(wanted & l.is_free, t, (uint)ROOT_LINEAR_VELOCITY, extend(m.linear, R(0.0)));
}

/* What of the energy is in motion within the tree, below this share is nothing but rounding. */
#define LEAST_ENERGY_WITHIN R(1e-4)

/* The factor of velocities that takes an energy to another; a gain is limited, because little energy has no direction
 * that is worth much. */
#define LARGEST_GAIN R(2.0)
SHARED real factor_of_energies(real now, real wanted)
{
  mask moves = now > R(0.0);
  real share = maximum(wanted, R(0.0)) / choose(moves, now, (real)R(1.0));
  return square_root(choose(moves, minimum(share, LARGEST_GAIN), (real)R(1.0)));
}

SHARED void scale_links_if(mask wanted, const articulation *t, spatial_motion whole, real factor)
{
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    scale_link_if(wanted & l.exists, t, l, whole, factor);
  }
}

/* Scales the motion within the tree, which has no momentum, so that the energy is what it was. Where the momentum alone
 * has more energy than there was, in a shape that the tree cannot have reached, the momentum gives way. */
SHARED void hold_energy_if(mask wanted, const articulation *t, spatial_force momentum, real energy)
{
  spatial_motion whole = motion_as_one_body(t, momentum);
  real of_whole = choose(tree_link_of(t, 0u).is_free, R(0.5) * power_of(momentum, whole), (real)R(0.0));
  real within = energy_of_tree(t, zero3()) - of_whole;
  mask scales = wanted & (within > LEAST_ENERGY_WITHIN * of_whole);
  scale_links_if(scales, t, whole, factor_of_energies(within, energy - of_whole));
  real now = energy_of_tree(t, zero3());
  mask exceeds = wanted & (now > (R(1.0) + LEAST_ENERGY_WITHIN) * energy);
  if (any_of(exceeds)) scale_links_if(exceeds, t, no_motion(), factor_of_energies(now, energy));
}

#endif
