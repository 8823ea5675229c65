/* bodies.h - the links of articulations as bodies of the pipeline.
 *
 *   poses and velocities of bodies  --begin-->  coordinates of joints  --substeps-->  poses and velocities of bodies
 *
 * The state of an articulation between two steps is that of its bodies alone, so calls, snapshots and batches need to
 * know nothing of it. A step reads the coordinates of the joints from the bodies. What a body has besides, because a
 * program has put it where its joint cannot be, is lost then: joints never open.
 *
 * In the graph of contacts an articulation is one node, because an impulse on one link changes the velocities of all.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_BODIES_H
#define TANDEM_SHARED_ARTICULATIONS_BODIES_H

#include "shared/argument_groups.h"
#include "shared/articulations/free_motion.h"
#include "shared/batching/nodes.h"
#include "shared/solve/pass.h"

/* Records of tree_colors (tree_contacts.h); those of tree_contact have TREE_COLORS. */
#define TREE_COLOR_WORDS 4u
/* The first word of tree_colors while contacts are solved: whether the tree has its table of paths where it stands,
 * from this pass or from one before. */
enum { PATHS_ARE_MISSING, PATHS_ARE_NEW, PATHS_ARE_KEPT };
/* Words of articulation_place: block, item, stride (tree.h), the number of links; of a tree that has a table of paths
 * where that of its block begins, in entries, the most entries of a link, and the freedoms of the tree; of others 0;
 * and the first of the places of trees that its block takes. */
enum { PLACE_PATHS = 4, PLACE_FREEDOMS = 6, PLACE_FIRST, PLACE_WORDS };

SHARED articulation articulation_at(read_links links, write_link_states states, uint_lanes number)
{
  uint_lanes place = (uint)PLACE_WORDS * number;
  articulation t;
  t.code = links.code;
  t.link = links.row;
  t.range = links.range;
  t.state = states.state;
  t.root = states.root;
  t.work = states.work;
  t.next = states.next;
  t.freedom = links.freedom;
  t.path = states.path;
  t.change = states.change;
  uint_lanes block = load_uint(links.place, place), item = load_uint(links.place, place + 1u);
  t.place = place_beside(block, item, load_uint(links.place, place + 2u));
  t.block = of_shape(&t.place, block);
  t.first = of_shape(&t.place, load_uint(links.place, place + (uint)PLACE_FIRST));
  t.links = load_uint(links.place, place + 3u);
  t.path_block = of_shape(&t.place, load_uint(links.place, place + (uint)PLACE_PATHS));
  t.path_entries = of_shape(&t.place, load_uint(links.place, place + (uint)PLACE_PATHS + 1u));
  t.freedoms = of_shape(&t.place, load_uint(links.place, place + (uint)PLACE_FREEDOMS));
  t.number = number;
  t.most_links = 0u;
  while (any_of((uint_lanes)t.most_links < t.links)) ++t.most_links;
  return t;
}

/* --- further passes ------------------------------------------------------------------------------------------- */
/* Whether the tree takes part in the pass: in PASS_FURTHER if order_tree_contacts has noted so of its world. */
SHARED mask takes_pass(write_link_states states, uint_lanes tree, uint pass)
{
  uint_lanes one = (uint_lanes)1u;
  return (pass == (uint)PASS_FURTHER ? load_uint(states.colors, TREE_COLOR_WORDS * tree + 1u) : one) != (uint_lanes)0u;
}

/* What the rows of a pass look at. */
SHARED uint kind_of_pass(uint pass) { return pass == (uint)PASS_FURTHER ? (uint)PASS_BIASED : pass; }

/* A tree that does not take part has no links. */
SHARED articulation articulation_in_pass(read_links links, write_link_states states, uint_lanes number, uint pass)
{
  articulation t = articulation_at(links, states, number);
  t.links = choose(takes_pass(states, number, pass), t.links, (uint_lanes)0u);
  return t;
}

