/* side.h - one body of a contact or of a joint that pushes a link: the link of a tree, or any other body. Sides of
 * contacts that are solved by the table of paths (tree_contacts.h) have no inverse inertia and are not pushed.
 *
 * Both answer to an impulse with a 6x6 inverse inertia (spatial.h). That of a link is its inverse inertia within the
 * tree (link_inertia.h), so the effective mass of a row is exact, whatever the tree is and wherever it is held. What
 * rows push with is summed up, and goes through the tree once the contact or the joint is solved.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_SIDE_H
#define TANDEM_SHARED_ARTICULATIONS_SIDE_H

#include "shared/articulations/bodies.h"
#include "shared/solve/pass.h"

typedef struct {
  uint_lanes body, k;
  mask is_link;
  mask answers;            /* to impulses: a link, or a body that can move */
  articulation tree;       /* of a body that is no link, one without links */
  spatial_velocity record; /* of the body in solver_velocity; of a link its masses count alone */
  spatial_motion velocity;
  symmetric6 inverse;
  spatial_force pushed; /* since the velocity was loaded */
} pushed_side;

/* The motion of a link with what is pending in its tree; where it is not wanted, without. */
SHARED spatial_motion pending_velocity_if(mask wanted, const articulation *t, uint_lanes k)
{
  spatial_motion change = pending_change(t, choose(wanted, k, t->links));
  return add_motions(load_motion(t, k, (uint)WORK_VELOCITY), change);
}

/* Kept as inverse_times wants it: `first` takes forces to linear motion. */
SHARED symmetric6 inverse_of_single_body(spatial_velocity m, symmetric3 inertia, uint_lanes locks)
{
  vec3 free = without_locked_axes(make_vec3(m.inverse_mass, m.inverse_mass, m.inverse_mass), locks);
  symmetric6 s = zero_symmetric6();
  s.first.xx = free.x;
  s.first.yy = free.y;
  s.first.zz = free.z;
  s.second = inertia;
  return s;
}

/* As if the body were no link. */
SHARED pushed_side single_body_side(read_links links, write_link_states states, uint_lanes body,
                                    spatial_velocity record, symmetric3 inertia, real locks)
{
  pushed_side s;
  s.body = body;
  s.k = (uint_lanes)0u;
  s.record = record;
  s.pushed = no_force();
  s.tree = articulation_at(links, states, (uint_lanes)0u);
  s.tree.links = (uint_lanes)0u;
  s.is_link = has_links(&s.tree);
  s.answers = record.inverse_mass > R(0.0);
  s.velocity.linear = record.linear;
  s.velocity.angular = record.angular;
  s.inverse = inverse_of_single_body(record, inertia, to_uint(locks));
  return s;
}

/* in_table: whether the body is a link. A link of a tree in quarantine rests as other bodies there. record, inertia,
 * locks: as the contact or the joint has loaded them; they move a body that is no link. It notes the path to the link
 * (respond.h), so both sides of a pair are loaded one after the other, in statements: compilers order the arguments of
 * a call as they like. */
SHARED pushed_side pushed_side_of(mask in_table, read_links links, write_link_states states, uint_lanes body,
                                  spatial_velocity record, symmetric3 inertia, real locks, uint pass)
{
  pushed_side s = single_body_side(links, states, body, record, inertia, locks);
  if (!any_of(in_table)) return s;
  s.tree = articulation_at(links, states, choose(in_table, articulation_of_body(links.of_body, body), (uint_lanes)0u));
  s.is_link = in_table & has_links(&s.tree);
  s.tree.links = choose(s.is_link, s.tree.links, (uint_lanes)0u);
  s.answers = s.answers | s.is_link;
  s.k = choose(s.is_link, load_uint(links.of_body, LINK_WORDS * body + 2u), (uint_lanes)0u);
  if (pass == (uint)PASS_WARM_STARTING) return s; /* adds to what pushes, whatever the velocity */
  s.velocity = choose_motion(s.is_link, pending_velocity_if(s.is_link, &s.tree, s.k), s.velocity);
  s.inverse = choose_symmetric6(s.is_link, load_symmetric6(&s.tree, s.k), s.inverse);
  return s;
}

