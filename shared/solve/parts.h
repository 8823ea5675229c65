/* parts.h - how a body is split among constraints that are solved at the same time, and how it is put together again.
 *
 * solve/mass_split.h has contacts solved so, and joints/mass_split.h joints. Impulses on the parts of a body are listed
 * as entries, 2 constraint + side, and are added in the order of the list; those of long lists in a tree.
 */
#ifndef TANDEM_SHARED_SOLVE_PARTS_H
#define TANDEM_SHARED_SOLVE_PARTS_H

#include "shared/argument_groups.h"
#include "shared/locks.h"
#include "shared/records.h"

/* The entries of a body that has more than this are added in a tree (mass_split_sum.h). The number is above that of
 * colours, so only a scene with overflow constraints or overflow joints has such a body. */
#define SPLIT_DIRECT 64u
#define SPLIT_CHUNK 32u
/* The partial sums of each body have a place of their own: a list of 32 entries needs less than two for each 32. */
#define SPLIT_FIRST_SUM(start) ((start) >> 4u)

/* The constraints of a body with bodies that cannot be pushed carry all that rests on the body, so together they get as
 * large a part of it as all others together. */
SHARED real parts_among(uint_lanes all, uint_lanes static_constraints, mask supported)
{
  mask mixed = (static_constraints > (uint_lanes)0u) & (static_constraints < all);
  return to_real(choose(mixed, choose(supported, static_constraints, all - static_constraints) * 2u, all));
}

/* Of a body whose contacts and joints are solved at the same time. */
SHARED real parts_with_joints(read_body_lists lists, GLOBAL const uint *split_static_constraints, uint_lanes body,
                              mask supported)
{
  uint_lanes contacts = load_uint(lists.start, body + 1u) - load_uint(lists.start, body),
             joints = load_uint(lists.joint_start, body + 1u) - load_uint(lists.joint_start, body);
  return parts_among(contacts + joints, load_uint(split_static_constraints, body), supported);
}

/* Of the last change by which an iteration goes on; momentum: as in split_solve_item. */
SHARED real share_of_momentum(uint momentum) { return (real)momentum / ((real)momentum + R(3.0)); }

SHARED symmetric3 scaled_inertia(symmetric3 m, real s)
{
  symmetric3 r = {m.xx * s, m.yy * s, m.zz * s, m.xy * s, m.xz * s, m.yz * s};
  return r;
}

typedef struct {
  vec3 linear, angular;
} impulse_sum;

/* The impulse that entry `at` of the lists gives to its body. impulses: planes of `stride` constraints, the impulse on
 * b and the angular impulses on a and on b. */
SHARED impulse_sum load_entry(GLOBAL const uint *entries, GLOBAL const float4 *impulses, uint stride, mask wanted,
                              uint_lanes at)
{
  uint_lanes entry = load_uint(entries, choose(wanted, at, (uint_lanes)0u));
  uint_lanes constraint = choose(wanted, entry >> 1u, (uint_lanes)0u),
             side = choose(wanted, entry & 1u, (uint_lanes)0u);
  vec3 push = xyz(load_float4(impulses, constraint));
  impulse_sum sum = {choose3(side == 0u, negate(push), push),
                     xyz(load_float4(impulses, (side + 1u) * stride + constraint))};
  return sum;
}

SHARED impulse_sum load_partial(GLOBAL const float4 *partial, mask wanted, uint_lanes at)
{
  uint_lanes from = choose(wanted, at, (uint_lanes)0u) * 2u;
  impulse_sum sum = {xyz(load_float4(partial, from)), xyz(load_float4(partial, from + 1u))};
  return sum;
}

/* The first term starts the sum. */
SHARED impulse_sum add_term(impulse_sum sum, impulse_sum term, mask wanted, uint k)
{
  impulse_sum more = {add(sum.linear, term.linear), add(sum.angular, term.angular)};
  if (k == 0u) more = term;
  impulse_sum result = {choose3(wanted, more.linear, sum.linear), choose3(wanted, more.angular, sum.angular)};
  return result;
}

/* The sum of the entries of a body, of which there are `count` from `start` on. trees: whether the sums of long lists
 * have been computed. */
