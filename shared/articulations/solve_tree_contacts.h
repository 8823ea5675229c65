/* solve_tree_contacts.h - the contacts of a tree that has them for itself, one after another: friction at the centre,
 * then the normals as a block, as solve/soft_step.h does.
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

/* A contact, where its rows stand (contact_places), and what solving it needs besides its rows. A device reads that of
 * the next contact while it solves this one; a CPU reads terms where it needs them. */
typedef struct {
  mask wanted;
  uint_lanes i, at;
  freedom_set moved;
  real packed, slop; /* packed: the friction, as contacts have it */
  vec4 normal, friction;
#ifdef READS_AHEAD
  vec4 term[CONTACT_TERMS];
#endif
} listed_contact;

/* Its rows, read once. freedom: those that move the contact of any lane. */
typedef struct {
  uint rows;
  uint freedom[TREE_FREEDOMS];
  projected_rows row[TREE_FREEDOMS];
} projected_contact;

SHARED vec4 load_term(const listed_contact *c, read_contact_freedoms f, uint stride, uint term)
{
#ifdef READS_AHEAD
  (void)f, (void)stride;
  return c->term[term];
#else
  return load_float4(f.term, c->at + stride * term);
#endif
}

/* What does not move the contact is not used. */
SHARED projected_rows load_projection(read_contact_freedoms f, uint stride, uint_lanes at, uint freedom)
{
  uint_lanes row = at + stride * (2u * freedom);
  projected_rows p = {load_float4(f.row, row), load_float4(f.row, row + stride)};
  return p;
}

/* Rows are read by some at once, so that a device waits for their memory once. */
#define PROJECTIONS_AT_ONCE 8u

SHARED void load_projections(projected_contact *c, read_contact_freedoms f, uint stride, const listed_contact *of)
{
  c->rows = 0u;
  for (freedoms_left left = freedoms_of_any(of->moved); any_left(&left);) c->freedom[c->rows++] = next_freedom(&left);
  for (uint first = 0u; first < c->rows; first += PROJECTIONS_AT_ONCE) {
    projected_rows p[PROJECTIONS_AT_ONCE];
    for (uint n = 0u; n < PROJECTIONS_AT_ONCE; ++n)
      if (first + n < c->rows) p[n] = load_projection(f, stride, of->at, c->freedom[first + n]);
    for (uint n = 0u; n < PROJECTIONS_AT_ONCE; ++n)
      if (first + n < c->rows) c->row[first + n] = p[n];
  }
}

SHARED vec4 no_speeds(void) { return make_vec4(R(0.0), R(0.0), R(0.0), R(0.0)); }
SHARED real dot4(vec4 a, vec4 b) { return (a.x * b.x + a.y * b.y) + (a.z * b.z + a.w * b.w); }

/* Row n of the normals, or of both directions of friction and the twist. */
enum { ROWS_OF_NORMALS, ROWS_OF_FRICTION };
SHARED vec4 row_of_kind(const projected_contact *c, uint kind, uint n)
{
  return kind == ROWS_OF_NORMALS ? c->row[n].normals : c->row[n].others;
}

/* How what has pushed the freedoms moves the rows. */
SHARED vec4 speeds_of_freedoms(const projected_contact *c, freedom_set moved, uint kind, const tree_freedoms *z)
{
  vec4 speeds = no_speeds();
  for (uint n = 0u; n < c->rows; ++n) {
    vec4 sum = add_scaled4(speeds, row_of_kind(c, kind, n), z->change[c->freedom[n]]);
    speeds = choose4(has_freedom(moved, c->freedom[n]), sum, speeds);
  }
  return speeds;
}

