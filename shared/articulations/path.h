/* path.h - what the joints between the root and a link do to it, in one table, so that contacts need no walks.
 *
 *       0 free                  A row of a link is the motion that it gets while one freedom of its path to the root
 *      / \                      moves by one unit, and no other is pushed.
 *     1   3 hinge
 *  ball    \                    rows of link 1   | 6 of the root | 3 of ball 1   |
 *     |     4 hinge             rows of link 2   | 6 of the root | 3 of ball 1   | 1 of hinge 2 |
 *     2                         rows of link 4   | 6 of the root | 1 of hinge 3  | 1 of hinge 4 |
 *   hinge
 *
 * The units are those in which the mass matrix is the identity. So with J the rows of a link,
 *
 *     its change of velocity = J^T z,  an impulse f on it changes z by J f,  its inverse inertia in the tree is J^T J
 *
 * where z is a number for each freedom of the tree. M^-1 = L^-T D^-1 L^-1, and J is that of the link times L^-T D^-1/2
 * (Featherstone, "Rigid Body Dynamics Algorithms", 2008, section 6.5). Rows follow from those of the parent once the
 * tree is factored.
 *
 * A tree of more than TREE_FREEDOMS freedoms has no table; its contacts walk (respond.h).
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_PATH_H
#define TANDEM_SHARED_ARTICULATIONS_PATH_H

#include "shared/articulations/respond.h"

SHARED shape_uint load_path_word(const articulation *t, shape_uint k, uint word)
{
  return load_of_shape(t->freedom, tree_row(t, (uint)PATH_WORDS, k, word));
}

SHARED row_number path_row(const articulation *t, shape_uint k, shape_uint entry)
{
  return row_in(&t->place, t->path_block, PATH_ENTRY_ROWS, k, t->path_entries * PATH_ENTRY_ROWS,
                entry * PATH_ENTRY_ROWS);
}

SHARED spatial_motion load_path_motion_if(mask wanted, const articulation *t, shape_uint k, shape_uint entry)
{
  row_number row = path_row(t, k, entry), next = row_beyond(&t->place, row);
  spatial_motion m = {xyz(load_row(t->path, wanted_row(wanted, row))),
                      xyz(load_row(t->path, wanted_row(wanted, next)))};
  return m;
}
SHARED void store_path_motion_if(mask wanted, const articulation *t, shape_uint k, shape_uint entry, spatial_motion m)
{
  row_number row = path_row(t, k, entry);
  store_row_if(wanted, t->path, row, extend(m.angular, R(0.0)));
  store_row_if(wanted, t->path, row_beyond(&t->place, row), extend(m.linear, R(0.0)));
}

/* The root of a positive number; 0 of others. */
SHARED real root_if_positive(real x)
{
  mask positive = x > R(0.0);
  return zero_if(!positive, square_root(choose(positive, x, (real)R(1.0))));
}

/* --- triangles ------------------------------------------------------------------------------------------------ */
/* The columns of a lower triangle with s = triangle triangle^T (Cholesky). */
typedef struct {
  vec3 first, second, third;
} lower_triangle;

SHARED lower_triangle cholesky_of(symmetric3 s)
{
  lower_triangle l;
  real x = root_if_positive(s.xx), by_x = inverse_if_positive(x);
  l.first = make_vec3(x, s.xy * by_x, s.xz * by_x);
  real y = root_if_positive(s.yy - l.first.y * l.first.y), by_y = inverse_if_positive(y);
  l.second = make_vec3(R(0.0), y, (s.yz - l.first.y * l.first.z) * by_y);
  real z = root_if_positive(s.zz - l.first.z * l.first.z - l.second.z * l.second.z);
  l.third = make_vec3(R(0.0), R(0.0), z);
  return l;
}

/* x with triangle^T x = v, and with triangle x = v. */
SHARED vec3 solved_by_transpose(lower_triangle l, vec3 v)
{
  real z = v.z * inverse_if_positive(l.third.z);
  real y = (v.y - l.second.z * z) * inverse_if_positive(l.second.y);
  real x = (v.x - l.first.y * y - l.first.z * z) * inverse_if_positive(l.first.x);
  return make_vec3(x, y, z);
}
SHARED vec3 solved_by_triangle(lower_triangle l, vec3 v)
{
  real x = v.x * inverse_if_positive(l.first.x);
  real y = (v.y - l.first.y * x) * inverse_if_positive(l.second.y);
  real z = (v.z - l.first.z * x - l.second.z * y) * inverse_if_positive(l.third.z);
  return make_vec3(x, y, z);
}
SHARED vec3 triangle_times(lower_triangle l, vec3 v)
{
  return add_scaled(add_scaled(scale(l.first, v.x), l.second, v.y), l.third, v.z);
}
SHARED vec3 column_of(lower_triangle l, uint n) { return n == 0u ? l.first : n == 1u ? l.second : l.third; }

