/* conserved.h - momentum and energy of a tree, which free motion keeps (free_motion.h).
 *
 * What the momentum of a free tree lacks becomes a motion of the tree as one body: on the root alone it would be
 * without bounds where the root is light. What the energy lacks becomes a factor on the motion besides that of the tree
 * as one body, which has no momentum.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_CONSERVED_H
#define TANDEM_SHARED_ARTICULATIONS_CONSERVED_H

#include "shared/articulations/loads.h"

/* The momentum of a link, about its centre. */
SHARED spatial_force own_momentum_of_link(const articulation *t, tree_link l)
{
  spatial_motion m = load_motion(t, l.k, (uint)WORK_VELOCITY);
  spatial_force p = {moments_times(t, l, m.angular), scale(m.linear, mass_of_link(t, l))};
  return p;
}
/* About the point at -arm from its centre. */
SHARED spatial_force momentum_of_link(const articulation *t, tree_link l, vec3 arm)
{
  return force_at(own_momentum_of_link(t, l), negate(arm));
}
/* About the centre of a free root. */
SHARED spatial_force with_momentum_of_link(spatial_force sum, const articulation *t, tree_link l)
{
  spatial_force p = momentum_of_link(t, l, xyz(load_work(t, l.k, (uint)WORK_OFFSET)));
  return choose_force(l.exists, add_forces(sum, p), sum);
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
typedef struct {
  symmetric6 inertia;
  spatial_force momentum;
} whole_tree;

SHARED whole_tree tree_as_one_body(const articulation *t)
{
  whole_tree whole = {zero_symmetric6(), no_force()};
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    symmetric6 s = symmetric6_at(inertia_of_link(t, l), negate(xyz(load_work(t, l.k, (uint)WORK_OFFSET))));
    whole.inertia = choose_symmetric6(l.exists, add_symmetric6(whole.inertia, s), whole.inertia);
    whole.momentum = with_momentum_of_link(whole.momentum, t, l);
  }
  return whole;
}

/* The mass of a tree, and the sum of the centres of its links times their masses. */
typedef struct {
  real mass;
  vec3 moment;
} mass_moment;

SHARED mass_moment with_mass_of_link(mass_moment sum, const articulation *t, tree_link l)
{
  real own = choose(l.exists, mass_of_link(t, l), (real)R(0.0));
  mass_moment next = {sum.mass + own, add_scaled(sum.moment, xyz(load_work(t, l.k, (uint)WORK_OFFSET)), own)};
  return next;
}

/* The centre of mass, from that of the root. */
SHARED vec3 center_of_tree(const articulation *t, real inverse_mass)
{
  mass_moment sum = {R(0.0), zero3()};
  for (uint k = 0; k < t->most_links; ++k) sum = with_mass_of_link(sum, t, tree_link_of(t, k));
  return scale(sum.moment, inverse_mass);
}

/* What free motion keeps. drift: the velocity of the centre of mass of a free tree, from which the energy is seen, so
 * that none of it is lost in that of a tree which is carried along; J. momentum: about the centre of the root. */
typedef struct {
  spatial_force momentum;
  vec3 drift, center; /* center: of mass, from that of the root */
  real energy, inverse_mass;
} conserved;

SHARED conserved conserved_of_tree(const articulation *t)
{
  conserved c;
  mass_moment sum = {R(0.0), zero3()};
  c.momentum = no_force();
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    c.momentum = with_momentum_of_link(c.momentum, t, l);
    sum = with_mass_of_link(sum, t, l);
  }
  c.inverse_mass = inverse_if_positive(sum.mass);
  vec3 drift = scale(c.momentum.force, c.inverse_mass);
  c.drift = choose3(tree_link_of(t, 0u).is_free, drift, zero3());
  c.center = scale(sum.moment, c.inverse_mass);
  c.energy = energy_of_tree(t, c.drift);
  return c;
}

