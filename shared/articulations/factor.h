/* factor.h - the articulated inertia of every link, once a substep (Featherstone, "The calculation of robot dynamics
 * using articulated-body inertias", 1983).
 *
 * The articulated inertia of a link is what the link seems to weigh to a force on it while its joint towards the root
 * is cut and those of its children are free to move. Inward, each link hands its parent the inertia that its joint
 * lets through. In frame b of a joint with axis s and inertia I:
 *
 *     u = I s,   d = s . u + implicit inertia,   through the joint: I - u u^T / d
 *
 * What is kept are u and 1 / d. For a ball, frame b makes this short. With A, B, C the blocks of I, and e the implicit
 * inertia, which is the same about all axes,
 *
 *     D = A + e,  G = D^-1 B,     through the joint:  e - e e D^-1,   e G,   C - B^T G
 *
 * are free of differences of large numbers. What is kept are D^-1 and G.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_FACTOR_H
#define TANDEM_SHARED_ARTICULATIONS_FACTOR_H

#include "shared/articulations/kinematics.h"

/* Of a joint with one degree of freedom: u, 1 / d, and what link_inertia.h adds: how much velocity a unit impulse of
 * the joint gives it. */
typedef struct {
  spatial_force u;
  real inverse, response;
} single_factor;

typedef struct {
  symmetric3 inverse; /* D^-1 */
  mat3 g;
} ball_factor;

SHARED single_factor load_single_factor(const articulation *t, tree_link l)
{
  vec4 first = load_work(t, l.k, (uint)WORK_FACTOR), second = load_work(t, l.k, (uint)WORK_FACTOR + 1u);
  single_factor f = {{xyz(first), xyz(second)}, first.w, second.w};
  return f;
}
SHARED void store_single_factor(mask m, const articulation *t, tree_link l, single_factor f)
{
  store_work(m, t, l.k, (uint)WORK_FACTOR, extend(f.u.moment, f.inverse));
  store_work(m, t, l.k, (uint)WORK_FACTOR + 1u, extend(f.u.force, f.response));
}
SHARED ball_factor load_ball_factor(const articulation *t, tree_link l)
{
  vec4 a = load_work(t, l.k, (uint)WORK_FACTOR), b = load_work(t, l.k, (uint)WORK_FACTOR + 1u),
       c = load_work(t, l.k, (uint)WORK_FACTOR + 2u), d = load_work(t, l.k, (uint)WORK_FACTOR + 3u);
  ball_factor f = {{a.x, a.y, a.z, a.w, b.x, b.y},
                   {make_vec3(b.z, b.w, c.x), make_vec3(c.y, c.z, c.w), make_vec3(d.x, d.y, d.z)}};
  return f;
}
SHARED void store_ball_factor(mask m, const articulation *t, tree_link l, ball_factor f)
{
  symmetric3 s = f.inverse;
  store_work(m, t, l.k, (uint)WORK_FACTOR, make_vec4(s.xx, s.yy, s.zz, s.xy));
  store_work(m, t, l.k, (uint)WORK_FACTOR + 1u, make_vec4(s.xz, s.yz, f.g.x.x, f.g.x.y));
  store_work(m, t, l.k, (uint)WORK_FACTOR + 2u, make_vec4(f.g.x.z, f.g.y.x, f.g.y.y, f.g.y.z));
  store_work(m, t, l.k, (uint)WORK_FACTOR + 3u, extend(f.g.z, R(0.0)));
}

SHARED spatial_motion axis_motion(tree_link l, placed_joint j) { return joint_motion(l, xyz(j.frame), zero3()); }

/* A link by itself: its axes, its moments about them, its mass. */
typedef struct {
  mat3 axes;
  vec3 moments;
  real mass;
} solid_link;

SHARED solid_link load_solid_link(const articulation *t, tree_link l)
{
  solid_link s = {rotation_of(quat_from(load_work(t, l.k, (uint)WORK_ORIENTATION))),
                  xyz(load_link(t, l.k, (uint)LINK_MOMENTS)), load_link(t, l.k, (uint)LINK_FRAME_B).w};
  return s;
}

SHARED symmetric6 inertia_of_solid(solid_link solid)
{
  symmetric6 s = zero_symmetric6();
  s.first = rotate_diagonal(solid.axes, solid.moments);
  s.second.xx = s.second.yy = s.second.zz = solid.mass;
  return s;
}
/* Its inertia times a vector of the world. */
SHARED vec3 moments_times(const solid_link *s, vec3 v)
{
  return rotate(s->axes, multiply(s->moments, rotate_back(s->axes, v)));
}