SHARED uint_lanes body_of_link(read_links links, const articulation *t, shape_uint k)
{
  return load_uint_of_row(links.body, tree_row(t, 1u, k, 0u));
}

/* Whether a contact has pushed a link in this substep: beside the force on a free root. */
SHARED void note_pushed_if(mask wanted, const articulation *t, real pushed)
{
  store_root(wanted & has_links(t), t, (uint)ROOT_LINEAR_FORCE,
             extend(xyz(load_root(t, (uint)ROOT_LINEAR_FORCE)), pushed));
}
SHARED mask is_pushed(const articulation *t) { return load_root(t, (uint)ROOT_LINEAR_FORCE).w != R(0.0); }

/* --- from bodies to coordinates ------------------------------------------------------------------------------- */
/* Bodies of links. */
typedef struct {
  read_links links;
  read_bodies bodies;
} linked_bodies;

/* A body as its joint sees it. Of the ground, frame a stands where the table of articulations says. */
typedef struct {
  double_float3 position;
  quat orientation;
  spatial_motion velocity;
} seen_body;

SHARED seen_body ground(void)
{
  seen_body g = {{zero3(), zero3()}, make_quat(R(0.0), R(0.0), R(0.0), R(1.0)), no_motion()};
  return g;
}
SHARED seen_body load_seen_body(const linked_bodies *b, const articulation *t, shape_uint k)
{
  uint_lanes body = body_of_link(b->links, t, k);
  spatial_velocity m = load_velocity(b->bodies.velocity, body);
  seen_body seen = {load_position(b->bodies.position, body),
                    quat_from(load_float4(b->bodies.orientation, body)),
                    {m.angular, m.linear}};
  return seen;
}
SHARED seen_body choose_seen_body(mask m, seen_body a, seen_body b)
{
  seen_body s = {{choose3(m, a.position.high, b.position.high), choose3(m, a.position.low, b.position.low)},
                 quat_from(choose4(m, quat_to_vec4(a.orientation), quat_to_vec4(b.orientation))),
                 choose_motion(m, a.velocity, b.velocity)};
  return s;
}
/* before: the body of link k - 1. */
SHARED seen_body seen_parent(const linked_bodies *b, const articulation *t, tree_link l, uint k, seen_body before)
{
  mask follows = follows_at_once(l, k);
  if (!any_of(!follows)) return before;
  seen_body loaded = choose_seen_body(l.is_root, ground(), load_seen_body(b, t, l.parent));
  return choose_seen_body(follows, before, loaded);
}

/* The two frames of a joint as the bodies have them, in axes of the world. offset: between the centres; of a held root,
 * from frame a. */
typedef struct {
  quat a, relative;
  vec3 offset, arm_a, arm_b;
} seen_joint;

SHARED seen_joint seen_joint_between(const link_constants *c, seen_body parent, seen_body own, vec3 offset)
{
  seen_joint j;
  j.a = quat_multiply(parent.orientation, quat_from(c->orientation_a));
  quat b = quat_multiply(own.orientation, quat_from(c->orientation_b));
  j.relative = quat_normalized(quat_multiply(conjugate(j.a), b));
  j.offset = offset;
  j.arm_a = rotate(rotation_of(parent.orientation), xyz(c->frame_a));
  j.arm_b = rotate(rotation_of(own.orientation), xyz(c->frame_b));
  return j;
}

SHARED vec4 position_of_joint(tree_link l, seen_joint j)
{
  vec3 gap = subtract(add(j.offset, j.arm_b), j.arm_a);
  real way = dot3(axis_x(rotation_of(j.a)), gap), zero = R(0.0);
  vec4 position = make_vec4(choose(l.is_slider, way, zero), zero, zero, zero);
  position.x = choose(l.is_hinge, twist_of(j.relative), position.x);
  return choose4(l.is_ball | l.is_free, quat_to_vec4(j.relative), position);
}

