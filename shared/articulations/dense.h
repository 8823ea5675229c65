/* dense.h - the mass matrix of a tree, and the Jacobian of a point, as matrices of all velocities of its joints.
 *
 * The mass matrix is found with composite rigid bodies: a column of it is what the joints must bear when one of them
 * accelerates all links outward of it as one body (Walker and Orin, "Efficient dynamic computer simulation of robotic
 * mechanisms", 1982). Programs ask for these matrices; the step never makes them, so they are of width 1.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_DENSE_H
#define TANDEM_SHARED_ARTICULATIONS_DENSE_H

#include "shared/articulations/factor.h"

SHARED uint freedoms_of(tree_link l) { return l.is_free ? 6u : l.is_ball ? 3u : has_one_freedom(l) ? 1u : 0u; }

SHARED vec3 unit_vector(uint k) { return make_vec3(int_to_real(k == 0u), int_to_real(k == 1u), int_to_real(k == 2u)); }

/* The motion of a unit velocity number of a joint, at frame b. */
SHARED spatial_motion freedom_motion(tree_link l, placed_joint j, uint number)
{
  vec3 linear = number < 3u ? zero3() : unit_vector(number - 3u);
  return joint_motion(l, vector_of_numbers(l, j.frame, unit_vector(number)), linear);
}

/* Leaves in WORK_INERTIA the inertia of each link with all links outward of it, as one body. */
SHARED void find_composite_inertias(const articulation *t)
{
  for (uint k = 0; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    store_symmetric6(l.exists, t, l.k, inertia_of_solid(load_solid_link(t, l)));
  }
  for (uint n = t->most_links; n > 0u; --n) {
    tree_link l = tree_link_of(t, n - 1u);
    placed_joint j = load_placed_joint(t, l);
    symmetric6 at_parent = symmetric6_at(load_symmetric6(t, l.k), negate(add(j.from_parent, j.to_center)));
    store_symmetric6(l.exists & !l.is_root, t, l.parent, add_symmetric6(load_symmetric6(t, l.parent), at_parent));
  }
}

/* What the joints between link k and the root bear of a force at frame b of link k; column: of the matrix. */
SHARED void bear_force(const articulation *t, GLOBAL const uint *first, uint size, uint k, spatial_force at_b,
                       uint column, GLOBAL memory_real *matrix)
{
  for (;;) {
    tree_link l = tree_link_of(t, k);
    placed_joint j = load_placed_joint(t, l);
    for (uint number = 0; number < freedoms_of(l); ++number) {
      uint row = first[k] + number;
      matrix[row * size + column] = matrix[column * size + row] = power_of(at_b, freedom_motion(l, j, number));
    }
    if (l.is_root) return;
    at_b = force_at(at_b, negate(j.from_parent));
    k = l.parent;
    at_b = force_at(at_b, negate(load_placed_joint(t, tree_link_of(t, k)).to_center));
  }
}

/* first: the number of each link's first velocity. matrix: size x size, zero before. The tree is placed with an h of 0
 * (kinematics.h), or the matrix has the implicit parts of drives. */
SHARED void find_mass_matrix(const articulation *t, GLOBAL const uint *first, uint size, GLOBAL memory_real *matrix)
{
  find_composite_inertias(t);
  for (uint k = 0; k < t->links; ++k) {
    tree_link l = tree_link_of(t, k);
    placed_joint j = load_placed_joint(t, l);
    symmetric6 at_b = symmetric6_at(load_symmetric6(t, k), negate(j.to_center));
    for (uint number = 0; number < freedoms_of(l); ++number) {
      uint column = first[k] + number;
      bear_force(t, first, size, k, inertia_times(&at_b, freedom_motion(l, j, number)), column, matrix);
    }
    for (uint number = 0; number < freedoms_of(l) && !l.is_free; ++number)
      matrix[(first[k] + number) * (size + 1u)] += j.implicit_inertia;
  }
}

/* The velocity of a point of link k, at `arm` from its centre, by unit velocities of the joints. matrix: 6 rows of
 * `size`, angular and linear, zero before. */
SHARED void find_jacobian(const articulation *t, GLOBAL const uint *first, uint size, uint k, vec3 arm,
                          GLOBAL memory_real *matrix)
{
  for (;;) {
    tree_link l = tree_link_of(t, k);
    placed_joint j = load_placed_joint(t, l);
    arm = add(arm, j.to_center);
    for (uint number = 0; number < freedoms_of(l); ++number) {
      spatial_motion m = motion_at(freedom_motion(l, j, number), arm);
      uint column = first[k] + number;
      matrix[column] = m.angular.x;
      matrix[size + column] = m.angular.y;
      matrix[2u * size + column] = m.angular.z;
      matrix[3u * size + column] = m.linear.x;
      matrix[4u * size + column] = m.linear.y;
      matrix[5u * size + column] = m.linear.z;
    }
    if (l.is_root) return;
    arm = add(arm, j.from_parent);
    k = l.parent;
  }
}

#endif
