/* joint.h - joints that hold a link from outside of its tree: to a body, to another tree, or to a link of the same
 * tree, whose loop they close. The rows are those of joints/solve.h, with the response of the trees.
 *
 *         root                    An impulse on one end of a loop moves the other end, too. What of it arrives at the
 *        /    \                   common ancestor is found by a walk from each end, and the inverse inertia of the
 *       o      o                  ancestor says what the one end does to the other:
 *       |      |
 *       a~~~~~~b  closes a loop   response = b C b' + a C a' - (a at the ancestor) C (b' at the ancestor) - the same of
 *                                 the other pair
 *
 * So a loop is solved against the mass that it has. Directions in which the trees cannot open a joint, such as those
 * out of the plane of a four-bar, have no response but rounding. A little compliance, of what the bodies would have
 * alone, keeps impulses from growing along them.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_JOINT_H
#define TANDEM_SHARED_ARTICULATIONS_JOINT_H

#include "shared/articulations/row.h"
#include "shared/joints/solve.h"

/* Of the response that the two bodies would have alone: against velocities, and while a joint closes. The latter bounds
 * the energy that closing gives where the trees can hardly move. */
#define LINK_COMPLIANCE R(1e-4)
#define CLOSING_COMPLIANCE R(0.02)
#define LINK_CLOSING R(2.0) /* m/s, rad/s: no faster, because the pull of a joint that stays open bends the tree */

typedef struct {
  mask wanted; /* others push nothing and write nothing */
  pushed_pair ends;
  joint shape;
  joint_frames frames;
  uint_lanes ancestor;            /* of both links, if they are of one tree */
  symmetric6 inverse_of_ancestor; /* inertia */
} link_joint;

SHARED pushed_side side_of_joint(mask wanted, read_links links, write_link_states states, joint_side s, uint pass)
{
  mask in_table = wanted & is_link(links.of_body, s.body) & !s.is_world;
  return pushed_side_of(in_table, links, states, s.body, s.velocity, s.inertia, s.locks, pass);
}

/* The tree of the joint is that of either side, since both are of one world. */
SHARED mask joint_takes_pass(read_links links, write_link_states states, joint_side a, joint_side b, uint pass)
{
  mask is_a = is_link(links.of_body, a.body) & !a.is_world;
  return takes_pass(states, articulation_of_body(links.of_body, choose(is_a, a.body, b.body)), pass);
}

SHARED uint_lanes common_ancestor(mask wanted, const articulation *t, uint_lanes k, uint_lanes other)
{
  k = choose(wanted, k, (uint_lanes)0u);
  other = choose(wanted, other, (uint_lanes)0u);
  while (any_of(k != other)) {
    mask k_first = k > other, other_first = other > k;
    uint_lanes above_k = tree_link_of(t, k).parent, above_other = tree_link_of(t, other).parent;
    k = choose(k_first, above_k, k);
    other = choose(other_first, above_other, other);
  }
  return k;
}

SHARED link_joint load_link_joint(GLOBAL const Parameters *parameters, read_joints joints, read_turning_bodies bodies,
                                  read_links links, write_link_states states, GLOBAL const float4 *solver_velocity,
                                  uint pass, item_index i)
{
  link_joint j;
  j.shape = load_joint(parameters, joints, bodies, solver_velocity, i);
  j.frames = frames_of(parameters, j.shape, joints, i);
  j.wanted = joint_takes_pass(links, states, j.shape.a, j.shape.b, pass);
  j.shape.a.velocity.inverse_mass = zero_if(!j.wanted, j.shape.a.velocity.inverse_mass);
  j.shape.b.velocity.inverse_mass = zero_if(!j.wanted, j.shape.b.velocity.inverse_mass);
  pushed_side a = side_of_joint(j.wanted, links, states, j.shape.a, pass);
  pushed_side b = side_of_joint(j.wanted, links, states, j.shape.b, pass);
  j.ends = pushed_pair_of(a, b);
  j.ancestor = (uint_lanes)0u;
  j.inverse_of_ancestor = zero_symmetric6();
  if (!any_of(j.ends.is_within)) return j;
  j.ancestor = common_ancestor(j.ends.is_within, &j.ends.a.tree, j.ends.a.k, j.ends.b.k);
  j.inverse_of_ancestor = load_symmetric6(&j.ends.a.tree, j.ancestor);
  return j;
}

