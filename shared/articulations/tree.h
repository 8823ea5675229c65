/* tree.h - articulations in memory: links in an order in which parents come before children, and all that hangs on a
 * link follows it before anything else does (preorder); and their records.
 *
 *      0 root               link      0    1    2    3    4
 *     / \                   parent    -    0    1    1    0
 *    1   4
 *   / \                     inward: from 4 to 0, every link before its parent
 *  2   3                    outward: from 0 to 4
 *
 * Row r of link k of a tree stands at   block * rows + item + (k * rows + r) * stride.
 *
 * With stride 1, the tree lies in one piece, at the link `block`; then one thread finds all of it in few cache lines.
 * With as many trees of one shape beside each other as `stride`, the rows of neighbouring trees are neighbours; then
 * work-items that run one tree each read memory in order. The functions below work for both, and for lanes of different
 * trees.
 *
 * docs/articulations.md has the figures of both layouts.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_TREE_H
#define TANDEM_SHARED_ARTICULATIONS_TREE_H

#include "shared/articulations/joint_types.h"
#include "shared/articulations/place.h"
#include "shared/articulations/spatial.h"

typedef struct {
  GLOBAL const uint *code;    /* a word a link: joint_types.h */
  GLOBAL const float4 *link;  /* LINK_ROWS a link */
  GLOBAL const float4 *range; /* a row a link: lower, upper, target, target speed */
  GLOBAL float4 *state;       /* STATE_ROWS a link */
  GLOBAL float4 *root;        /* ROOT_ROWS a tree */
  GLOBAL float4 *work;        /* WORK_ROWS a link */
  GLOBAL uint *next;          /* a word a link, of which the substep alone knows */
  GLOBAL const uint *freedom; /* PATH_WORDS a link */
  GLOBAL float4 *path;        /* path_entries a link, PATH_ENTRY_ROWS each: path.h */
  GLOBAL memory_real *change; /* TREE_FREEDOMS a tree: path.h */
  tree_place place;
  shape_uint block, first; /* the trees beside each other: their first link in the tables, and their first place */
  uint_lanes links;
  shape_uint path_block, path_entries, freedoms; /* of a tree that has a table of paths; else 0 */
  uint_lanes number;                             /* of the tree */
  uint most_links;                               /* of any lane */
} articulation;

/* One of which a body is in quarantine has none. */
SHARED mask has_links(const articulation *t) { return t->links > 0u; }

/* A link of which the code is known. */
typedef struct {
  shape_uint k, parent;
  mask exists, is_root;
  mask is_hinge, is_slider, is_ball, is_free;
} tree_link;

SHARED row_number tree_row(const articulation *t, uint rows, shape_uint k, uint row)
{
  return row_in(&t->place, t->block, rows, k, rows, row);
}

/* The link k; a tree of another lane may be longer than this one, which then has nothing to do. */
SHARED tree_link tree_link_of(const articulation *t, shape_uint k)
{
  tree_link l;
  l.exists = k < t->links;
  l.k = link_or_root(&t->place, l.exists, k);
  shape_uint code = load_of_shape(t->code, tree_row(t, 1u, l.k, 0u));
  shape_uint joint = code >> (uint)LINK_JOINT_SHIFT, parent = code & (uint)LINK_NO_PARENT;
  l.is_root = parent == (uint_lanes)LINK_NO_PARENT;
  l.parent = zero_if_equal(parent, (uint)LINK_NO_PARENT);
  l.is_hinge = joint == (uint_lanes)(uint)TREE_JOINT_HINGE;
  l.is_slider = joint == (uint_lanes)(uint)TREE_JOINT_SLIDER;
  l.is_ball = joint == (uint_lanes)(uint)TREE_JOINT_BALL;
  l.is_free = joint == (uint_lanes)(uint)TREE_JOINT_FREE;
  return l;
}
SHARED mask has_one_freedom(tree_link l) { return l.is_hinge | l.is_slider; }