/* share: of the energy before. */
SHARED mask has_changed_energy(const articulation *t, conserved before, real share)
{
  real change = magnitude(energy_of_tree(t, before.drift) - before.energy);
  return (!(change <= share * before.energy)) & has_links(t);
}

SHARED void set_root_motion_if(mask wanted, const articulation *t, spatial_motion m)
{
  store_state(wanted, t, 0u, (uint)STATE_JOINT_VELOCITY, extend(m.angular, R(0.0)));
  store_root(wanted, t, (uint)ROOT_LINEAR_VELOCITY, extend(m.linear, R(0.0)));
}

/* Adds a motion of the tree as one body, given at the centre of the root, which is free. */
SHARED void carry_tree_if(mask wanted, const articulation *t, spatial_motion whole)
{
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    spatial_motion m = load_motion(t, l.k, (uint)WORK_VELOCITY);
    m = add_motions(m, motion_at(whole, xyz(load_work(t, l.k, (uint)WORK_OFFSET))));
    store_motion(wanted & l.exists, t, l.k, (uint)WORK_VELOCITY, m);
  }
  set_root_motion_if(wanted, t, load_motion(t, 0u, (uint)WORK_VELOCITY));
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
  store_state(wanted & !l.is_free, t, l.k, (uint)STATE_JOINT_VELOCITY, extend(numbers, R(0.0)));
}

/* What of the energy is in motion within the tree, below this share is nothing but rounding. */
#define LEAST_ENERGY_WITHIN R(1e-4)
#define ENERGY_ROUNDING R(1e-6)

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
  mask free = wanted & tree_link_of(t, 0u).is_free;
  set_root_motion_if(free, t, load_motion(t, 0u, (uint)WORK_VELOCITY));
}

/* drifts: the motion of the tree as it drifts. turns: what the tree as one body does besides. Where the latter alone
 * has more energy than there was, in a shape that the tree cannot have reached, the momentum gives way. */
SHARED void hold_energy_if(mask wanted, const articulation *t, conserved kept, spatial_motion drifts,
                           spatial_motion turns, real of_turns)
{
  real within = energy_of_tree(t, kept.drift) - of_turns;
  mask scales = wanted & (within > LEAST_ENERGY_WITHIN * of_turns);
  scale_links_if(scales, t, add_motions(drifts, turns), factor_of_energies(within, kept.energy - of_turns));
  real now = energy_of_tree(t, kept.drift);
  mask exceeds = wanted & (now > (R(1.0) + ENERGY_ROUNDING) * kept.energy);
  if (any_of(exceeds)) scale_links_if(exceeds, t, drifts, factor_of_energies(now, kept.energy));
}

/* A substep that changes so little of the energy has the errors of a symmetric rule, which hardly add up. */
#define LARGEST_CHANGE_IN_SUBSTEP R(2e-5)

/* kept: before the motion, the momentum about where the centre of the root is now. */
SHARED void conserve(const articulation *t, conserved kept)
{
  mask free = tree_link_of(t, 0u).is_free & has_links(t);
  spatial_motion drifts = no_motion(), turns = no_motion();
  real of_turns = R(0.0);
  if (any_of(free)) {
    whole_tree whole = tree_as_one_body(t);
    symmetric6 inverse = inverse_of_inertia(whole.inertia);
    carry_tree_if(free, t, inverse_times(&inverse, subtract_forces(kept.momentum, whole.momentum)));
    drifts.linear = kept.drift;
    spatial_force rest = subtract_forces(kept.momentum, inertia_times(&whole.inertia, drifts));
    turns = choose_motion(free, inverse_times(&inverse, rest), no_motion());
    of_turns = choose(free, R(0.5) * power_of(rest, turns), of_turns);
  }
  mask changed = has_changed_energy(t, kept, LARGEST_CHANGE_IN_SUBSTEP);
  if (any_of(changed)) hold_energy_if(changed, t, kept, drifts, turns, of_turns);
}

#endif