/* --- responses ------------------------------------------------------------------------------------------------ */
/* What of an impulse on a link arrives at one of its ancestors. */
CALLED void take_to_ancestor_if(mask wanted, const articulation *tree, uint_lanes k, uint_lanes ancestor,
                                spatial_force *impulse)
{
  articulation own = *tree;
  const articulation *t = &own;
  spatial_force f = *impulse;
  for (mask below = wanted & (k != ancestor); any_of(below); below = below & (k != ancestor)) {
    tree_link l = tree_link_of(t, k);
    factored_joint joint = load_factored_joint(t, l);
    f = choose_force(below, share_of_joint(t, l, &joint, f, zero3()).rest, f);
    k = choose(below, l.parent, k);
  }
  *impulse = f;
}

/* A row, and what of it arrives at the common ancestor. */
typedef struct {
  row_of_pair own, at_ancestor;
} joint_row;

SHARED joint_row row_of_joint(const link_joint *j, row_of_pair own)
{
  joint_row r = {own, own};
  mask within = j->ends.is_within;
  if (!any_of(within)) return r;
  take_to_ancestor_if(within, &j->ends.a.tree, j->ends.a.k, j->ancestor, &r.at_ancestor.a);
  take_to_ancestor_if(within, &j->ends.b.tree, j->ends.b.k, j->ancestor, &r.at_ancestor.b);
  return r;
}

/* How fast the joint moves along `second` by an impulse along `first`. */
SHARED real response_of_joint(const link_joint *j, const joint_row *first, const joint_row *second)
{
  real apart = response_apart(&j->ends, first->own, second->own);
  if (!any_of(j->ends.is_within)) return apart;
  real through = power_of(second->at_ancestor.b, inverse_times(&j->inverse_of_ancestor, first->at_ancestor.a)) +
                 power_of(second->at_ancestor.a, inverse_times(&j->inverse_of_ancestor, first->at_ancestor.b));
  return choose(j->ends.is_within, apart - through, apart);
}
SHARED real response_alone(const link_joint *j, row_of_pair r)
{
  return response_along(j->shape.a, r.a.force, r.a.moment) + response_along(j->shape.b, r.b.force, r.b.moment);
}
SHARED real response_along_row(const link_joint *j, const joint_row *r)
{
  return maximum(response_of_joint(j, r, r), R(0.0)) + LINK_COMPLIANCE * response_alone(j, r->own);
}

SHARED void push_ends_if(mask wanted, link_joint *j, row_of_pair row, real impulse)
{
  pushed_pair before = j->ends;
  push_row(&j->ends, row, impulse);
  j->ends.a = choose_side(wanted, j->ends.a, before.a);
  j->ends.b = choose_side(wanted, j->ends.b, before.b);
  push_each_other_if(wanted, &j->ends);
}

/* --- limits and drives ---------------------------------------------------------------------------------------- */
SHARED axis_row row_of_link_axis(const link_joint *j, const joint_coordinate *at, row_of_pair *row)
{
  axis_row r;
  r.at = *at;
  r.moment_a = add(cross3(j->shape.a.arm, at->direction), at->turn);
  r.moment_b = add(cross3(j->shape.b.arm, at->direction), at->turn);
  row_of_pair own = {{r.moment_a, at->direction}, {r.moment_b, at->direction}};
  *row = own;
  joint_row both = row_of_joint(j, own);
  r.response = response_along_row(j, &both);
  r.shared_response = r.response;
  r.mass = inverse_if_positive(r.response);
  r.leak = R(1.0);
  r.crowded = never_crowded();
  r.speed = speed_of_row(&j->ends, own);
  return r;
}

SHARED void solve_link_axes(GLOBAL const Parameters *parameters, link_joint *j, read_joint_axes axes,
                            GLOBAL float4 *impulse, uint pass, item_index i)
{
  for (uint k = 0; k < parameters->joint_axes; ++k) {
    joint_axis axis = load_axis(parameters, axes, k, i);
    mask wanted = j->wanted & (axis.kind != (uint_lanes)(uint)JOINT_AXIS_NONE);
    if (!any_of(wanted)) continue;
    vec4 kept = load_float4(impulse, joint_plane(parameters, k) + i);
    joint_coordinate at = coordinate_of(j->shape, j->frames, axis.kind);
    row_of_pair row;
    axis_row r = row_of_link_axis(j, &at, &row);
    push_ends_if(wanted, j, row, solve_rows_of_axis(parameters, &r, &axis, &kept, pass));
    store_float4_if(wanted, impulse, joint_plane(parameters, k) + i, kept);
  }
}

