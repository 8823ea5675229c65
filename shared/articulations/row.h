/* row.h - rows of joints that push links: an impulse along a row pushes b, and its opposite pushes a. */
#ifndef TANDEM_SHARED_ARTICULATIONS_ROW_H
#define TANDEM_SHARED_ARTICULATIONS_ROW_H

#include "shared/articulations/side.h"

typedef struct {
  pushed_side a, b;
  mask is_within; /* both are links of one tree */
} pushed_pair;

SHARED pushed_pair pushed_pair_of(pushed_side a, pushed_side b)
{
  pushed_pair p = {a, b, a.is_link & b.is_link & (a.tree.number == b.tree.number)};
  return p;
}

/* The impulse that a row gives to b; a gets the opposite of the other, which is at its own arm. */
typedef struct {
  spatial_force a, b;
} row_of_pair;

SHARED row_of_pair row_along(vec3 arm_a, vec3 arm_b, vec3 direction)
{
  row_of_pair r = {impulse_at(arm_a, direction), impulse_at(arm_b, direction)};
  return r;
}
SHARED row_of_pair row_about(vec3 axis)
{
  row_of_pair r = {twist_about(axis), twist_about(axis)};
  return r;
}
SHARED row_of_pair add_rows(row_of_pair r, row_of_pair s)
{
  row_of_pair sum = {add_forces(r.a, s.a), add_forces(r.b, s.b)};
  return sum;
}
SHARED row_of_pair scaled_row(row_of_pair r, real by)
{
  row_of_pair scaled = {scaled_force(r.a, by), scaled_force(r.b, by)};
  return scaled;
}

/* How fast the pair moves along `second` by an impulse along `first`, if the sides were not of one tree. */
SHARED real response_apart(const pushed_pair *p, row_of_pair first, row_of_pair second)
{
  return response_of_side_of_pair(&p->a, first.a, second.a) + response_of_side_of_pair(&p->b, first.b, second.b);
}
SHARED real speed_of_row(const pushed_pair *p, row_of_pair r)
{
  return power_of(r.b, p->b.velocity) - power_of(r.a, p->a.velocity);
}

SHARED void push_row(pushed_pair *p, row_of_pair r, real impulse)
{
  push_side_of_pair(&p->a, scaled_force(r.a, -impulse));
  push_side_of_pair(&p->b, scaled_force(r.b, impulse));
}

/* Within one tree each side has what the other one pushed it with. */
CALLED void push_each_other_if(mask wanted, pushed_pair *p)
{
  mask moved = wanted & p->is_within & (is_push(p->a.pushed) | is_push(p->b.pushed));
  if (!any_of(moved)) return;
  push_into_tree_if(moved, &p->a);
  push_into_tree_if(moved, &p->b);
  p->a.velocity = choose_motion(moved, pending_velocity_if(moved, &p->a.tree, p->a.k), p->a.velocity);
  p->b.velocity = choose_motion(moved, pending_velocity_if(moved, &p->b.tree, p->b.k), p->b.velocity);
}

/* The velocities and pushes of one side, and those of another. */
SHARED pushed_side choose_side(mask m, pushed_side a, pushed_side b)
{
  b.velocity = choose_motion(m, a.velocity, b.velocity);
  b.pushed = choose_force(m, a.pushed, b.pushed);
  return b;
}

SHARED void store_pair(pushed_pair *p, GLOBAL float4 *solver_velocity)
{
  store_side_of_pair(&p->a, solver_velocity);
  store_side_of_pair(&p->b, solver_velocity);
}

SHARED void add_warm_start_of_pair(const pushed_pair *p, row_of_pair impulses, real inverse_substep,
                                   GLOBAL float4 *warm_start_impulse)
{
  add_warm_start_of_side(&p->a, scaled_force(impulses.a, R(-1.0)), inverse_substep, warm_start_impulse);
  add_warm_start_of_side(&p->b, impulses.b, inverse_substep, warm_start_impulse);
}

#endif