SHARED impulse_sum sum_of_entries(GLOBAL const uint *entries, GLOBAL const float4 *impulses,
                                  GLOBAL const float4 *partial, uint stride, uint_lanes start, uint_lanes count,
                                  uint trees)
{
  mask long_list = (count > (uint_lanes)SPLIT_DIRECT) & ((uint_lanes)trees != (uint_lanes)0u);
  uint_lanes direct = choose(long_list, (uint_lanes)0u, count);
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  impulse_sum sum = {none, none};
  for (uint k = 0; any_of((uint_lanes)k < direct); ++k) {
    mask more = (uint_lanes)k < direct;
    sum = add_term(sum, load_entry(entries, impulses, stride, more, start + (uint_lanes)k), more, k);
  }
  if (!any_of(long_list)) return sum;
  uint_lanes sums = choose(long_list, (count + (uint_lanes)(SPLIT_CHUNK * SPLIT_CHUNK - 1u)) >> 10u, (uint_lanes)0u);
  for (uint k = 0; any_of((uint_lanes)k < sums); ++k) {
    mask more = (uint_lanes)k < sums;
    sum = add_term(sum, load_partial(partial, more, SPLIT_FIRST_SUM(start) + (uint_lanes)(k * SPLIT_CHUNK)), more, k);
  }
  return sum;
}

/* Pushes the whole body. */
SHARED void push_whole(GLOBAL const Parameters *parameters, GLOBAL const float4 *solver_inertia,
                       GLOBAL float4 *solver_velocity, impulse_sum sum, item_index i)
{
  spatial_velocity m = load_velocity(solver_velocity, i);
  real locks;
  symmetric3 inertia = load_inertia_and_locks(parameters, solver_inertia, i, m, &locks);
  m.linear = pushed(m.linear, locks, sum.linear, m.inverse_mass);
  m.angular = add(m.angular, symmetric_times(inertia, sum.angular));
  mask changed = is_nonzero(sum.linear) | is_nonzero(sum.angular); /* adding 0 would turn -0 into +0 */
  store_velocity_if(changed & (m.inverse_mass > R(0.0)), solver_velocity, i, m);
}

#ifndef TANDEM_LANES /* ITEM kernels take one item at a time */
/* A moving floor may carry ten thousand boxes, which would keep one item busy for very long. Items therefore add runs
 * of SPLIT_CHUNK entries of its list, other items add runs of such sums, and split_apply adds the few that are left:
 *
 *   entries of a body   | 32 | 32 | 32 | .. | 32 |  ..          split_sum:   a sum at the first of each run
 *   sums                  s0   s1   s2  ..   s31  | s32 ..      split_join:  s0 = s0 + .. + s31
 *
 * Runs are counted from the start of the body's own list. Of joints, split_sum_joints and split_join_joints do the
 * same. */

/* The run of a long list that starts at an entry. */
typedef struct {
  uint starts, place, length;
} list_run;

/* Of the list of a body. every: the number of entries between the starts of two runs. Lengths are in units of `unit`
 * entries. */
SHARED list_run run_of_list(GLOBAL const uint *starts, uint body, uint every, uint unit, uint i)
{
  list_run run = {0u, 0u, 0u};
  uint start = starts[body], entries = starts[body + 1u] - start, rank = i - start;
  if (entries <= SPLIT_DIRECT || rank % every != 0u) return run;
  uint left = (entries - rank + unit - 1u) / unit;
  run.starts = 1u;
  run.place = SPLIT_FIRST_SUM(start) + rank / SPLIT_CHUNK;
  run.length = left < SPLIT_CHUNK ? left : SPLIT_CHUNK;
  return run;
}

SHARED void store_partial(GLOBAL float4 *partial, uint place, impulse_sum sum)
{
  store_float4(partial, 2u * place, extend(sum.linear, R(0.0)));
  store_float4(partial, 2u * place + 1u, extend(sum.angular, R(0.0)));
}

/* The sum of a run of entries, and that of a run of such sums. */
SHARED void sum_run(list_run run, GLOBAL const uint *entries, GLOBAL const float4 *impulses, uint stride,
                    GLOBAL float4 *partial, uint i)
{
  impulse_sum sum = load_entry(entries, impulses, stride, 1, i);
  for (uint k = 1; k < run.length; ++k) sum = add_term(sum, load_entry(entries, impulses, stride, 1, i + k), 1, k);
  store_partial(partial, run.place, sum);
}

SHARED void join_run(list_run run, GLOBAL float4 *partial)
{
  impulse_sum sum = load_partial(partial, 1, run.place);
  for (uint k = 1; k < run.length; ++k) sum = add_term(sum, load_partial(partial, 1, run.place + k), 1, k);
  store_partial(partial, run.place, sum);
}
#endif

#endif