/* --- blocks --------------------------------------------------------------------------------------------------- */
/* Three rows along axes, or about them. */
typedef struct {
  joint_row row[3];
} row_block;

SHARED row_block block_along(const link_joint *j, mat3 axes)
{
  vec3 arm_a = j->shape.a.arm, arm_b = j->shape.b.arm;
  row_block b;
  b.row[0] = row_of_joint(j, row_along(arm_a, arm_b, axis_x(axes)));
  b.row[1] = row_of_joint(j, row_along(arm_a, arm_b, axis_y(axes)));
  b.row[2] = row_of_joint(j, row_along(arm_a, arm_b, axis_z(axes)));
  return b;
}
SHARED row_block block_about(const link_joint *j, mat3 axes)
{
  row_block b;
  b.row[0] = row_of_joint(j, row_about(axis_x(axes)));
  b.row[1] = row_of_joint(j, row_about(axis_y(axes)));
  b.row[2] = row_of_joint(j, row_about(axis_z(axes)));
  return b;
}

SHARED symmetric3 response_of_block(const link_joint *j, const row_block *b)
{
  symmetric3 k = {response_along_row(j, &b->row[0]),
                  response_along_row(j, &b->row[1]),
                  response_along_row(j, &b->row[2]),
                  response_of_joint(j, &b->row[0], &b->row[1]),
                  response_of_joint(j, &b->row[0], &b->row[2]),
                  response_of_joint(j, &b->row[1], &b->row[2])};
  return k;
}

SHARED symmetric3 response_while_closing(const link_joint *j, const row_block *b, symmetric3 k)
{
  k.xx = k.xx + CLOSING_COMPLIANCE * response_alone(j, b->row[0].own);
  k.yy = k.yy + CLOSING_COMPLIANCE * response_alone(j, b->row[1].own);
  k.zz = k.zz + CLOSING_COMPLIANCE * response_alone(j, b->row[2].own);
  return k;
}

/* As solve_rows of joints/solve.h. */
SHARED vec3 solve_link_rows(GLOBAL const Parameters *parameters, const link_joint *j, const row_block *b,
                            uint_lanes locked, vec3 speed, vec3 open, vec3 old, uint pass)
{
  symmetric3 k = response_of_block(j, b);
  vec3 rigid = solve_symmetric(rows_of_axes(locked, k), speed);
  if (pass != (uint)PASS_BIASED) return subtract(old, rigid);
  soft_rows rows = soft_rows_of(plain_softness(parameters), open, LINK_CLOSING, R(1.0));
  rigid = add(rigid, solve_symmetric(rows_of_axes(locked, response_while_closing(j, b, k)), rows.closing));
  return subtract(subtract(old, scale(rigid, rows.mass_scale)), scale(old, rows.leak));
}

/* locked: the rows that count, as JOINT_X and so on. open: how far the joint is open along them. */
CALLED void solve_link_block_if(mask wanted, GLOBAL const Parameters *parameters, link_joint *j, const row_block *b,
                                uint_lanes locked, const vec3 *open, vec3 *impulse, uint pass)
{
  vec3 speed = make_vec3(speed_of_row(&j->ends, b->row[0].own), speed_of_row(&j->ends, b->row[1].own),
                         speed_of_row(&j->ends, b->row[2].own));
  vec3 total =
      solve_link_rows(parameters, j, b, locked, along_axes(locked, speed), along_axes(locked, *open), *impulse, pass);
  vec3 change = subtract(total, *impulse);
  row_of_pair sum = scaled_row(b->row[0].own, change.x);
  sum = add_rows(add_rows(sum, scaled_row(b->row[1].own, change.y)), scaled_row(b->row[2].own, change.z));
  push_ends_if(wanted, j, sum, R(1.0));
  *impulse = choose3(wanted, total, *impulse);
}

SHARED mat3 axes_of_world(void)
{
  mat3 m = {make_vec3(R(1.0), R(0.0), R(0.0)), make_vec3(R(0.0), R(1.0), R(0.0)), make_vec3(R(0.0), R(0.0), R(1.0))};
  return m;
}