SHARED vec4 load_link(const articulation *t, shape_uint k, uint row)
{
  return load_row(t->link, tree_row(t, (uint)LINK_ROWS, k, row));
}
SHARED vec4 load_state(const articulation *t, shape_uint k, uint row)
{
  return load_row(t->state, tree_row(t, (uint)STATE_ROWS, k, row));
}
SHARED void store_state(mask m, const articulation *t, shape_uint k, uint row, vec4 value)
{
  store_row_if(m, t->state, tree_row(t, (uint)STATE_ROWS, k, row), value);
}
SHARED vec4 load_root(const articulation *t, uint row)
{
  return load_float4(t->root, t->number * (uint)ROOT_ROWS + row);
}
SHARED void store_root(mask m, const articulation *t, uint row, vec4 value)
{
  store_float4_if(m, t->root, t->number * (uint)ROOT_ROWS + row, value);
}
SHARED vec4 load_work(const articulation *t, shape_uint k, uint row)
{
  return load_row(t->work, tree_row(t, (uint)WORK_ROWS, k, row));
}
SHARED void store_work(mask m, const articulation *t, shape_uint k, uint row, vec4 value)
{
  store_row_if(m, t->work, tree_row(t, (uint)WORK_ROWS, k, row), value);
}

/* Two rows as a motion, or as a force. */
SHARED spatial_motion load_motion(const articulation *t, shape_uint k, uint row)
{
  spatial_motion m = {xyz(load_work(t, k, row)), xyz(load_work(t, k, row + 1u))};
  return m;
}
SHARED void store_motion(mask wanted, const articulation *t, shape_uint k, uint row, spatial_motion m)
{
  store_work(wanted, t, k, row, extend(m.angular, R(0.0)));
  store_work(wanted, t, k, row + 1u, extend(m.linear, R(0.0)));
}
SHARED spatial_force load_force(const articulation *t, shape_uint k, uint row)
{
  spatial_force f = {xyz(load_work(t, k, row)), xyz(load_work(t, k, row + 1u))};
  return f;
}
SHARED void store_force(mask wanted, const articulation *t, shape_uint k, uint row, spatial_force f)
{
  store_work(wanted, t, k, row, extend(f.moment, R(0.0)));
  store_work(wanted, t, k, row + 1u, extend(f.force, R(0.0)));
}
SHARED void add_to_force(mask wanted, const articulation *t, shape_uint k, uint row, spatial_force f)
{
  store_force(wanted, t, k, row, add_forces(load_force(t, k, row), f));
}

SHARED symmetric6 load_symmetric6(const articulation *t, shape_uint k)
{
  packed_symmetric6 p;
  for (uint row = 0; row < 6u; ++row) p.row[row] = load_work(t, k, (uint)WORK_INERTIA + row);
  return unpacked6(p);
}
SHARED void store_symmetric6(mask wanted, const articulation *t, shape_uint k, symmetric6 s)
{
  packed_symmetric6 p = packed6(s);
  for (uint row = 0; row < 6u; ++row) store_work(wanted, t, k, (uint)WORK_INERTIA + row, p.row[row]);
}

/* --- walks ---------------------------------------------------------------------------------------------------- */
/* Memory answers late, and a walk waits for it link by link. So what a walk needs of a link is a record, `now` of link
 * `l`, which it reads before it writes anything of the link; a device reads that of the link beyond it as well. No walk
 * changes the record of a link at which it has not been, so it may be read early; of none beyond the last link is used.
 * And most links follow their parent at once: what the walk has found at link k - 1 need not come from memory for
 * link k. */
#ifdef READS_AHEAD
#define BEGIN_WALK(record, load, t, first)       \
  tree_link link_ahead = tree_link_of(t, first); \
  record ahead;                                  \
  load(t, link_ahead, &ahead)
#define WALK_TO(record, load, t, k, beyond) \
  tree_link l = link_ahead;                 \
  record now = ahead;                       \
  link_ahead = tree_link_of(t, beyond);     \
  load(t, link_ahead, &ahead)
