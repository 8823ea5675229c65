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
SHARED spatial_force momentum_of_solid(const solid_link *s, spatial_motion velocity)
{
  spatial_force p = {moments_times(s, velocity.angular), scale(velocity.linear, s->mass)};
  return p;
}
SHARED spatial_force own_momentum_of_link(const articulation *t, tree_link l)
{
  solid_link s = load_solid_link(t, l);
  return momentum_of_solid(&s, load_motion(t, l.k, (uint)WORK_VELOCITY));
}
/* Of a free root; else 0. */
SHARED vec3 root_velocity(const articulation *t)
{
  return choose3(tree_link_of(t, 0u).is_free, xyz(load_root(t, (uint)ROOT_LINEAR_VELOCITY)), zero3());
}

/* Kinetic, J, as seen from a frame that moves so, with that of armatures. numbers: of the joint's velocity. */
SHARED real energy_of_link(const solid_link *s, spatial_motion m, vec3 numbers, real armature, vec3 frame)
{
  vec3 linear = subtract(m.linear, frame);
  return R(0.5) * (dot3(m.angular, moments_times(s, m.angular)) + s->mass * length_squared(linear) +
                   armature * length_squared(numbers));
}
SHARED real armature_of_link(const articulation *t, tree_link l)
{
  return choose(l.is_free, (real)R(0.0), load_link(t, l.k, (uint)LINK_FRAME_A).w);
}
SHARED real load_energy_of_link(const articulation *t, tree_link l, spatial_motion velocity, vec3 frame)
{
  solid_link s = load_solid_link(t, l);
  return choose(l.exists, energy_of_link(&s, velocity, load_joint_velocity(t, l), armature_of_link(t, l), frame),
                (real)R(0.0));
}
SHARED real energy_of_tree(const articulation *t, vec3 frame)
{
  real sum = R(0.0);
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    sum = sum + load_energy_of_link(t, l, load_motion(t, l.k, (uint)WORK_VELOCITY), frame);
  }
  return sum;
}

/* The tree as one body, about the centre of its root. */
typedef struct {
  symmetric6 inertia;
  spatial_force momentum;
} whole_tree;

SHARED whole_tree with_link(whole_tree sum, tree_link l, const solid_link *solid, vec3 offset, spatial_motion velocity)
{
  symmetric6 s = symmetric6_at(inertia_of_solid(*solid), negate(offset));
  spatial_force p = force_at(momentum_of_solid(solid, velocity), negate(offset));
  whole_tree whole = {choose_symmetric6(l.exists, add_symmetric6(sum.inertia, s), sum.inertia),
                      choose_force(l.exists, add_forces(sum.momentum, p), sum.momentum)};
  return whole;
}

/* The mass of a tree, and the sum of the centres of its links times their masses. */
typedef struct {
  real mass;
  vec3 moment;
} mass_moment;

SHARED mass_moment with_mass_of_link(mass_moment sum, tree_link l, real mass, vec3 offset)
{
  real own = choose(l.exists, mass, (real)R(0.0));
  mass_moment next = {sum.mass + own, add_scaled(sum.moment, offset, own)};
  return next;
}

/* What free motion keeps. drift: the velocity of the centre of mass of a free tree, from which the energy is seen, so
 * that none of it is lost in that of a tree which is carried along; J. momentum: about the centre of the root. */
typedef struct {
  spatial_force momentum;
  vec3 drift, center; /* center: of mass, from that of the root */
  real energy, inverse_mass;
} conserved;

/* Without the energy. */
SHARED conserved momentum_of_tree(const articulation *t)
{
  conserved c;
  mass_moment sum = {R(0.0), zero3()};
  c.momentum = no_force();
  c.energy = R(0.0);
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    solid_link solid = load_solid_link(t, l);
    vec3 offset = xyz(load_work(t, l.k, (uint)WORK_OFFSET));
    spatial_force own = momentum_of_solid(&solid, load_motion(t, l.k, (uint)WORK_VELOCITY));
    c.momentum = choose_force(l.exists, add_forces(c.momentum, force_at(own, negate(offset))), c.momentum);
    sum = with_mass_of_link(sum, l, solid.mass, offset);
  }
  c.inverse_mass = inverse_if_positive(sum.mass);
  vec3 drift = scale(c.momentum.force, c.inverse_mass);
  c.drift = choose3(tree_link_of(t, 0u).is_free, drift, zero3());
  c.center = scale(sum.moment, c.inverse_mass);
  return c;
}

