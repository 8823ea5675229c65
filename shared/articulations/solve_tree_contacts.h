/* solve_tree_contacts.h - the contacts of a tree that has them for itself, one after another: friction at the centre,
 * then the normals as a block, as solve/contact.h does.
 *
 *     read      the rows of the contact in the freedoms of the tree, and their terms (contact_rows.h)
 *     solve     speed of a row = that before the pass + its projection . z
 *     push      z += projection * impulse, so that the next contact sees what this one did
 *
 * z becomes pending at the joints of the tree when all of its contacts are solved (path.h).
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_SOLVE_TREE_CONTACTS_H
#define TANDEM_SHARED_ARTICULATIONS_SOLVE_TREE_CONTACTS_H

#include "shared/articulations/contact_rows.h"

/* A contact, where its rows stand (contact_places), and these, read once. freedom: those that move the contact of any
 * lane. */
typedef struct {
  mask wanted;
  uint_lanes i, at;
  uint stride, rows;
  freedom_set moved;
  uint freedom[TREE_FREEDOMS];
  projected_rows row[TREE_FREEDOMS];
} projected_contact;

SHARED vec4 load_term(const projected_contact *c, read_contact_freedoms f, uint term)
{
  return load_float4(f.term, c->at + c->stride * term);
}

/* What does not move the contact is not used. */
SHARED projected_rows load_projection(const projected_contact *c, read_contact_freedoms f, uint n)
{
  uint_lanes row = c->at + c->stride * (2u * c->freedom[n]);
  projected_rows p = {load_float4(f.row, row), load_float4(f.row, row + c->stride)};
  return p;
}

/* Rows are read by some at once, so that a device waits for their memory once. */
SHARED void load_projections(projected_contact *c, read_contact_freedoms f)
{
  for (uint first = 0u; first < c->rows; first += PATH_CHUNK) {
    projected_rows p[PATH_CHUNK];
    for (uint n = 0u; n < PATH_CHUNK; ++n)
      if (first + n < c->rows) p[n] = load_projection(c, f, first + n);
    for (uint n = 0u; n < PATH_CHUNK; ++n)
      if (first + n < c->rows) c->row[first + n] = p[n];
  }
}

SHARED void load_projected_contact(mask wanted, read_contact_freedoms f, uint stride, uint_lanes i, uint_lanes at,
                                   projected_contact *c)
{
  c->wanted = wanted;
  c->i = i;
  c->at = at;
  c->stride = stride;
  c->rows = 0u;
  c->moved.low = choose(wanted, load_uint(f.freedom, at), (uint_lanes)0u);
  c->moved.high = choose(wanted, load_uint(f.freedom, at + stride), (uint_lanes)0u);
  for (freedoms_left left = freedoms_of_any(c->moved); any_left(&left);) c->freedom[c->rows++] = next_freedom(&left);
  load_projections(c, f);
}

SHARED vec4 no_speeds(void) { return make_vec4(R(0.0), R(0.0), R(0.0), R(0.0)); }
SHARED vec4 add_scaled4(vec4 sum, vec4 v, real factor)
{
  return make_vec4(sum.x + factor * v.x, sum.y + factor * v.y, sum.z + factor * v.z, sum.w + factor * v.w);
}
SHARED real dot4(vec4 a, vec4 b) { return (a.x * b.x + a.y * b.y) + (a.z * b.z + a.w * b.w); }

/* Row n of the normals, or of both directions of friction and the twist. */
enum { ROWS_OF_NORMALS, ROWS_OF_FRICTION };
SHARED vec4 row_of_kind(const projected_contact *c, uint kind, uint n)
{
  return kind == ROWS_OF_NORMALS ? c->row[n].normals : c->row[n].others;
}

/* How what has pushed the freedoms moves the rows. */
SHARED vec4 speeds_of_freedoms(const projected_contact *c, uint kind, const tree_freedoms *z)
{
  vec4 speeds = no_speeds();
  for (uint n = 0u; n < c->rows; ++n) {
    vec4 moved = add_scaled4(speeds, row_of_kind(c, kind, n), z->change[c->freedom[n]]);
    speeds = choose4(has_freedom(c->moved, c->freedom[n]), moved, speeds);
  }
  return speeds;
}

SHARED void push_freedoms_if(mask pushes, const projected_contact *c, uint kind, tree_freedoms *z, vec4 impulses)
{
  if (!any_of(pushes)) return;
  for (uint n = 0u; n < c->rows; ++n) {
    uint freedom = c->freedom[n];
    real change = z->change[freedom] + dot4(row_of_kind(c, kind, n), impulses);
    z->change[freedom] = choose(pushes & has_freedom(c->moved, freedom), change, z->change[freedom]);
  }
}