/* The same of a record that needs more than the tree. */
#define BEGIN_WALK_WITH(more, record, load, t, first) \
  tree_link link_ahead = tree_link_of(t, first);      \
  record ahead;                                       \
  load(more, t, link_ahead, &ahead)
#define WALK_WITH(more, record, load, t, k, beyond) \
  tree_link l = link_ahead;                         \
  record now = ahead;                               \
  link_ahead = tree_link_of(t, beyond);             \
  load(more, t, link_ahead, &ahead)
#else
#define BEGIN_WALK(record, load, t, first) (void)0
#define WALK_TO(record, load, t, k, beyond) \
  tree_link l = tree_link_of(t, k);         \
  record now;                               \
  load(t, l, &now)
#define BEGIN_WALK_WITH(more, record, load, t, first) (void)0
#define WALK_WITH(more, record, load, t, k, beyond) \
  tree_link l = tree_link_of(t, k);                 \
  record now;                                       \
  load(more, t, l, &now)
#endif

SHARED mask follows_at_once(tree_link l, uint k) { return l.parent == (uint_lanes)(k - 1u); }

/* The motion of the parent of link k; of a root, that of the ground. before: that of link k - 1, which has been stored,
 * too. */
SHARED spatial_motion motion_of_parent(const articulation *t, tree_link l, uint k, spatial_motion before, uint row)
{
  mask follows = follows_at_once(l, k);
  if (!any_of(!follows)) return before;
  spatial_motion loaded = choose_motion(l.is_root, no_motion(), load_motion(t, l.parent, row));
  return choose_motion(follows, before, loaded);
}

/* A joint as it stands now. from_parent and to_center meet at its frame b, the point about which it turns. */
typedef struct {
  vec3 from_parent, to_center;
  vec4 frame; /* WORK_FRAME */
  real implicit_inertia;
} placed_joint;

SHARED placed_joint load_placed_joint(const articulation *t, tree_link l)
{
  vec4 to_center = load_work(t, l.k, (uint)WORK_TO_CENTER);
  placed_joint j = {xyz(load_work(t, l.k, (uint)WORK_FROM_PARENT)), xyz(to_center), load_work(t, l.k, (uint)WORK_FRAME),
                    to_center.w};
  return j;
}

/* The numbers of a joint's velocity or force as a vector of the world: of a hinge or slider along its axis, of a ball
 * in the axes of frame a, of a free root as they are. */
SHARED vec3 vector_of_numbers(tree_link l, vec4 frame, vec3 numbers)
{
  vec3 world = choose3(l.is_free, numbers, zero3());
  mask one = has_one_freedom(l);
  if (any_of(one)) world = choose3(one, scale(xyz(frame), numbers.x), world);
  if (any_of(l.is_ball)) world = choose3(l.is_ball, rotate(rotation_of(quat_from(frame)), numbers), world);
  return world;
}
SHARED vec3 numbers_of_vector(tree_link l, vec4 frame, vec3 world)
{
  vec3 numbers = choose3(l.is_free, world, zero3());
  mask one = has_one_freedom(l);
  if (any_of(one)) numbers = choose3(one, make_vec3(dot3(xyz(frame), world), R(0.0), R(0.0)), numbers);
  if (any_of(l.is_ball)) numbers = choose3(l.is_ball, rotate_back(rotation_of(quat_from(frame)), world), numbers);
  return numbers;
}
/* Whether the vector of the world is of rotation, so that it belongs to the angular part of a motion. */
SHARED mask joint_turns(tree_link l) { return l.is_hinge | l.is_ball | l.is_free; }

/* The motion of frame b relative to frame a, at frame b. linear: of a free root. */
SHARED spatial_motion joint_motion(tree_link l, vec3 world, vec3 linear)
{
  spatial_motion m = {choose3(joint_turns(l), world, zero3()), choose3(l.is_slider, world, zero3())};
  m.linear = choose3(l.is_free, linear, m.linear);
  return m;
}

#endif