/* The lower triangle of which an inverse inertia is the product with its transpose, linear motion first:
 *
 *     | linear             |
 *     | turned^T  angular  |
 */
typedef struct {
  lower_triangle linear, angular;
  mat3 turned; /* rows: how each column of linear turns */
} root_triangle;

SHARED root_triangle root_triangle_of(symmetric6 inverse)
{
  root_triangle r;
  r.linear = cholesky_of(inverse.first);
  mat3 columns = transposed(inverse.coupling); /* by axis of rotation, what it does along each direction */
  vec3 x = solved_by_triangle(r.linear, columns.x), y = solved_by_triangle(r.linear, columns.y),
       z = solved_by_triangle(r.linear, columns.z);
  mat3 rows = {x, y, z};
  r.turned = transposed(rows);
  r.angular = cholesky_of(add_symmetric_product(inverse.second, rows, rows, R(-1.0)));
  return r;
}

SHARED root_triangle load_root_triangle(const articulation *t, tree_link root)
{
  return root_triangle_of(load_symmetric6(t, root.k));
}

SHARED vec3 row_of_matrix(mat3 m, uint n) { return n == 0u ? m.x : n == 1u ? m.y : m.z; }

/* --- making the table ----------------------------------------------------------------------------------------- */
/* A joint that nothing pushes, and how it answers its parent. */
typedef struct {
  placed_joint joint;
  single_factor single;
  ball_factor ball;
  shape_uint rows; /* of its parent */
} following_joint;

SHARED void load_following_joint(const articulation *t, tree_link l, following_joint *f)
{
  f->joint = load_placed_joint(t, l);
  f->single = load_single_factor(t, l);
  f->ball = load_ball_factor(t, l);
  f->rows = load_path_word(t, l.k, (uint)PATH_FIRST_ENTRY);
}

/* The motion of the link while its parent moves so and nothing pushes the joint. */
SHARED spatial_motion motion_of_follower(tree_link l, const following_joint *f, spatial_motion parent)
{
  spatial_motion at_b = motion_at(parent, f->joint.from_parent);
  mask one = has_one_freedom(l), ball = l.is_ball;
  vec3 world = zero3();
  if (any_of(one)) world = choose3(one, scale(xyz(f->joint.frame), change_of_single(&f->single, at_b)), world);
  if (any_of(ball)) world = choose3(ball, change_of_ball(&f->ball, f->joint, at_b), world);
  return motion_at(add_motions(at_b, joint_motion(l, world, zero3())), f->joint.to_center);
}

/* Rows are gone through by some at once, so that a device waits for their memory once. */
#define PATH_CHUNK (2u * ROWS_AT_ONCE)

/* The rows of the parent as the link follows it. */
SHARED void follow_path_of_parent_if(mask wanted, const articulation *t, tree_link l, const following_joint *f)
{
  for (uint first = 0u; any_of(wanted & ((uint_lanes)first < f->rows)); first += PATH_CHUNK) {
    spatial_motion row[PATH_CHUNK];
    for (uint n = 0u; n < PATH_CHUNK; ++n) {
      shape_uint entry = first + n;
      row[n] = load_path_motion_if(wanted & (entry < f->rows), t, l.parent, entry);
    }
    for (uint n = 0u; n < PATH_CHUNK; ++n) {
      shape_uint entry = first + n;
      store_path_motion_if(wanted & (entry < f->rows), t, l.k, entry, motion_of_follower(l, f, row[n]));
    }
  }
}

SHARED void begin_path_by_single_if(mask wanted, const articulation *t, tree_link l, const following_joint *f)
{
  if (!any_of(wanted)) return;
  spatial_motion axis = motion_at(axis_motion(l, f->joint), f->joint.to_center);
  real unit = root_if_positive(f->single.inverse);
  spatial_motion m = {scale(axis.angular, unit), scale(axis.linear, unit)};
  store_path_motion_if(wanted, t, l.k, f->rows, m);
}