/* --- friction ------------------------------------------------------------------------------------------------- */
/* impulse: along the tangents and about the normal; the radius of the patch. speeds: first, second, twist. */
SHARED vec4 friction_after(vec4 impulse, vec4 speeds, vec4 terms, real limit)
{
  real twist_limit = limit * impulse.w;
  real twist = clamped(impulse.z - terms.z * speeds.z, -twist_limit, twist_limit), turned = twist - impulse.z;
  real x = impulse.x - terms.w * (speeds.x + terms.x * turned), y = impulse.y - terms.w * (speeds.y + terms.y * turned);
  real shrink = share_within_cone(x, y, limit);
  return make_vec4(x * shrink, y * shrink, twist, impulse.w);
}

SHARED mask is_nonzero4(vec4 v) { return (v.x != R(0.0)) | (v.y != R(0.0)) | (v.z != R(0.0)) | (v.w != R(0.0)); }

SHARED vec4 solve_tree_friction_if(mask rough, const projected_contact *c, read_contact_freedoms f, tree_freedoms *z,
                                   vec4 friction, real limit, mask *pushed)
{
  if (!any_of(rough)) return friction;
  vec4 speeds = add4(load_term(c, f, CONTACT_TERM_SPEEDS), speeds_of_freedoms(c, ROWS_OF_FRICTION, z));
  vec4 solved = friction_after(friction, speeds, load_term(c, f, CONTACT_TERM_FRICTION), limit);
  vec4 change = change_between(friction, solved);
  mask pushes = rough & is_nonzero4(change);
  push_freedoms_if(pushes, c, ROWS_OF_FRICTION, z, change);
  *pushed = *pushed | pushes;
  return choose4(rough, solved, friction);
}

/* --- normals -------------------------------------------------------------------------------------------------- */
/* last_coupled: of 13 and 23; then as masses see them. */
typedef struct {
  vec4 speed, impulse, mass, separation, squares, coupled, soft_coupled, last_coupled;
} tree_normals;

/* A single point is coupled to no other one. */
SHARED tree_normals load_tree_normals(const projected_contact *c, read_contact_freedoms f, const tree_freedoms *z,
                                      vec4 impulse)
{
  tree_normals s;
  s.speed = add4(load_term(c, f, CONTACT_TERM_NORMAL_SPEEDS), speeds_of_freedoms(c, ROWS_OF_NORMALS, z));
  s.impulse = impulse;
  s.mass = load_term(c, f, CONTACT_TERM_MASSES);
  s.separation = load_term(c, f, CONTACT_TERM_SEPARATIONS);
  s.squares = load_term(c, f, CONTACT_TERM_SQUARES);
  s.coupled = s.soft_coupled = s.last_coupled = no_speeds();
  if (!any_of((s.mass.y > R(0.0)) | (s.mass.z > R(0.0)) | (s.mass.w > R(0.0)))) return s;
  s.coupled = load_term(c, f, CONTACT_TERM_COUPLED);
  s.soft_coupled = load_term(c, f, CONTACT_TERM_SOFT_COUPLED);
  s.last_coupled = load_term(c, f, CONTACT_TERM_LAST_COUPLED);
  return s;
}

/* How fast impulses along the normals move their points. Sums are such that the mirrored points of a mirrored contact
 * have the same bits, here and below. */
SHARED vec4 speeds_of_impulses(const tree_normals *s, vec4 p)
{
  vec4 k = s->coupled;
  real yw = s->last_coupled.x, zw = s->last_coupled.y;
  return make_vec4(s->squares.x * p.x + (k.x * p.y + (k.y * p.z + k.z * p.w)),
                   s->squares.y * p.y + (k.x * p.x + (k.w * p.z + yw * p.w)),
                   s->squares.z * p.z + (zw * p.w + (k.y * p.x + k.w * p.y)),
                   s->squares.w * p.w + (zw * p.z + (k.z * p.x + yw * p.y)));
}