SHARED void solve_link_blocks(GLOBAL const Parameters *parameters, link_joint *j, joint_impulses *p, uint pass)
{
  uint_lanes turns = j->shape.modes >> (uint)JOINT_ANGULAR_SHIFT, moves = j->shape.modes & (uint)JOINT_XYZ;
  mask held = turns != 0u, whole = moves == (uint_lanes)(uint)JOINT_XYZ, some = (moves != 0u) & !whole;
  if (HAS_FEATURE(parameters, JOINT_FRAMES) && any_of(held)) {
    row_block b = block_about(j, j->frames.axes);
    vec3 open = turn_between(j->frames.relative, turns);
    solve_link_block_if(held, parameters, j, &b, turns, &open, &p->angular, pass);
  }
  if (any_of(whole)) {
    row_block b = block_along(j, axes_of_world());
    solve_link_block_if(whole, parameters, j, &b, moves, &j->shape.gap, &p->linear, pass);
  }
  if (any_of(some)) {
    row_block b = block_along(j, j->frames.axes);
    vec3 open = rotate_back(j->frames.axes, j->shape.gap);
    solve_link_block_if(some, parameters, j, &b, moves, &open, &p->linear, pass);
  }
}

/* --- kernels -------------------------------------------------------------------------------------------------- */
/* All impulses of the joint. */
SHARED row_of_pair row_of_joint_impulses(GLOBAL const Parameters *parameters, const link_joint *j, read_joint_axes axes,
                                         write_joint_impulses impulses, joint_impulses p, item_index i)
{
  joint_wrench w = joint_wrench_of(parameters, j->shape, j->frames, p);
  if (HAS_FEATURE(parameters, JOINT_AXES))
    w = with_wrench_of_axes(parameters, j->shape, j->frames, axes, impulses.axis, w, i);
  row_of_pair r = {{w.moment_a, w.impulse}, {w.moment_b, w.impulse}};
  return r;
}

SHARED void solve_link_joint(GLOBAL const Parameters *parameters, link_joint *j, read_joint_axes axes,
                             write_joint_impulses impulses, GLOBAL float4 *warm_start_impulse, uint pass, item_index i)
{
  joint_impulses p = load_joint_impulses(parameters, impulses.linear, impulses.angular, i);
  if (HAS_FEATURE(parameters, JOINT_AXES)) solve_link_axes(parameters, j, axes, impulses.axis, pass, i);
  solve_link_blocks(parameters, j, &p, pass);
  store_float4_if(j->wanted, impulses.linear, i, extend(p.linear, R(0.0)));
  if (HAS_FEATURE(parameters, JOINT_FRAMES)) store_float4_if(j->wanted, impulses.angular, i, extend(p.angular, R(0.0)));
  if (pass != (uint)PASS_RELAXING) return;
  row_of_pair all = row_of_joint_impulses(parameters, j, axes, impulses, p, i);
  add_warm_start_of_pair(&j->ends, all, parameters->inverse_substep, warm_start_impulse);
}

/* Rows of impulses are read and written as solve_joints_item does. */
SHARED void solve_link_joints_item(GLOBAL const Parameters *parameters, read_joints joints, read_turning_bodies bodies,
                                   read_joint_axes axes, read_links links, write_link_states states,
                                   write_joint_impulses impulses, GLOBAL float4 *solver_velocity,
                                   GLOBAL float4 *warm_start_impulse, uint pass, item_index i)
{
  link_joint j = load_link_joint(parameters, joints, bodies, links, states, solver_velocity, pass, i);
  if (pass == (uint)PASS_WARM_STARTING) {
    joint_impulses p = load_joint_impulses(parameters, impulses.linear, impulses.angular, i);
    row_of_pair all = row_of_joint_impulses(parameters, &j, axes, impulses, p, i);
    add_warm_start_of_pair(&j.ends, all, parameters->inverse_substep, warm_start_impulse);
    return;
  }
  solve_link_joint(parameters, &j, axes, impulses, warm_start_impulse, kind_of_pass(pass), i);
  store_pair(&j.ends, solver_velocity);
}

#ifndef TANDEM_LANES /* ITEM kernels take one item at a time */
/* Those past the last colour, one after another. */
SHARED void solve_link_joints_in_order_item(GLOBAL const Parameters *parameters, read_joints joints,
                                            read_turning_bodies bodies, read_joint_axes axes, read_links links,
                                            GLOBAL const uint *counts, write_link_states states,
                                            write_joint_impulses impulses, GLOBAL float4 *solver_velocity,
                                            GLOBAL float4 *warm_start_impulse, uint pass, uint i)
{
  (void)i;
  for (uint k = counts[LINK_JOINT_COLOR_START + COLOR_OVERFLOW]; k < counts[COUNT_JOINTS]; ++k)
    solve_link_joints_item(parameters, joints, bodies, axes, links, states, impulses, solver_velocity,
                           warm_start_impulse, pass, k);
}
#endif

#endif