SHARED void begin_path_by_ball_if(mask wanted, const articulation *t, tree_link l, const following_joint *f)
{
  if (!any_of(wanted)) return;
  lower_triangle unit = cholesky_of(f->ball.inverse);
  for (uint n = 0u; n < 3u; ++n) {
    spatial_motion turn = {column_of(unit, n), zero3()};
    store_path_motion_if(wanted, t, l.k, f->rows + n, motion_at(turn, f->joint.to_center));
  }
}

SHARED void begin_path_by_root_if(mask wanted, const articulation *t, tree_link l)
{
  if (!any_of(wanted)) return;
  root_triangle unit = load_root_triangle(t, l);
  for (uint n = 0u; n < 3u; ++n) {
    spatial_motion along = {row_of_matrix(unit.turned, n), column_of(unit.linear, n)};
    spatial_motion about = {column_of(unit.angular, n), zero3()};
    store_path_motion_if(wanted, t, l.k, n, along);
    store_path_motion_if(wanted, t, l.k, 3u + n, about);
  }
}

CALLED void prepare_paths_if(mask wanted, const articulation *tree)
{
  articulation own = *tree;
  const articulation *t = &own;
  BEGIN_WALK(following_joint, load_following_joint, t, 0u);
  for (uint k = 0u; k < t->most_links; ++k) {
    WALK_TO(following_joint, load_following_joint, t, k, k + 1u);
    l.exists = l.exists & wanted;
    follow_path_of_parent_if(l.exists & !l.is_root, t, l, &now);
    begin_path_by_single_if(l.exists & has_one_freedom(l), t, l, &now);
    begin_path_by_ball_if(l.exists & l.is_ball, t, l, &now);
    begin_path_by_root_if(l.exists & l.is_free, t, l);
  }
}

/* --- z -------------------------------------------------------------------------------------------------------- */
/* Of freedoms, a bit each. */
typedef struct {
  uint_lanes low, high;
} freedom_set;

SHARED mask has_freedom(freedom_set set, uint freedom)
{
  uint_lanes word = freedom < 32u ? set.low : set.high;
  return ((word >> (uint_lanes)(freedom & 31u)) & (uint_lanes)1u) != 0u;
}

/* The freedoms of any lane, from the lowest on. */
typedef struct {
  uint low, high;
} freedoms_left;

SHARED freedoms_left freedoms_of_any(freedom_set set)
{
  freedoms_left left = {bits_of_any(set.low), bits_of_any(set.high)};
  return left;
}
SHARED uint any_left(const freedoms_left *left) { return left->low | left->high; }
SHARED uint next_freedom(freedoms_left *left)
{
  uint in_high = left->low == 0u ? 1u : 0u, bits = in_high ? left->high : left->low;
  if (in_high) left->high = bits & (bits - 1u);
  else left->low = bits & (bits - 1u);
  return 32u * in_high + lowest_bit(bits);
}

SHARED uint next_freedom_or_none(freedoms_left *left) { return any_left(left) ? next_freedom(left) : TREE_FREEDOMS; }

/* For each freedom of a tree what has pushed it. */
typedef struct {
  uint count; /* freedoms of any lane, in whole chunks */
  real change[TREE_FREEDOMS];
} tree_freedoms;

/* In chunks, because an H200 takes 7% longer for the contacts of trees if the loop goes one by one. */
#define FREEDOMS_CHUNK 4u
SHARED void begin_freedoms(const articulation *t, tree_freedoms *z)
{
  for (z->count = 0u; any_of((uint_lanes)z->count < t->freedoms); z->count += FREEDOMS_CHUNK)
    for (uint n = 0u; n < FREEDOMS_CHUNK; ++n) z->change[z->count + n] = R(0.0);
}

/* The path of a link, from freedom to freedom. */
typedef struct {
  uint_lanes k, entry;
  freedom_set freedoms;
} path_walk;