/* Numbers of the joint's velocity; of a free root, the angular part. */
SHARED vec3 velocity_of_joint(tree_link l, seen_joint j, spatial_motion parent, spatial_motion own)
{
  vec3 turns = subtract(own.angular, parent.angular), axis = axis_x(rotation_of(j.a)), none = zero3();
  vec3 at_b = motion_at(own, j.arm_b).linear, carried = motion_at(parent, add(j.offset, j.arm_b)).linear;
  vec3 v = choose3(l.is_hinge, make_vec3(dot3(axis, turns), R(0.0), R(0.0)), none);
  v = choose3(l.is_slider, make_vec3(dot3(axis, subtract(at_b, carried)), R(0.0), R(0.0)), v);
  v = choose3(l.is_ball, rotate_back(rotation_of(j.a), turns), v);
  return choose3(l.is_free, own.angular, v);
}

/* The root stands where its body does, or where the ground holds it. */
SHARED void read_root(read_links links, read_bodies bodies, const articulation *t)
{
  tree_link root = tree_link_of(t, 0u);
  uint_lanes body = body_of_link(links, t, root.k);
  double_float3 at = {xyz(load_float4(links.ground, 2u * t->number)),
                      xyz(load_float4(links.ground, 2u * t->number + 1u))},
                of_body = load_position(bodies.position, body);
  at.high = choose3(root.is_free, of_body.high, at.high);
  at.low = choose3(root.is_free, of_body.low, at.low);
  vec3 linear = choose3(root.is_free, load_velocity(bodies.velocity, body).linear, zero3());
  store_root(has_links(t), t, (uint)ROOT_POSITION, extend(at.high, R(0.0)));
  store_root(has_links(t), t, (uint)ROOT_POSITION + 1u, extend(at.low, R(0.0)));
  store_root(has_links(t), t, (uint)ROOT_LINEAR_VELOCITY, extend(linear, R(0.0)));
  store_root(has_links(t), t, (uint)ROOT_LINEAR_FORCE, extend(zero3(), R(0.0)));
}

/* What the walk reads of a link. */
typedef struct {
  link_constants constants;
  seen_body seen;
} reading_link;

SHARED void load_reading_link(const linked_bodies *b, const articulation *t, tree_link l, reading_link *r)
{
  r->constants = load_link_constants(t, l);
  r->seen = load_seen_body(b, t, l.k);
}

/* The joint of a link as its bodies have it: position, and numbers of the velocity. */
typedef struct {
  vec4 position;
  vec3 numbers;
} read_joint;

SHARED read_joint read_link(const articulation *t, tree_link l, const reading_link *of, seen_body parent,
                            double_float3 root)
{
  seen_body own = of->seen;
  vec3 offset = choose3(l.is_root, way_between(root, own.position), way_between(parent.position, own.position));
  seen_joint j = seen_joint_between(&of->constants, parent, own, offset);
  read_joint r = {position_of_joint(l, j), velocity_of_joint(l, j, parent.velocity, own.velocity)};
  vec4 none = extend(zero3(), R(0.0));
  store_state(l.exists, t, l.k, (uint)STATE_JOINT_POSITION, r.position);
  store_state(l.exists, t, l.k, (uint)STATE_JOINT_VELOCITY, extend(r.numbers, R(0.0)));
  for (uint row = (uint)STATE_JOINT_FORCE; row < (uint)STATE_ROWS; ++row) store_state(l.exists, t, l.k, row, none);
  return r;
}