/* share: of the energy before. */
SHARED mask has_changed_energy(const articulation *t, conserved before, real energy, real share)
{
  real change = magnitude(energy - before.energy);
  return (!(change <= share * before.energy)) & has_links(t);
}

SHARED void set_root_motion_if(mask wanted, const articulation *t, spatial_motion m)
{
  store_state(wanted, t, 0u, (uint)STATE_JOINT_VELOCITY, extend(m.angular, R(0.0)));
  store_root(wanted, t, (uint)ROOT_LINEAR_VELOCITY, extend(m.linear, R(0.0)));
}

/* Adds a motion of the tree as one body, given at the centre of the root, which is free. The velocity after that. */
SHARED spatial_motion carry_link_if(mask wanted, const articulation *t, tree_link l, spatial_motion whole)
{
  spatial_motion m = load_motion(t, l.k, (uint)WORK_VELOCITY);
  if (!any_of(wanted)) return m;
  spatial_motion carried = add_motions(m, motion_at(whole, xyz(load_work(t, l.k, (uint)WORK_OFFSET))));
  store_motion(wanted & l.exists, t, l.k, (uint)WORK_VELOCITY, carried);
  return choose_motion(wanted, carried, m);
}
/* The energy after that, of all trees. */
SHARED real carry_tree_if(mask wanted, const articulation *t, spatial_motion whole, vec3 frame)
{
  real energy = R(0.0);
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    energy = energy + load_energy_of_link(t, l, carry_link_if(wanted, t, l, whole), frame);
  }
  set_root_motion_if(wanted, t, load_motion(t, 0u, (uint)WORK_VELOCITY));
  return energy;
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

/* energy: now. drifts: the motion of the tree as it drifts. turns: what the tree as one body does besides. Where the
 * latter alone has more energy than there was, in a shape that the tree cannot have reached, the momentum gives way. */
SHARED void hold_energy_if(mask wanted, const articulation *t, conserved kept, real energy, spatial_motion drifts,
                           spatial_motion turns, real of_turns)
{
  real within = energy - of_turns;
  mask scales = wanted & (within > LEAST_ENERGY_WITHIN * of_turns);
  scale_links_if(scales, t, add_motions(drifts, turns), factor_of_energies(within, kept.energy - of_turns));
  real now = energy_of_tree(t, kept.drift);
  mask exceeds = wanted & (now > (R(1.0) + ENERGY_ROUNDING) * kept.energy);
  if (any_of(exceeds)) scale_links_if(exceeds, t, drifts, factor_of_energies(now, kept.energy));
}

/* A substep that changes so little of the energy has the errors of a symmetric rule, which hardly add up. */
#define LARGEST_CHANGE_IN_SUBSTEP R(2e-5)

/* kept: before the motion, the momentum about where the centre of the root is now. whole: of free trees, now. */
SHARED void conserve(const articulation *t, conserved kept, whole_tree whole)
{
  mask free = tree_link_of(t, 0u).is_free & has_links(t);
  spatial_motion drifts = no_motion(), turns = no_motion(), missed = no_motion();
  real of_turns = R(0.0);
  if (any_of(free)) {
    symmetric6 inverse = inverse_of_inertia(whole.inertia);
    missed = inverse_times(&inverse, subtract_forces(kept.momentum, whole.momentum));
    drifts.linear = kept.drift;
    spatial_force rest = subtract_forces(kept.momentum, inertia_times(&whole.inertia, drifts));
    turns = choose_motion(free, inverse_times(&inverse, rest), no_motion());
    of_turns = choose(free, R(0.5) * power_of(rest, turns), of_turns);
  }
  real energy = carry_tree_if(free, t, missed, kept.drift);
  mask changed = has_changed_energy(t, kept, energy, LARGEST_CHANGE_IN_SUBSTEP);
  if (any_of(changed)) hold_energy_if(changed, t, kept, energy, drifts, turns, of_turns);
}

#endif