SHARED path_walk walk_of_path_if(mask wanted, const articulation *t, uint_lanes k)
{
  path_walk w;
  w.k = k;
  w.entry = (uint_lanes)0u;
  w.freedoms.low = choose(wanted, load_path_word(t, k, (uint)PATH_BITS), (uint_lanes)0u);
  w.freedoms.high = choose(wanted, load_path_word(t, k, (uint)PATH_BITS + 1u), (uint_lanes)0u);
  return w;
}
SHARED freedom_set freedoms_of_either(const path_walk *a, const path_walk *b)
{
  freedom_set set = {a->freedoms.low | b->freedoms.low, a->freedoms.high | b->freedoms.high};
  return set;
}
/* Of the next freedom of the path; no motion where it is not wanted. */
SHARED spatial_motion next_motion_if(mask wanted, const articulation *t, path_walk *w)
{
  if (!any_of(wanted)) return no_motion();
  spatial_motion m = load_path_motion_if(wanted, t, w->k, w->entry);
  w->entry = choose(wanted, w->entry + 1u, w->entry);
  return choose_motion(wanted, m, no_motion());
}

/* z in memory: those of trees that lie beside each other lie beside each other. */
SHARED row_number change_row(const articulation *t, shape_uint freedom)
{
  return row_in(&t->place, t->first, TREE_FREEDOMS, freedom, 1u, 0u);
}
SHARED real load_change_if(mask wanted, const articulation *t, shape_uint freedom)
{
  return load_real_of_row(t->change, wanted_row(wanted, change_row(t, freedom)));
}
SHARED vec3 load_three_changes_if(mask wanted, const articulation *t, shape_uint first)
{
  return make_vec3(load_change_if(wanted, t, first), load_change_if(wanted, t, first + 1u),
                   load_change_if(wanted, t, first + 2u));
}

/* What leaving z at a link reads. */
typedef struct {
  real inverse; /* of a joint with one degree of freedom */
  shape_uint first;
} pending_link;

SHARED void load_pending_link(const articulation *t, tree_link l, pending_link *p)
{
  p->inverse = load_single_factor(t, l).inverse;
  p->first = load_path_word(t, l.k, (uint)PATH_FIRST_FREEDOM);
}

SHARED spatial_force pending_of_freedoms(const articulation *t, tree_link l, const pending_link *of)
{
  shape_uint first = of->first;
  spatial_force pending = no_force();
  mask one = l.exists & has_one_freedom(l), ball = l.exists & l.is_ball, free = l.exists & l.is_free;
  if (any_of(one)) {
    real change = load_change_if(one, t, first) * root_if_positive(of->inverse);
    pending.moment = choose3(one, make_vec3(change, R(0.0), R(0.0)), pending.moment);
  }
  if (any_of(ball)) {
    lower_triangle unit = cholesky_of(load_ball_factor(t, l).inverse);
    pending.moment = choose3(ball, triangle_times(unit, load_three_changes_if(ball, t, first)), pending.moment);
  }
  if (any_of(free)) { /* the impulse on the root that changes its velocity so */
    root_triangle unit = load_root_triangle(t, l);
    vec3 about = solved_by_transpose(unit.angular, load_three_changes_if(free, t, first + 3u));
    vec3 along = subtract(load_three_changes_if(free, t, first), rotate(unit.turned, about));
    pending.moment = choose3(free, about, pending.moment);
    pending.force = choose3(free, solved_by_transpose(unit.linear, along), pending.force);
  }
  return pending;
}

/* What joints of others have left pending becomes velocities. */
CALLED void settle_if_pending(mask wanted, const articulation *tree)
{
  articulation own = *tree;
  const articulation *t = &own;
  mask is_pending = wanted & !wanted;
  for (uint k = 0u; k < t->most_links; ++k) {
    spatial_force pending = load_pending(t, tree_link_of(t, k).k);
    is_pending = is_pending | is_nonzero(pending.moment) | is_nonzero(pending.force);
  }
  is_pending = is_pending & wanted;
  if (any_of(is_pending)) settle_tree_if(is_pending, t);
}

/* z becomes pending at the joints (respond.h), where nothing is. */
CALLED void leave_pending_if(mask wanted, const articulation *tree, const tree_freedoms *z)
{
  articulation own = *tree;
  const articulation *t = &own;
  for (uint d = 0u; d < z->count; ++d)
    store_real_of_row_if(wanted & ((uint_lanes)d < t->freedoms), t->change, change_row(t, d), z->change[d]);
  BEGIN_WALK(pending_link, load_pending_link, t, 0u);
  for (uint k = 0u; k < t->most_links; ++k) {
    WALK_TO(pending_link, load_pending_link, t, k, k + 1u);
    l.exists = l.exists & wanted;
    store_force(l.exists, t, l.k, (uint)WORK_PENDING, pending_of_freedoms(t, l, &now));
  }
}

#endif