/* And places the links where their joints are. */
CALLED void read_articulation(read_links links, read_bodies bodies, const articulation *tree, real h)
{
  articulation own = *tree;
  const articulation *t = &own;
  linked_bodies b = {links, bodies};
  read_root(links, bodies, t);
  double_float3 root = root_position(t);
  standing_link s = standing_ground();
  seen_body before = ground();
  BEGIN_WALK_WITH(&b, reading_link, load_reading_link, t, 0u);
  for (uint k = 0; k < t->most_links; ++k) {
    WALK_WITH(&b, reading_link, load_reading_link, t, k, k + 1u);
    now.constants.inertia = implicit_inertia_of(&now.constants, h);
    read_joint joint = read_link(t, l, &now, seen_parent(&b, t, l, k, before), root);
    before = now.seen;
    s = place_and_weigh_link(t, l, k, &now.constants, s, joint.position, joint.numbers);
  }
}

/* --- from coordinates to bodies ------------------------------------------------------------------------------- */
SHARED void write_velocities_from(read_links links, const articulation *t, uint first, GLOBAL float4 *solver_velocity)
{
  tree_link l[ROWS_AT_ONCE];
  uint_lanes body[ROWS_AT_ONCE];
  spatial_velocity m[ROWS_AT_ONCE];
  for (uint n = 0; n < ROWS_AT_ONCE; ++n) {
    l[n] = tree_link_of(t, first + n);
    body[n] = body_of_link(links, t, l[n].k);
  }
  for (uint n = 0; n < ROWS_AT_ONCE; ++n) {
    spatial_motion now = load_motion(t, l[n].k, (uint)WORK_VELOCITY);
    m[n] = load_velocity(solver_velocity, body[n]);
    m[n].linear = now.linear;
    m[n].angular = now.angular;
  }
  for (uint n = 0; n < ROWS_AT_ONCE; ++n) store_velocity_if(l[n].exists, solver_velocity, body[n], m[n]);
}
CALLED void write_velocities(read_links links, const articulation *tree, GLOBAL float4 *solver_velocity)
{
  articulation own = *tree;
  const articulation *t = &own;
  for (uint first = 0; first < t->most_links; first += ROWS_AT_ONCE)
    write_velocities_from(links, t, first, solver_velocity);
}

/* What writing the pose of a body reads. from: where and how it stood when the step began. */
typedef struct {
  uint_lanes body;
  double_float3 from;
  quat from_orientation, orientation;
  vec3 offset;
} posed_link;

SHARED void load_posed_link(const linked_bodies *b, const articulation *t, tree_link l, posed_link *p)
{
  p->body = body_of_link(b->links, t, l.k);
  p->from = load_position(b->bodies.position, p->body);
  p->from_orientation = quat_from(load_float4(b->bodies.orientation, p->body));
  p->orientation = quat_from(load_work(t, l.k, (uint)WORK_ORIENTATION));
  p->offset = xyz(load_work(t, l.k, (uint)WORK_OFFSET));
}

/* What the step has moved the body by, from where it began. */
SHARED void write_pose(tree_link l, const posed_link *p, double_float3 root, GLOBAL float4 *delta_pose,
                       GLOBAL float4 *orientation)
{
  vec3 moved = way_between(p->from, moved_position(root, p->offset));
  vec3 turned_by = rotation_vector(quat_multiply(p->orientation, conjugate(p->from_orientation)));
  store_float4_if(l.exists, delta_pose, p->body * 2u, extend(moved, R(0.0)));
  store_float4_if(l.exists, delta_pose, p->body * 2u + 1u, extend(turned_by, R(0.0)));
  store_float4_if(l.exists, orientation, p->body, quat_to_vec4(p->orientation));
}
CALLED void write_bodies(read_links links, read_bodies bodies, const articulation *tree, write_moved_bodies moved)
{
  articulation own = *tree;
  const articulation *t = &own;
  linked_bodies b = {links, bodies};
  double_float3 root = root_position(t);
  BEGIN_WALK_WITH(&b, posed_link, load_posed_link, t, 0u);
  for (uint k = 0; k < t->most_links; ++k) {
    WALK_WITH(&b, posed_link, load_posed_link, t, k, k + 1u);
    write_pose(l, &now, root, moved.delta, moved.orientation);
  }
  write_velocities(links, t, moved.velocity);
}

#endif
