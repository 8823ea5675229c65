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

/* Words of articulation_place: block, item, stride (tree.h), and the number of links. */
#define PLACE_WORDS 4u

SHARED articulation articulation_at(read_links links, write_link_states states, uint number)
{
  GLOBAL const uint *place = links.place + PLACE_WORDS * number;
  articulation t = {links.code, links.row, states.state, states.root, states.work, states.next,
                    place[0],   place[1],  place[2],     place[3],    number,      place[3]};
  return t;
}

SHARED uint body_of_link(read_links links, const articulation *t, uint k) { return links.body[tree_row(t, 1u, k, 0u)]; }

/* Whether a contact has pushed a link in this substep: beside the force on a free root. */
SHARED void note_pushed(const articulation *t, real pushed)
{
  store_root(1, t, (uint)ROOT_LINEAR_FORCE, extend(xyz(load_root(t, (uint)ROOT_LINEAR_FORCE)), pushed));
}
SHARED mask is_pushed(const articulation *t) { return load_root(t, (uint)ROOT_LINEAR_FORCE).w != R(0.0); }

/* --- from bodies to coordinates ------------------------------------------------------------------------------- */
/* A body as its joint sees it. Of the ground, frame a stands where the table of articulations says. */
typedef struct {
  quat orientation;
  spatial_motion velocity;
} seen_body;

SHARED seen_body ground(void)
{
  seen_body g = {make_quat(R(0.0), R(0.0), R(0.0), R(1.0)), no_motion()};
  return g;
}
SHARED seen_body load_seen_body(read_bodies bodies, uint body)
{
  spatial_velocity m = load_velocity(bodies.velocity, body);
  seen_body b = {quat_from(load_float4(bodies.orientation, body)), {m.angular, m.linear}};
  return b;
}

/* The two frames of a joint as the bodies have them, in axes of the world. offset: between the centres; of a held root,
 * from frame a. */
typedef struct {
  quat a, relative;
  vec3 offset, arm_a, arm_b;
} seen_joint;

SHARED seen_joint seen_joint_between(const articulation *t, tree_link l, seen_body parent, seen_body own, vec3 offset)
{
  seen_joint j;
  j.a = quat_multiply(parent.orientation, quat_from(load_link(t, l.k, (uint)LINK_FRAME_A_ORIENTATION)));
  quat b = quat_multiply(own.orientation, quat_from(load_link(t, l.k, (uint)LINK_FRAME_B_ORIENTATION)));
  j.relative = quat_normalized(quat_multiply(conjugate(j.a), b));
  j.offset = offset;
  j.arm_a = rotate(rotation_of(parent.orientation), xyz(load_link(t, l.k, (uint)LINK_FRAME_A)));
  j.arm_b = rotate(rotation_of(own.orientation), xyz(load_link(t, l.k, (uint)LINK_FRAME_B)));
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

SHARED vec3 offset_of_link(read_links links, read_bodies bodies, const articulation *t, tree_link l, uint body)
{
  if (!l.is_root) return offset_between(bodies.position, body_of_link(links, t, l.parent), body);
  return way_between(root_position(t), load_position(bodies.position, body));
}

/* The root stands where its body does, or where the ground holds it. */
SHARED void read_root(read_links links, read_bodies bodies, const articulation *t)
{
  tree_link root = tree_link_of(t, 0u);
  uint body = body_of_link(links, t, 0u);
  double_float3 at = {xyz(load_float4(links.ground, 2u * t->number)),
                      xyz(load_float4(links.ground, 2u * t->number + 1u))};
  vec3 linear = zero3();
  if (root.is_free) {
    at = load_position(bodies.position, body);
    linear = load_velocity(bodies.velocity, body).linear;
  }
  store_root(1, t, (uint)ROOT_POSITION, extend(at.high, R(0.0)));
  store_root(1, t, (uint)ROOT_POSITION + 1u, extend(at.low, R(0.0)));
  store_root(1, t, (uint)ROOT_LINEAR_VELOCITY, extend(linear, R(0.0)));
  store_root(1, t, (uint)ROOT_LINEAR_FORCE, extend(zero3(), R(0.0)));
}

SHARED void read_link(read_links links, read_bodies bodies, const articulation *t, tree_link l)
{
  uint body = body_of_link(links, t, l.k);
  seen_body own = load_seen_body(bodies, body), parent = ground();
  if (!l.is_root) parent = load_seen_body(bodies, body_of_link(links, t, l.parent));
  seen_joint j = seen_joint_between(t, l, parent, own, offset_of_link(links, bodies, t, l, body));
  vec4 none = extend(zero3(), R(0.0));
  store_state(1, t, l.k, (uint)STATE_JOINT_POSITION, position_of_joint(l, j));
  store_state(1, t, l.k, (uint)STATE_JOINT_VELOCITY,
              extend(velocity_of_joint(l, j, parent.velocity, own.velocity), R(0.0)));
  for (uint row = (uint)STATE_JOINT_FORCE; row < (uint)STATE_ROWS; ++row) store_state(1, t, l.k, row, none);
}

SHARED void read_articulation(read_links links, read_bodies bodies, const articulation *t)
{
  read_root(links, bodies, t);
  for (uint k = 0; k < t->links; ++k) read_link(links, bodies, t, tree_link_of(t, k));
}

/* --- from coordinates to bodies ------------------------------------------------------------------------------- */
SHARED void write_velocity(read_links links, const articulation *t, uint k, GLOBAL float4 *solver_velocity)
{
  uint body = body_of_link(links, t, k);
  spatial_velocity m = load_velocity(solver_velocity, body);
  spatial_motion now = load_motion(t, k, (uint)WORK_VELOCITY);
  m.linear = now.linear;
  m.angular = now.angular;
  store_velocity(solver_velocity, body, m);
}
SHARED void write_velocities(read_links links, const articulation *t, GLOBAL float4 *solver_velocity)
{
  for (uint k = 0; k < t->links; ++k) write_velocity(links, t, k, solver_velocity);
}

/* What the step has moved the body by, from where it began. */
SHARED void write_pose(read_links links, read_bodies bodies, const articulation *t, uint k, GLOBAL float4 *delta_pose,
                       GLOBAL float4 *orientation)
{
  uint body = body_of_link(links, t, k);
  vec3 moved = way_between(load_position(bodies.position, body), link_position(t, k));
  quat q = quat_from(load_work(t, k, (uint)WORK_ORIENTATION)), from = quat_from(load_float4(bodies.orientation, body));
  store_float4(delta_pose, body * 2u, extend(moved, R(0.0)));
  store_float4(delta_pose, body * 2u + 1u, extend(rotation_vector(quat_multiply(q, conjugate(from))), R(0.0)));
  store_float4(orientation, body, quat_to_vec4(q));
}
SHARED void write_poses(read_links links, read_bodies bodies, const articulation *t, GLOBAL float4 *delta_pose,
                        GLOBAL float4 *orientation)
{
  for (uint k = 0; k < t->links; ++k) write_pose(links, bodies, t, k, delta_pose, orientation);
}

#endif