SHARED void push_freedoms_if(mask pushes, const projected_contact *c, freedom_set moved, uint kind, tree_freedoms *z,
                             vec4 impulses)
{
  if (!any_of(pushes)) return;
  for (uint n = 0u; n < c->rows; ++n) {
    uint freedom = c->freedom[n];
    real change = z->change[freedom] + dot4(row_of_kind(c, kind, n), impulses);
    z->change[freedom] = choose(pushes & has_freedom(moved, freedom), change, z->change[freedom]);
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

SHARED vec4 solve_tree_friction_if(mask rough, const projected_contact *c, freedom_set moved, tree_freedoms *z,
                                   vec4 friction, vec4 speeds_before, vec4 terms, real limit, mask *pushed)
{
  vec4 speeds = add4(speeds_before, speeds_of_freedoms(c, moved, ROWS_OF_FRICTION, z));
  vec4 solved = friction_after(friction, speeds, terms, limit);
  vec4 change = change_between(friction, solved);
  mask pushes = rough & is_nonzero4(change);
  push_freedoms_if(pushes, c, moved, ROWS_OF_FRICTION, z, change);
  *pushed = *pushed | pushes;
  return choose4(rough, solved, friction);
}

/* --- normals -------------------------------------------------------------------------------------------------- */
/* last_coupled: of 13 and 23; then as masses see them. */
typedef struct {
  vec4 speed, impulse, mass, separation, squares, coupled, soft_coupled, last_coupled;
} tree_normals;

/* pushed: what has pushed the freedoms, as the normals see it. A single point is coupled to no other one. */
SHARED tree_normals load_tree_normals(const listed_contact *c, read_contact_freedoms f, uint stride, vec4 pushed)
{
  tree_normals s;
  s.speed = add4(load_term(c, f, stride, CONTACT_TERM_NORMAL_SPEEDS), pushed);
  s.impulse = c->normal;
  s.mass = load_term(c, f, stride, CONTACT_TERM_MASSES);
  s.separation = load_term(c, f, stride, CONTACT_TERM_SEPARATIONS);
  s.squares = load_term(c, f, stride, CONTACT_TERM_SQUARES);
  s.coupled = s.soft_coupled = s.last_coupled = no_speeds();
  if (!any_of((s.mass.y > R(0.0)) | (s.mass.z > R(0.0)) | (s.mass.w > R(0.0)))) return s;
  s.coupled = load_term(c, f, stride, CONTACT_TERM_COUPLED);
  s.soft_coupled = load_term(c, f, stride, CONTACT_TERM_SOFT_COUPLED);
  s.last_coupled = load_term(c, f, stride, CONTACT_TERM_LAST_COUPLED);
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

/* block_solve_normals of solve/contact_normals.h: all points move towards their targets along one direction. */
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

/* Towards the target velocities of restitution, as apply_restitution_item of solve/restitution.h. */
SHARED void bounce_tree_normals(tree_normals *s, vec4 target_velocity, vec4 highest)
{
  real wanted[4];
  for (uint k = 0; k < 4u; ++k) {
    wanted[k] = bouncing_impulse(component(target_velocity, k), component(highest, k), component(s->speed, k),
                                 component(s->mass, k), component(s->impulse, k));
  }
  block_solve_tree_normals(s, make_vec4(wanted[0], wanted[1], wanted[2], wanted[3]));
}

/* --- passes --------------------------------------------------------------------------------------------------- */
/* What solving the contacts of a tree reads, and pairs: the stride of planes of contacts. */
typedef struct {
  read_contacts contacts;
  read_contact_freedoms freedoms;
  GLOBAL const memory_real *slop;
  GLOBAL const uint *listed; /* the contacts of the tree of each lane */
  contact_places places;
  uint pairs, biased;
} tree_contacts;

SHARED listed_contact load_listed_contact(GLOBAL const Parameters *parameters, const tree_contacts *s,
                                          write_contact_impulses impulses, uint_lanes tree, uint_lanes listed, uint n)
{
  listed_contact c;
  uint slot = n < TREE_COLORS ? n : 0u;
  c.wanted = (uint_lanes)n < listed;
  c.i = c.at = choose(c.wanted, load_uint(s->listed, TREE_COLORS * tree + slot), (uint_lanes)0u);
  if (s->places.by_tree) c.at = place_by_tree(s->places, tree, (uint_lanes)slot);
  c.moved.low = choose(c.wanted, load_uint(s->freedoms.freedom, c.at), (uint_lanes)0u);
  c.moved.high = choose(c.wanted, load_uint(s->freedoms.freedom, c.at + s->places.stride), (uint_lanes)0u);
  c.packed = load_float4(s->contacts.normal, c.i).w;
  c.slop = load_real(s->slop, c.i);
  c.normal = load_float4(impulses.normal, c.i);
  c.friction = load_friction(parameters, impulses.friction, c.i);
#ifdef READS_AHEAD
  for (uint term = 0u; term < (uint)CONTACT_TERMS; ++term)
    c.term[term] = load_float4(s->freedoms.term, c.at + s->places.stride * term);
#endif
  return c;
}

SHARED void push_by_normals_if(mask wanted, const projected_contact *c, freedom_set moved, tree_freedoms *z,
                               vec4 before, vec4 after, mask *pushed)
{
  vec4 change = change_between(before, after);
  mask pushes = wanted & is_nonzero4(change);
  push_freedoms_if(pushes, c, moved, ROWS_OF_NORMALS, z, change);
  *pushed = *pushed | pushes;
}

SHARED void solve_projected_contact(GLOBAL const Parameters *parameters, const listed_contact *c,
                                    const projected_contact *rows, const tree_contacts *s,
                                    write_contact_impulses impulses, tree_freedoms *z, mask *pushed)
{
  uint stride = s->places.stride;
  real coefficient = friction_of(c->packed);
  vec4 before = c->normal, speeds = load_term(c, s->freedoms, stride, CONTACT_TERM_SPEEDS);
  mask rough = c->wanted & (coefficient > R(0.0));
  if (HAS_FEATURE(parameters, FRICTION) && any_of(rough)) {
    real limit = coefficient * ((before.x + before.y) + (before.z + before.w));
    vec4 terms = load_term(c, s->freedoms, stride, CONTACT_TERM_FRICTION);
    vec4 friction = solve_tree_friction_if(rough, rows, c->moved, z, c->friction, speeds, terms, limit, pushed);
    store_float4_if(rough, impulses.friction, c->i, friction);
  }
  tree_normals normals =
      load_tree_normals(c, s->freedoms, stride, speeds_of_freedoms(rows, c->moved, ROWS_OF_NORMALS, z));
  softness soft = softness_against(parameters, speeds.w > R(0.0));
  solve_rounds_of_tree_normals(parameters, &normals, soft, c->slop, c->packed < R(0.0), s->biased);
  store_float4_if(c->wanted, impulses.normal, c->i, normals.impulse);
  keep_highest_impulses_if(c->wanted, parameters, impulses.restitution, s->pairs, normals.impulse, c->i);
  push_by_normals_if(c->wanted, rows, c->moved, z, before, normals.impulse, pushed);
}

/* Contacts of which no point bounces stay as they are. */
SHARED void bounce_projected_contact(const listed_contact *c, const projected_contact *rows, const tree_contacts *s,
                                     write_contact_impulses impulses, tree_freedoms *z, mask *pushed)
{
  vec4 target_velocity = load_float4(impulses.restitution, c->i),
       highest = load_float4(impulses.restitution, c->i + s->pairs);
  mask bounces = c->wanted & ((target_velocity.x >= R(0.0)) | (target_velocity.y >= R(0.0)) |
                              (target_velocity.z >= R(0.0)) | (target_velocity.w >= R(0.0)));
  if (!any_of(bounces)) return;
  tree_normals normals =
      load_tree_normals(c, s->freedoms, s->places.stride, speeds_of_freedoms(rows, c->moved, ROWS_OF_NORMALS, z));
  for (uint round = 0; round < RESTITUTION_ROUNDS; ++round) bounce_tree_normals(&normals, target_velocity, highest);
  store_float4_if(bounces, impulses.normal, c->i, normals.impulse);
  push_by_normals_if(bounces, rows, c->moved, z, c->normal, normals.impulse, pushed);
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
  tree_contacts s = {contacts,
                     freedoms,
                     constraint_slop,
                     states.contact,
                     places_of_contacts(counts),
                     planes_of(counts).stride,
                     kind_of_pass(pass) == (uint)PASS_BIASED ? 1u : 0u};
  tree_freedoms z;
  begin_freedoms(&t, &z);
#ifdef READS_AHEAD
  listed_contact ahead = load_listed_contact(parameters, &s, contact_impulses, tree, listed, 0u);
#endif
  for (uint n = 0u; any_of(n < listed); ++n) {
#ifdef READS_AHEAD
    listed_contact c = ahead;
    ahead = load_listed_contact(parameters, &s, contact_impulses, tree, listed, n + 1u);
#else
    listed_contact c = load_listed_contact(parameters, &s, contact_impulses, tree, listed, n);
#endif
    projected_contact rows;
    load_projections(&rows, freedoms, s.places.stride, &c);
    if (pass == (uint)PASS_BOUNCING) bounce_projected_contact(&c, &rows, &s, contact_impulses, &z, &pushed);
    else solve_projected_contact(parameters, &c, &rows, &s, contact_impulses, &z, &pushed);
  }
  end_moving_if(touches, &t, &z, pushed);
}

#endif