SHARED symmetric6 through_single(const articulation *t, tree_link l, placed_joint j, symmetric6 s)
{
  spatial_motion axis = axis_motion(l, j);
  single_factor f;
  f.u = inertia_times(&s, axis);
  f.inverse = inverse_if_positive(power_of(f.u, axis) + j.implicit_inertia);
  f.response = R(0.0);
  store_single_factor(l.exists & has_one_freedom(l), t, l, f);
  s.first = add_products(s.first, f.u.moment, f.u.moment, -f.inverse);
  s.second = add_products(s.second, f.u.force, f.u.force, -f.inverse);
  s.coupling = add_product(s.coupling, f.u.moment, f.u.force, -f.inverse);
  return s;
}

SHARED symmetric3 scaled_symmetric(symmetric3 s, real k)
{
  symmetric3 r = {k * s.xx, k * s.yy, k * s.zz, k * s.xy, k * s.xz, k * s.yz};
  return r;
}
SHARED symmetric3 add_to_diagonal(symmetric3 s, real x)
{
  s.xx = s.xx + x;
  s.yy = s.yy + x;
  s.zz = s.zz + x;
  return s;
}
SHARED mat3 transposed(mat3 m)
{
  mat3 r = {axis_x(m), axis_y(m), axis_z(m)};
  return r;
}

SHARED symmetric6 through_ball(const articulation *t, tree_link l, placed_joint j, symmetric6 s)
{
  real e = j.implicit_inertia;
  ball_factor f;
  f.inverse = inverse_of_symmetric(add_to_diagonal(s.first, e));
  mat3 columns = transposed(s.coupling);
  f.g = transposed(times_symmetric(columns, f.inverse));
  store_ball_factor(l.exists & l.is_ball, t, l, f);
  symmetric6 r;
  r.first = add_to_diagonal(scaled_symmetric(f.inverse, -(e * e)), e);
  r.second = add_symmetric_product(s.second, columns, transposed(f.g), R(-1.0));
  r.coupling.x = scale(f.g.x, e);
  r.coupling.y = scale(f.g.y, e);
  r.coupling.z = scale(f.g.z, e);
  return r;
}

/* What the parent feels of the inertia s of a link, at the parent's centre. */
SHARED symmetric6 inertia_through_joint(const articulation *t, tree_link l, placed_joint j, symmetric6 s)
{
  symmetric6 at_b = symmetric6_at(s, negate(j.to_center)), through = at_b;
  mask one = has_one_freedom(l);
  if (any_of(one)) through = choose_symmetric6(one, through_single(t, l, j, at_b), through);
  if (any_of(l.is_ball)) through = choose_symmetric6(l.is_ball, through_ball(t, l, j, at_b), through);
  return symmetric6_at(through, negate(j.from_parent));
}

/* What a walk that factors a tree reads of a link. */
typedef struct {
  placed_joint joint;
  symmetric6 inertia;
} weighed_link;

SHARED void load_weighed_link(const articulation *t, tree_link l, weighed_link *w)
{
  w->joint = load_placed_joint(t, l);
  w->inertia = load_symmetric6(t, l.k);
}

/* From the inertias of single links in WORK_INERTIA to the factors of all joints; the inertia of a free root is
 * inverted. Of the other links, WORK_INERTIA has no articulated inertia. */
CALLED void factor_tree(const articulation *tree)
{
  articulation own = *tree;
  const articulation *t = &own;
  symmetric6 s = zero_symmetric6(), through = s;
  mask follows = has_links(t) & !has_links(t); /* link k + 1 */
  BEGIN_WALK(weighed_link, load_weighed_link, t, t->most_links - 1u);
  for (uint n = t->most_links; n > 0u; --n) {
    WALK_TO(weighed_link, load_weighed_link, t, n - 1u, n - 2u);
    s = choose_symmetric6(follows, add_symmetric6(now.inertia, through), now.inertia);
    through = inertia_through_joint(t, l, now.joint, s);
    mask inner = l.exists & !l.is_root;
    follows = inner & follows_at_once(l, n - 1u);
    mask apart = inner & !follows;
    if (any_of(apart)) store_symmetric6(apart, t, l.parent, add_symmetric6(load_symmetric6(t, l.parent), through));
  }
  tree_link root = tree_link_of(t, 0u);
  mask free = root.exists & root.is_free;
  if (any_of(free)) store_symmetric6(free, t, root.k, inverse_of_inertia(s));
}

#endif
