/* couplings.h - gears, racks, pulleys and mimics between two hinges or sliders of one tree.
 *
 *   row = of_a q_a + of_b q_b - offset      0, but for whole periods; of a rope at least 0
 *
 *          palm           The coordinates are those of the tree, so the row pushes joint a by of_a and joint b by of_b,
 *         /    \          and the tree answers both at once:
 *     a  o      o  b
 *        |      |         a unit impulse of the row  ->  what is pending (respond.h)  ->  the change of the row
 *      finger  finger
 *
 * That change is the exact response of the row. What is pending, times the impulse, is settled then, so each coupling
 * sees all that those before it have done. An item is a tree, which solves its couplings one after another, after the
 * rows of its joints. Kinds are those of joints/couplings.h, which are between bodies and as soft as joints; since the
 * response here is exact, a row can be nearly rigid.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_COUPLINGS_H
#define TANDEM_SHARED_ARTICULATIONS_COUPLINGS_H

#include "shared/articulations/bodies.h"
#include "shared/joints/couplings.h"

typedef struct {
  mask acts;
  uint_lanes number; /* of the coupling */
  tree_link a, b;
  vec4 row; /* of_a, of_b, offset, period */
} tree_coupling;

SHARED tree_coupling load_tree_coupling(mask acts, const articulation *t, read_tree_couplings couplings,
                                        uint_lanes number)
{
  tree_coupling c;
  c.acts = acts;
  c.number = choose(acts, number, (uint_lanes)0u);
  c.a = tree_link_of(t, load_uint(couplings.link, 2u * c.number));
  c.b = tree_link_of(t, load_uint(couplings.link, 2u * c.number + 1u));
  c.row = load_float4(couplings.row, c.number);
  return c;
}

SHARED real sum_of_coupling(const tree_coupling *c, real of_a, real of_b) { return c->row.x * of_a + c->row.y * of_b; }

/* --- how the tree answers ------------------------------------------------------------------------------------- */
/* An impulse of a joint of one degree of freedom becomes pending. */
SHARED void push_joint_if(mask wanted, const articulation *t, tree_link l, real impulse)
{
  factored_joint f = load_factored_joint(t, l);
  joint_share s = share_of_joint(t, l, &f, no_force(), make_vec3(impulse, R(0.0), R(0.0)));
  spatial_force pending = {s.pending, zero3()};
  add_to_force(wanted, t, l.k, (uint)WORK_PENDING, pending);
  push_link_if(wanted & !l.is_root, t, l.parent, &s.rest);
}

/* How what is pending changes the velocity of the joint. */
SHARED real pending_change_of_joint(mask wanted, const articulation *t, tree_link l)
{
  spatial_motion parent = pending_change(t, choose(wanted & !l.is_root, (uint_lanes)l.parent, t->links));
  factored_joint f = load_factored_joint(t, l);
  return link_change(t, l, &f, load_pending(t, l.k), choose_motion(l.is_root, no_motion(), parent)).joint.x;
}

/* Nothing is pending before; what a unit impulse of the row does is pending then. In statements, because each change
 * notes a path and compilers order the arguments of a call as they like. */
SHARED real response_of_coupling(const articulation *t, const tree_coupling *c)
{
  push_joint_if(c->acts, t, c->a, c->row.x);
  push_joint_if(c->acts, t, c->b, c->row.y);
  real of_a = pending_change_of_joint(c->acts, t, c->a);
  real of_b = pending_change_of_joint(c->acts, t, c->b);
  return sum_of_coupling(c, of_a, of_b);
}

CALLED void scale_pending_if(mask wanted, const articulation *tree, real factor)
{
  articulation own = *tree;
  const articulation *t = &own;
  for (uint k = 0u; k < t->most_links; ++k) {
    tree_link l = tree_link_of(t, k);
    spatial_force pending = scaled_force(load_pending(t, l.k), factor);
    store_force(wanted & l.exists, t, l.k, (uint)WORK_PENDING, pending);
  }
}

/* --- one coupling --------------------------------------------------------------------------------------------- */
SHARED axis_row row_of_tree_coupling(const articulation *t, const tree_coupling *c)
{
  axis_row r;
  r.speed = sum_of_coupling(c, load_state(t, c->a.k, (uint)STATE_JOINT_VELOCITY).x,
                            load_state(t, c->b.k, (uint)STATE_JOINT_VELOCITY).x);
  r.response = r.shared_response = response_of_coupling(t, c);
  r.mass = inverse_if_positive(r.response);
  r.leak = R(1.0);
  r.crowded = never_crowded();
  return r;
}

SHARED real value_of_tree_coupling(const articulation *t, const tree_coupling *c)
{
  real sum = sum_of_coupling(c, load_state(t, c->a.k, (uint)STATE_JOINT_POSITION).x,
                             load_state(t, c->b.k, (uint)STATE_JOINT_POSITION).x);
  return coupling_value(sum - c->row.z, c->row.w);
}

/* Of the response: what keeps the impulses of couplings that contradict each other from growing without end. A load
 * that sags by this share of a bias sinks a light finger by micrometres. */
#define COUPLING_COMPLIANCE R(1e-3)

/* open: above 0 it is ahead, of a row that is one-sided. */
SHARED real change_of_coupling(GLOBAL const Parameters *parameters, const axis_row *r, mask one_sided, real open,
                               real old, uint pass)
{
  if (pass != (uint)PASS_BIASED)
    return choose(one_sided, stop_change(parameters, r, open, old, pass), hold_change(parameters, r, open, old, pass));
  mask ahead = one_sided & (open > R(0.0));
  real push = parameters->joint_bias_rate * open;
  real bias = choose(ahead, open * parameters->inverse_substep, push * share_of_closing(push));
  real compliance = choose(ahead, (real)R(0.0), (real)COUPLING_COMPLIANCE);
  return R(0.0) - (r->mass * (r->speed + bias) + compliance * old) / (R(1.0) + compliance);
}