/* An impulse along a direction at the end of an arm, or of the pair of impulses that twists about it. */
SHARED spatial_force impulse_at(vec3 arm, vec3 impulse)
{
  spatial_force f = {cross3(arm, impulse), impulse};
  return f;
}
SHARED spatial_force twist_about(vec3 moment)
{
  spatial_force f = {moment, zero3()};
  return f;
}

/* How fast the side moves along `second` by the impulse `first`. */
SHARED real response_of_side_of_pair(const pushed_side *s, spatial_force first, spatial_force second)
{
  if (!any_of(s->answers)) return R(0.0);
  return choose(s->answers, power_of(second, inverse_times(&s->inverse, first)), (real)R(0.0));
}

/* The answer of a body that has none is not computed, nor added: -0 + 0 is +0, and the bits would depend on what shares
 * the lanes. */
SHARED void push_side_of_pair(pushed_side *s, spatial_force impulse)
{
  if (!any_of(s->answers)) return;
  spatial_motion velocity = add_motions(s->velocity, inverse_times(&s->inverse, impulse));
  s->velocity = choose_motion(s->answers, velocity, s->velocity);
  s->pushed = choose_force(s->answers, add_forces(s->pushed, impulse), s->pushed);
}

SHARED mask is_push(spatial_force f) { return is_nonzero(f.force) | is_nonzero(f.moment); }

/* What a link was pushed with goes through its tree; then its velocity is that of the tree. */
CALLED void push_into_tree_if(mask wanted, pushed_side *s)
{
  mask pushes = wanted & s->is_link & is_push(s->pushed);
  if (any_of(pushes)) {
    push_link_if(pushes, &s->tree, s->k, &s->pushed);
    note_pushed_if(pushes, &s->tree, R(1.0));
  }
  s->pushed = choose_force(wanted & s->is_link, no_force(), s->pushed);
}

CALLED void store_side_of_pair(pushed_side *s, GLOBAL float4 *solver_velocity)
{
  push_into_tree_if(s->is_link, s);
  mask moves = (s->record.inverse_mass > R(0.0)) & !s->is_link;
  s->record.linear = s->velocity.linear;
  s->record.angular = s->velocity.angular;
  store_velocity_if(moves, solver_velocity, s->body, s->record);
}

/* Adds to what the next substep starts with; of a link it is a force. */
SHARED void add_warm_start_of_side(const pushed_side *s, spatial_force impulse, real inverse_substep,
                                   GLOBAL float4 *warm_start_impulse)
{
  if (any_of(s->is_link)) {
    note_pushed_if(s->is_link & is_push(impulse), &s->tree, R(1.0));
    vec3 force = add_scaled(xyz(load_state(&s->tree, s->k, (uint)STATE_FORCE)), impulse.force, inverse_substep);
    vec3 moment = add_scaled(xyz(load_state(&s->tree, s->k, (uint)STATE_MOMENT)), impulse.moment, inverse_substep);
    store_state(s->is_link, &s->tree, s->k, (uint)STATE_FORCE, extend(force, R(0.0)));
    store_state(s->is_link, &s->tree, s->k, (uint)STATE_MOMENT, extend(moment, R(0.0)));
  }
  mask moves = (s->record.inverse_mass > R(0.0)) & !s->is_link;
  if (!any_of(moves)) return;
  uint_lanes row = s->body * 2u;
  vec3 linear = add(xyz(load_float4(warm_start_impulse, row)), impulse.force);
  vec3 angular = add(xyz(load_float4(warm_start_impulse, row + 1u)), impulse.moment);
  store_float4_if(moves, warm_start_impulse, row, extend(linear, R(0.0)));
  store_float4_if(moves, warm_start_impulse, row + 1u, extend(angular, R(0.0)));
}

#endif