/* Twice the energy of impulses along the normals, as masses see it. answers: of each point alone. */
SHARED real energy_of_impulses(const tree_normals *s, vec4 answers, vec4 p)
{
  vec4 k = s->soft_coupled;
  real yw = s->last_coupled.z, zw = s->last_coupled.w;
  real alone =
      ((answers.x * p.x) * p.x + (answers.y * p.y) * p.y) + ((answers.z * p.z) * p.z + (answers.w * p.w) * p.w);
  real coupled = (k.x * (p.x * p.y) + zw * (p.z * p.w)) +
                 ((k.y * (p.x * p.z) + yw * (p.y * p.w)) + (k.z * (p.x * p.w) + k.w * (p.y * p.z)));
  return alone + R(2.0) * coupled;
}

SHARED real change_of_normal(real mass, real target, real impulse)
{
  return choose(mass > R(0.0), maximum(target, R(0.0)) - impulse, (real)R(0.0));
}
SHARED real pulls_least(vec4 v) { return minimum(minimum(v.x, v.y), minimum(v.z, v.w)); }

/* block_solve_normals of solve/contact.h: all points move towards their targets along one direction. */
SHARED void block_solve_tree_normals(tree_normals *s, vec4 target)
{
  vec4 m = s->mass, before = s->impulse;
  vec4 change = make_vec4(change_of_normal(m.x, target.x, before.x), change_of_normal(m.y, target.y, before.y),
                          change_of_normal(m.z, target.z, before.z), change_of_normal(m.w, target.w, before.w));
  vec4 answers = make_vec4(inverse_or_zero(m.x), inverse_or_zero(m.y), inverse_or_zero(m.z), inverse_or_zero(m.w));
  vec4 wanted = change_between(before, target);
  real own = (answers.x * change.x) * wanted.x + (answers.y * change.y) * wanted.y +
             ((answers.z * change.z) * wanted.z + (answers.w * change.w) * wanted.w);
  real whole = energy_of_impulses(s, answers, change);
  real share = minimum(own / choose(whole > R(0.0), whole, (real)R(1.0)), R(2.0));
  mask pulls = pulls_least(add_scaled4(before, change, share)) < R(0.0);
  share = choose(pulls, minimum(share, R(1.0)), share);
  s->impulse = add_scaled4(before, change, share);
  s->speed = add_scaled4(s->speed, speeds_of_impulses(s, change), share);
}

SHARED void solve_tree_normals(GLOBAL const Parameters *parameters, tree_normals *s, softness soft, real slop,
                               uint biased)
{
  real target[4];
  for (uint k = 0; k < 4u; ++k)
    target[k] = normal_impulse(parameters, soft, slop, component(s->separation, k), component(s->speed, k),
                               component(s->mass, k), component(s->impulse, k), biased);
  block_solve_tree_normals(s, make_vec4(target[0], target[1], target[2], target[3]));
}

/* Contacts of an impact have more rounds. */
SHARED void solve_rounds_of_tree_normals(GLOBAL const Parameters *parameters, tree_normals *s, softness soft, real slop,
                                         mask at_impact, uint biased)
{
  solve_tree_normals(parameters, s, soft, slop, biased);
  if (!any_of(at_impact)) return;
  vec4 once = s->impulse;
  for (uint round = 0; round < IMPACT_ROUNDS; ++round) solve_tree_normals(parameters, s, soft, slop, biased);
  s->impulse = choose4(at_impact, s->impulse, once);
}

/* Towards the target velocities of restitution, as apply_restitution_item of solve/contact.h. */
SHARED void bounce_tree_normals(tree_normals *s, vec4 target_velocity, vec4 highest)
{
  real wanted[4];
  for (uint k = 0; k < 4u; ++k) {
    real target = component(target_velocity, k), impulse = component(s->impulse, k);
    mask applies = (target >= R(0.0)) & (component(highest, k) > R(0.0));
    wanted[k] = choose(applies, impulse - component(s->mass, k) * (component(s->speed, k) - target), impulse);
  }
  block_solve_tree_normals(s, make_vec4(wanted[0], wanted[1], wanted[2], wanted[3]));
}

/* --- passes --------------------------------------------------------------------------------------------------- */
SHARED void push_by_normals_if(mask wanted, const projected_contact *c, tree_freedoms *z, vec4 before, vec4 after,
                               mask *pushed)
{
  vec4 change = change_between(before, after);
  mask pushes = wanted & is_nonzero4(change);
  push_freedoms_if(pushes, c, ROWS_OF_NORMALS, z, change);
  *pushed = *pushed | pushes;
}