SHARED void solve_tree_coupling(GLOBAL const Parameters *parameters, const articulation *t, read_tree_couplings given,
                                const tree_coupling *c, GLOBAL memory_real *impulse, uint pass)
{
  axis_row r = row_of_tree_coupling(t, c);
  mask one_sided = (load_uint(given.kind, c->number) & (uint)COUPLING_ONE_SIDED) != 0u;
  real old = load_real(impulse, c->number);
  real now = old + change_of_coupling(parameters, &r, one_sided, value_of_tree_coupling(t, c), old, pass);
  now = choose(one_sided, maximum(now, R(0.0)), now);
  store_listed_real_if(c->acts, impulse, c->number, now);
  scale_pending_if(c->acts, t, now - old);
  settle_tree_if(c->acts, t);
}

/* Those that share joints, as of a finger whose joints follow each other, need more than one sweep. */
#define COUPLING_SWEEPS 8u

SHARED void solve_couplings_of_tree(GLOBAL const Parameters *parameters, const articulation *t,
                                    read_tree_couplings given, uint_lanes first, uint_lanes count,
                                    GLOBAL memory_real *impulse, uint pass)
{
  for (uint sweep = 0u; sweep < COUPLING_SWEEPS; ++sweep) {
    uint_lanes in_sweep = choose((count > 1u) | (count == (uint_lanes)sweep + 1u), count, (uint_lanes)0u);
    for (uint n = 0u; any_of((uint_lanes)n < in_sweep); ++n) {
      tree_coupling c = load_tree_coupling((uint_lanes)n < in_sweep, t, given, first + n);
      solve_tree_coupling(parameters, t, given, &c, impulse, pass);
    }
  }
}

/* --- from substep to substep ---------------------------------------------------------------------------------- */
/* Impulses start the next substep as forces of the joints, which nothing else has in a step. */
SHARED void set_joint_force_if(mask wanted, const articulation *t, tree_link l, real force)
{
  store_state(wanted, t, l.k, (uint)STATE_JOINT_FORCE, make_vec4(force, R(0.0), R(0.0), R(0.0)));
}
SHARED void clear_forces_of_coupling(const articulation *t, const tree_coupling *c)
{
  set_joint_force_if(c->acts, t, c->a, R(0.0));
  set_joint_force_if(c->acts, t, c->b, R(0.0));
}
SHARED void add_forces_of_coupling(const articulation *t, const tree_coupling *c, real force)
{
  set_joint_force_if(c->acts, t, c->a, load_state(t, c->a.k, (uint)STATE_JOINT_FORCE).x + c->row.x * force);
  set_joint_force_if(c->acts, t, c->b, load_state(t, c->b.k, (uint)STATE_JOINT_FORCE).x + c->row.y * force);
}
SHARED void keep_share_of_impulse(const tree_coupling *c, real share, GLOBAL memory_real *impulse)
{
  store_listed_real_if(c->acts, impulse, c->number, share * load_real(impulse, c->number));
}

/* What the next substep starts with: of one coupling all, of n the n-th part. With all of it, eight sliders that follow
 * one of their mass gained energy without end, because what is given again and what the sweeps find add up. */
SHARED void gather_couplings_of_tree(GLOBAL const Parameters *parameters, const articulation *t,
                                     read_tree_couplings given, uint_lanes first, uint_lanes count,
                                     GLOBAL memory_real *impulse, uint pass)
{
  real share = R(1.0) / to_real(choose(count > 0u, count, (uint_lanes)1u));
  if (pass == (uint)PASS_WARM_STARTING) share = share * parameters->warm_start_scale;
  for (uint n = 0u; any_of((uint_lanes)n < count); ++n) {
    tree_coupling c = load_tree_coupling((uint_lanes)n < count, t, given, first + n);
    keep_share_of_impulse(&c, share, impulse);
    clear_forces_of_coupling(t, &c);
  }
  for (uint n = 0u; any_of((uint_lanes)n < count); ++n) {
    tree_coupling c = load_tree_coupling((uint_lanes)n < count, t, given, first + n);
    add_forces_of_coupling(t, &c, load_real(impulse, c.number) * parameters->inverse_substep);
  }
}

/* --- kernel --------------------------------------------------------------------------------------------------- */
/* An item is a tree. */
SHARED void solve_tree_couplings_item(GLOBAL const Parameters *parameters, read_links links,
                                      read_tree_couplings couplings, write_link_states states,
                                      GLOBAL memory_real *impulse, GLOBAL float4 *solver_velocity, uint pass,
                                      item_index i)
{
  uint_lanes tree = i, first = load_uint(couplings.of_tree, 2u * tree),
             count = load_uint(couplings.of_tree, 2u * tree + 1u);
  articulation t = articulation_in_pass(links, states, tree, pass);
  count = choose(has_links(&t), count, (uint_lanes)0u);
  if (!any_of(count > 0u)) return;
  if (pass != (uint)PASS_WARM_STARTING) {
    solve_couplings_of_tree(parameters, &t, couplings, first, count, impulse, kind_of_pass(pass));
    write_velocities(links, &t, solver_velocity);
  }
  if (pass == (uint)PASS_RELAXING || pass == (uint)PASS_WARM_STARTING)
    gather_couplings_of_tree(parameters, &t, couplings, first, count, impulse, pass);
}

#endif
