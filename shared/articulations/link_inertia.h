/* link_inertia.h - the inverse inertia of every link within the tree: the velocity that it gets from an impulse on
 * itself, all joints and links taking part.
 *
 * The effective mass of a contact or joint at a link is one product with it. Outward, with P the map by which a link
 * follows its parent (respond.h) and W the inverse inertia of the parent,
 *
 *     W of the link = P W P^T + (what the joint gives by itself)
 *
 * (Kreutz-Delgado, Jain and Rodriguez, "Recursive formulation of operational space control", 1992). All of it in
 * frame b, where few blocks change.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_LINK_INERTIA_H
#define TANDEM_SHARED_ARTICULATIONS_LINK_INERTIA_H

#include "shared/articulations/respond.h"

/* response: of the joint. */
SHARED symmetric6 followed_by_single(tree_link l, const factored_joint *joint, symmetric6 w, real *response)
{
  single_factor f = joint->single;
  spatial_motion z = inverse_times(&w, f.u);
  z.angular = scale(z.angular, f.inverse);
  z.linear = scale(z.linear, f.inverse);
  f.response = f.inverse + power_of(f.u, z) * f.inverse;
  *response = f.response;
  spatial_motion s = axis_motion(l, joint->joint);
  w.second = add_products(add_products(w.second, s.angular, z.angular, R(-2.0)), s.angular, s.angular, f.response);
  w.first = add_products(add_products(w.first, s.linear, z.linear, R(-2.0)), s.linear, s.linear, f.response);
  w.coupling = add_product(add_product(w.coupling, z.linear, s.angular, R(-1.0)), s.linear, z.angular, R(-1.0));
  return w;
}

SHARED mat3 symmetric_as_matrix(symmetric3 s)
{
  mat3 m = {row_x(s), row_y(s), row_z(s)};
  return m;
}
/* a b, and a b + factor c d */
SHARED mat3 matrix_product(mat3 a, mat3 b)
{
  mat3 m = {rotate_back(b, a.x), rotate_back(b, a.y), rotate_back(b, a.z)};
  return m;
}
SHARED mat3 subtract_matrices(mat3 a, mat3 b)
{
  mat3 m = {subtract(a.x, b.x), subtract(a.y, b.y), subtract(a.z, b.z)};
  return m;
}

/* The turn of the link is  E w - G v + what the joint gives;  E = e D^-1. */
SHARED symmetric6 followed_by_ball(const articulation *t, tree_link l, const factored_joint *joint, symmetric6 w)
{
  ball_factor f = load_ball_factor(t, l);
  mat3 e = symmetric_as_matrix(scaled_symmetric(f.inverse, joint->joint.implicit_inertia));
  mat3 by_moment = subtract_matrices(times_symmetric(e, w.second), matrix_product(f.g, w.coupling));
  mat3 by_force = subtract_matrices(matrix_product(e, transposed(w.coupling)), times_symmetric(f.g, w.first));
  symmetric6 r;
  r.first = w.first;
  r.coupling = transposed(by_force);
  r.second = add_symmetric_product(f.inverse, by_moment, e, R(1.0));
  r.second = add_symmetric_product(r.second, by_force, f.g, R(-1.0));
  return r;
}

/* The inverse inertia of the parent of link k. before: that of link k - 1. */
SHARED symmetric6 inverse_inertia_of_parent(const articulation *t, tree_link l, uint k, const symmetric6 *before)
{
  mask follows = follows_at_once(l, k);
  if (!any_of(!follows)) return *before;
  symmetric6 loaded = choose_symmetric6(l.is_root, zero_symmetric6(), load_symmetric6(t, l.parent));
  return choose_symmetric6(follows, *before, loaded);
}

/* Leaves in WORK_INERTIA the inverse inertia at the centre of link k, which that of a free root is already. */
SHARED symmetric6 invert_link_inertia(const articulation *t, tree_link l, const factored_joint *f, uint k,
                                      const symmetric6 *before)
{
  mask one = has_one_freedom(l);
  real response = R(0.0);
  symmetric6 w = symmetric6_at(inverse_inertia_of_parent(t, l, k, before), f->joint.from_parent);
  if (any_of(one)) w = choose_symmetric6(one, followed_by_single(l, f, w, &response), w);
  if (any_of(l.is_ball)) w = choose_symmetric6(l.is_ball, followed_by_ball(t, l, f, w), w);
  w = symmetric6_at(w, f->joint.to_center);
  if (any_of(l.is_free)) w = choose_symmetric6(l.is_free, load_symmetric6(t, l.k), w);
  store_work(l.exists & one, t, l.k, (uint)WORK_FACTOR + 1u, extend(f->single.u.force, response));
  store_symmetric6(l.exists & !l.is_free, t, l.k, w);
  return w;
}

SHARED void load_joint_to_invert(const articulation *t, tree_link l, factored_joint *f)
{
  *f = load_factored_joint(t, l);
}
/* Nothing is pending then. */
CALLED void invert_link_inertias(const articulation *tree)
{
  articulation own = *tree;
  const articulation *t = &own;
  symmetric6 w = zero_symmetric6();
  BEGIN_WALK(factored_joint, load_joint_to_invert, t, 0u);
  for (uint k = 0; k < t->most_links; ++k) {
    WALK_TO(factored_joint, load_joint_to_invert, t, k, k + 1u);
    w = invert_link_inertia(t, l, &now, k, &w);
    store_force(l.exists, t, l.k, (uint)WORK_PENDING, no_force());
  }
}

#endif