/* pairs: the stride of planes of contacts. */
SHARED void solve_projected_contact(GLOBAL const Parameters *parameters, const projected_contact *c,
                                    read_contacts contacts, read_contact_freedoms f,
                                    GLOBAL const memory_real *constraint_slop, write_contact_impulses impulses,
                                    tree_freedoms *z, uint pairs, uint biased, mask *pushed)
{
  real packed = load_float4(contacts.normal, c->i).w, coefficient = friction_of(packed);
  vec4 before = load_float4(impulses.normal, c->i), friction = load_friction(parameters, impulses.friction, c->i);
  mask rough = c->wanted & (coefficient > R(0.0));
  if (!HAS_FEATURE(parameters, FRICTION)) rough = rough & !rough;
  real limit = coefficient * ((before.x + before.y) + (before.z + before.w));
  friction = solve_tree_friction_if(rough, c, f, z, friction, limit, pushed);
  if (HAS_FEATURE(parameters, FRICTION)) store_float4_if(rough, impulses.friction, c->i, friction);
  tree_normals s = load_tree_normals(c, f, z, before);
  softness soft = softness_against(parameters, load_term(c, f, CONTACT_TERM_SPEEDS).w > R(0.0));
  solve_rounds_of_tree_normals(parameters, &s, soft, load_real(constraint_slop, c->i), packed < R(0.0), biased);
  store_float4_if(c->wanted, impulses.normal, c->i, s.impulse);
  keep_highest_impulses_if(c->wanted, parameters, impulses.restitution, pairs, s.impulse, c->i);
  push_by_normals_if(c->wanted, c, z, before, s.impulse, pushed);
}

/* Contacts of which no point bounces stay as they are. */
SHARED void bounce_projected_contact(const projected_contact *c, read_contact_freedoms f,
                                     write_contact_impulses impulses, tree_freedoms *z, uint pairs, mask *pushed)
{
  vec4 target_velocity = load_float4(impulses.restitution, c->i),
       highest = load_float4(impulses.restitution, c->i + pairs);
  mask bounces = c->wanted & ((target_velocity.x >= R(0.0)) | (target_velocity.y >= R(0.0)) |
                              (target_velocity.z >= R(0.0)) | (target_velocity.w >= R(0.0)));
  if (!any_of(bounces)) return;
  vec4 before = load_float4(impulses.normal, c->i);
  tree_normals s = load_tree_normals(c, f, z, before);
  for (uint round = 0; round < RESTITUTION_ROUNDS; ++round) bounce_tree_normals(&s, target_velocity, highest);
  store_float4_if(bounces, impulses.normal, c->i, s.impulse);
  push_by_normals_if(bounces, c, z, before, s.impulse, pushed);
}

SHARED void end_moving_if(mask wanted, const articulation *t, const tree_freedoms *z, mask pushed)
{
  leave_pending_if(wanted, t, z);
  note_pushed_if(pushed, t, R(1.0));
}

/* An item is a tree. */
SHARED void solve_tree_contacts_item(GLOBAL const Parameters *parameters, read_contacts contacts,
                                     GLOBAL const memory_real *constraint_slop, read_links links,
                                     GLOBAL const uint *counts, read_contact_freedoms freedoms,
                                     write_link_states states, write_contact_impulses contact_impulses, uint pass,
                                     item_index i)
{
  uint_lanes tree = i, listed = load_uint(states.colors, TREE_COLOR_WORDS * tree + 3u);
  if (!any_of(listed > 0u)) return;
  articulation t = articulation_in_pass(links, states, tree, pass);
  listed = choose(has_links(&t), listed, (uint_lanes)0u);
  mask touches = listed > 0u, pushed = touches & !touches;
  uint pairs = planes_of(counts).stride, biased = kind_of_pass(pass) == (uint)PASS_BIASED ? 1u : 0u;
  contact_places places = places_of_contacts(counts);
  tree_freedoms z;
  begin_freedoms(&t, &z);
  for (uint n = 0u; any_of(n < listed); ++n) {
    mask wanted = n < listed;
    uint_lanes at = choose(wanted, load_uint(states.contact, TREE_COLORS * tree + n), (uint_lanes)0u), place = at;
    if (places.by_tree) place = place_by_tree(places, tree, (uint_lanes)n);
    projected_contact c;
    load_projected_contact(wanted, freedoms, places.stride, at, place, &c);
    if (pass == (uint)PASS_BOUNCING) bounce_projected_contact(&c, freedoms, contact_impulses, &z, pairs, &pushed);
    else
      solve_projected_contact(parameters, &c, contacts, freedoms, constraint_slop, contact_impulses, &z, pairs, biased,
                              &pushed);
  }
  end_moving_if(touches, &t, &z, pushed);
}

#endif
