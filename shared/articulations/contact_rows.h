/* contact_rows.h - the rows of the contacts of trees, in the freedoms of their trees.
 *
 *        row of a contact        the six numbers of an impulse on the seen link
 *             | J                what a freedom moves that link by (path.h)
 *             v
 *        its projection          a number for each freedom d of the tree: g[d] = row . J[d]
 *
 * In the units of path.h the mass matrix is the identity. So with z the changes of the freedoms,
 *
 *     speed of a row = that before the pass + g . z,    an impulse p changes z by g p,    response of two rows = g . g'
 *
 * and a contact that is solved needs neither its bodies nor 6x6 matrices: these are the rows of a dense solver in
 * generalised coordinates (Featherstone, "Rigid Body Dynamics Algorithms", 2008, section 11.7). An item projects one
 * contact, so that the contacts of a tree, which have to be solved one after another (tree_contacts.h), share the long
 * part of the work.
 *
 *     contact_freedom    words, planes   the freedoms that move one of the two links, a bit each
 *     contact_row        planes          for each freedom d of the tree its projections: of the four normals in plane
 *                                        2 d, of both directions of friction and of the twist in plane 2 d + 1
 *     contact_term       planes          CONTACT_TERM_: speeds, masses, separations, responses
 *
 * The place of a contact in a plane is its own number, or its number in the list of its tree where all lists together
 * are shorter than the pairs: a robot among a million boxes needs no rows for these.
 *
 * Two links of one tree push each other through it. For effective masses they seem to answer more than the tree lets
 * them, by half of what the freedoms that move both would move each of them by: two links which the tree holds rigidly
 * to each other, and which overlap, then push no more than a spring does.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_CONTACT_ROWS_H
#define TANDEM_SHARED_ARTICULATIONS_CONTACT_ROWS_H

#include "shared/articulations/contact.h"
#include "shared/articulations/path.h"

/* Planes of contact_term. The coupled terms are those of normals_response. */
enum {
  CONTACT_TERM_NORMAL_SPEEDS, /* of the four normals, before the pass */
  CONTACT_TERM_SPEEDS,        /* of both directions and of the twist; 1 against what does not move, else 0 */
  CONTACT_TERM_MASSES,        /* of the normals; 0 of a point that is not used */
  CONTACT_TERM_SEPARATIONS,
  CONTACT_TERM_FRICTION, /* responses of the twist with both directions; its mass, and that of sliding */
  CONTACT_TERM_SQUARES,
  CONTACT_TERM_COUPLED,
  CONTACT_TERM_SOFT_COUPLED, /* as masses see it */
  CONTACT_TERM_LAST_COUPLED, /* two, and two as masses see them */
  CONTACT_TERMS
};

/* --- one contact ---------------------------------------------------------------------------------------------- */
/* Impulses on the body that is seen. */
typedef struct {
  spatial_force normal[4], first, second, twist;
} contact_rows;

/* How a motion moves along each row. */
typedef struct {
  vec4 normals, others; /* others: first, second, twist */
} projected_rows;

SHARED projected_rows project_rows(const contact_rows *r, spatial_motion m)
{
  projected_rows p = {make_vec4(power_of(r->normal[0], m), power_of(r->normal[1], m), power_of(r->normal[2], m),
                                power_of(r->normal[3], m)),
                      make_vec4(power_of(r->first, m), power_of(r->second, m), power_of(r->twist, m), R(0.0))};
  return p;
}

/* How normals answer each other: their own responses, and those of 01 02 03 12 and 13 23. */
typedef struct {
  vec4 squares, coupled, last_coupled;
} normals_response;

/* first_second: of the two directions of friction; twisted: of the twist with each of them and with itself. */
typedef struct {
  normals_response normals;
  vec3 sliding; /* first, second, both */
  vec3 twisted;
} contact_response;

SHARED contact_response no_response(void)
{
  vec4 none = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
  contact_response r = {{none, none, none}, zero3(), zero3()};
  return r;
}

SHARED vec4 add_scaled_products(vec4 sum, vec4 a, vec4 b, real factor)
{
  return make_vec4(sum.x + factor * (a.x * b.x), sum.y + factor * (a.y * b.y), sum.z + factor * (a.z * b.z),
                   sum.w + factor * (a.w * b.w));
}

/* Adds what one freedom lets the rows answer. */
SHARED void add_response(contact_response *r, projected_rows p, real factor)
{
  vec4 n = p.normals, o = p.others;
  normals_response *s = &r->normals;
  s->squares = add_scaled_products(s->squares, n, n, factor);
  s->coupled = add_scaled_products(s->coupled, make_vec4(n.x, n.x, n.x, n.y), make_vec4(n.y, n.z, n.w, n.z), factor);
  s->last_coupled.x = s->last_coupled.x + factor * (n.y * n.w);
  s->last_coupled.y = s->last_coupled.y + factor * (n.z * n.w);
  r->sliding = add(r->sliding, scale(make_vec3(o.x * o.x, o.y * o.y, o.x * o.y), factor));
  r->twisted = add(r->twisted, scale(make_vec3(o.x * o.z, o.y * o.z, o.z * o.z), factor));
}

SHARED contact_response sum_of_responses(const contact_response *a, const contact_response *b)
{
  contact_response r = {{add4(a->normals.squares, b->normals.squares), add4(a->normals.coupled, b->normals.coupled),
                         add4(a->normals.last_coupled, b->normals.last_coupled)},
                        add(a->sliding, b->sliding),
                        add(a->twisted, b->twisted)};
  return r;
}

/* --- links and freedoms --------------------------------------------------------------------------------------- */
/* A link of the tree, or a body that none of its contacts moves. Its velocity is that before the pass. */
SHARED pushed_side side_of_tree_contact(mask wanted, const articulation *t, read_links links, uint_lanes body,
                                        spatial_velocity record)
{
  pushed_side s;
  s.body = body;
  s.record = record;
  s.tree = *t;
  s.is_link = wanted & is_link(links.of_body, body);
  s.answers = s.is_link;
  s.k = choose(s.is_link, load_uint(links.of_body, LINK_WORDS * body + 2u), (uint_lanes)0u);
  s.velocity.linear = record.linear;
  s.velocity.angular = record.angular;
  s.velocity = choose_motion(s.is_link, load_motion(t, s.k, (uint)WORK_VELOCITY), s.velocity);
  s.inverse = zero_symmetric6();
  s.pushed = no_force();
  return s;
}

SHARED link_contact load_tree_contact(mask wanted, GLOBAL const Parameters *parameters, const articulation *t,
                                      read_contacts contacts, read_patches patches, read_turning_bodies bodies,
                                      read_links links, GLOBAL const float4 *solver_velocity, any_index i)
{
  contact c = load_shape_of_contact(wanted, parameters, contacts, bodies, solver_velocity, i);
  pushed_side a = side_of_tree_contact(wanted, t, links, c.a, c.velocity_a),
              b = side_of_tree_contact(wanted, t, links, c.b, c.velocity_b);
  return load_contact_of_sides(wanted, c, a, b, patches, bodies, i);
}

/* The links of a contact as the freedoms of their paths move them. */
typedef struct {
  path_walk seen, other;
} seen_paths;

SHARED seen_paths paths_of_contact(const articulation *t, const link_contact *c)
{
  mask is_b = c->body.is_b;
  seen_paths p = {walk_of_path_if(c->a.is_link | c->b.is_link, t, choose(is_b, c->b.k, c->a.k)),
                  walk_of_path_if(is_b & c->a.is_link, t, c->a.k)};
  return p;
}

/* What a freedom does to the rows: as it moves the seen link, as it carries it with the other one, and both. */
typedef struct {
  mask moves, moves_both;
  projected_rows seen, other, all;
} moved_rows;

/* What a freedom moves the links by. */
typedef struct {
  mask seen, other; /* whether it does */
  spatial_motion of_seen, of_other;
} moved_links;

/* TREE_FREEDOMS moves nothing. */
SHARED moved_links links_moved_by(const articulation *t, seen_paths *p, uint freedom)
{
  moved_links m = {has_links(t) & !has_links(t), has_links(t) & !has_links(t), no_motion(), no_motion()};
  if (freedom >= TREE_FREEDOMS) return m;
  m.seen = has_freedom(p->seen.freedoms, freedom);
  m.other = has_freedom(p->other.freedoms, freedom);
  m.of_seen = next_motion_if(m.seen, t, &p->seen);
  m.of_other = next_motion_if(m.other, t, &p->other);
  return m;
}

SHARED moved_rows rows_moved_by(const link_contact *c, const contact_rows *rows, const moved_links *links)
{
  moved_rows m;
  mask moves_other = links->other;
  m.moves = links->seen | moves_other;
  m.moves_both = links->seen & moves_other;
  m.seen = m.all = project_rows(rows, links->of_seen);
  m.other = m.seen;
  if (!any_of(moves_other)) return m;
  m.other = project_rows(rows, motion_at(links->of_other, c->body.to_seen));
  vec4 n = m.other.normals, o = m.other.others;
  m.all.normals =
      make_vec4(m.seen.normals.x - n.x, m.seen.normals.y - n.y, m.seen.normals.z - n.z, m.seen.normals.w - n.w);
  m.all.others = make_vec4(m.seen.others.x - o.x, m.seen.others.y - o.y, m.seen.others.z - o.z, R(0.0));
  m.all.normals = choose4(moves_other, m.all.normals, m.seen.normals);
  m.all.others = choose4(moves_other, m.all.others, m.seen.others);
  return m;
}

SHARED projected_rows projection_if(mask wanted, projected_rows p)
{
  vec4 none = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
  projected_rows q = {choose4(wanted, p.normals, none), choose4(wanted, p.others, none)};
  return q;
}

/* --- memory --------------------------------------------------------------------------------------------------- */
/* stride: of planes. by_tree: whether contacts have the places of lists, of which the n-th contacts of neighbouring
 * trees stand beside each other. */
typedef struct {
  uint stride, by_tree;
} contact_places;

SHARED contact_places places_of_contacts(GLOBAL const uint *counts)
{
  uint pairs = counts[CAPACITY_PAIRS], trees = counts[COUNT_ARTICULATIONS];
  uint by_tree = trees <= pairs / TREE_COLORS ? 1u : 0u;
  contact_places p = {by_tree ? TREE_COLORS * trees : pairs, by_tree};
  return p;
}

SHARED uint_lanes place_by_tree(contact_places p, uint_lanes tree, uint_lanes n)
{
  return n * (uint_lanes)(p.stride / TREE_COLORS) + tree;
}

/* The number of contact i in the list of its tree; lists are in the order of contacts. */
SHARED uint_lanes number_in_list(write_link_states states, uint_lanes tree, uint_lanes i)
{
  uint_lanes first = TREE_COLORS * tree, low = (uint_lanes)0u;
  uint_lanes listed = load_uint(states.colors, TREE_COLOR_WORDS * tree + 3u);
  for (uint step = TREE_COLORS / 2u; step > 0u; step /= 2u) {
    uint_lanes next = low + (uint_lanes)step;
    mask within = next < listed;
    uint_lanes there = load_uint(states.contact, first + choose(within, next, (uint_lanes)0u));
    low = choose(within & (there <= i), next, low);
  }
  return low;
}

SHARED void store_term_if(mask wanted, write_contact_freedoms f, uint stride, uint term, uint_lanes at, vec4 value)
{
  store_listed_row_if(wanted, f.term, at + (uint_lanes)(stride * term), value);
}

SHARED void store_projection_if(mask wanted, write_contact_freedoms f, uint stride, uint freedom, uint_lanes at,
                                projected_rows p)
{
  uint_lanes row = at + (uint_lanes)(stride * (2u * freedom));
  store_listed_row_if(wanted, f.row, row, p.normals);
  store_listed_row_if(wanted, f.row, row + (uint_lanes)stride, p.others);
}

/* soft: with what masses see besides. */
SHARED void store_responses_if(mask wanted, write_contact_freedoms f, uint stride, uint_lanes at,
                               const contact_response *r, const contact_response *soft)
{
  vec4 s = soft->normals.squares, last = r->normals.last_coupled, soft_last = soft->normals.last_coupled;
  store_term_if(wanted, f, stride, CONTACT_TERM_MASSES, at,
                make_vec4(inverse_or_zero(s.x), inverse_or_zero(s.y), inverse_or_zero(s.z), inverse_or_zero(s.w)));
  store_term_if(
      wanted, f, stride, CONTACT_TERM_FRICTION, at,
      make_vec4(r->twisted.x, r->twisted.y, inverse_or_zero(soft->twisted.z), mass_of_sliding(soft->sliding)));
  store_term_if(wanted, f, stride, CONTACT_TERM_SQUARES, at, r->normals.squares);
  store_term_if(wanted, f, stride, CONTACT_TERM_COUPLED, at, r->normals.coupled);
  store_term_if(wanted, f, stride, CONTACT_TERM_SOFT_COUPLED, at, soft->normals.coupled);
  store_term_if(wanted, f, stride, CONTACT_TERM_LAST_COUPLED, at, make_vec4(last.x, last.y, soft_last.x, soft_last.y));
}

/* --- the kernel ----------------------------------------------------------------------------------------------- */
/* Point k as a row, and where it stands; one that is not used has no row. */
SHARED spatial_force load_normal_row(const link_contact *c, read_patches patches, point_planes planes, uint k,
                                     item_index i, real *separation)
{
  vec3 n = c->shape.normal;
  *separation = R(0.0);
  mask used = load_point_mass(patches.points, planes, k, i) > R(0.0);
  if (!any_of(used)) return no_force();
  point_arms arms = load_point_arms(c, patches, planes, k, i);
  real closed = dot3(n, c->moved.translation) +
                (dot3(cross3(arms.b, n), c->moved.rotation_b) - dot3(cross3(arms.a, n), c->moved.rotation_a));
  *separation = choose(used, load_separation(patches.points, planes, k, i) + closed, (real)R(0.0));
  return choose_force(used, row_seen(&c->body, arms.a, arms.b, n), no_force());
}

SHARED contact_rows load_contact_rows(const link_contact *c, read_patches patches, point_planes planes, item_index i,
                                      vec4 *separations)
{
  contact_rows r;
  real separation[4];
  for (uint k = 0; k < 4u; ++k) r.normal[k] = load_normal_row(c, patches, planes, k, i, &separation[k]);
  tangents t = tangents_of(c->shape.normal);
  r.first = row_at_center(c, t.first);
  r.second = row_at_center(c, t.second);
  r.twist = twist_seen(&c->body, c->shape.normal);
  *separations = make_vec4(separation[0], separation[1], separation[2], separation[3]);
  return r;
}

/* Of what the freedoms that move both links would move each of them by: so much more the links seem to answer. With a
 * sixteenth, some links that began deep in each other came apart with twenty to a thousand times the energy. */
#define COMPLIANCE_WITHIN R(0.5)

SHARED void project_freedoms_if(mask wanted, const articulation *t, const link_contact *c, const contact_rows *rows,
                                write_contact_freedoms f, uint stride, uint_lanes at)
{
  contact_response response = no_response(), softness = no_response();
  seen_paths p = paths_of_contact(t, c);
  freedom_set moved = freedoms_of_either(&p.seen, &p.other);
  store_uint_if(wanted, f.freedom, at, moved.low);
  store_uint_if(wanted, f.freedom, at + (uint_lanes)stride, moved.high);
  freedoms_left left = freedoms_of_any(moved);
  uint beyond = next_freedom_or_none(&left);
#ifdef READS_AHEAD
  moved_links ahead = links_moved_by(t, &p, beyond);
#endif
  while (beyond < TREE_FREEDOMS) {
    uint freedom = beyond;
    beyond = next_freedom_or_none(&left);
#ifdef READS_AHEAD
    moved_links links = ahead;
    ahead = links_moved_by(t, &p, beyond);
#else
    moved_links links = links_moved_by(t, &p, freedom);
#endif
    moved_rows m = rows_moved_by(c, rows, &links);
    store_projection_if(wanted & m.moves, f, stride, freedom, at, m.all);
    add_response(&response, m.all, R(1.0));
    if (any_of(m.moves_both)) {
      add_response(&softness, projection_if(m.moves_both, m.seen), COMPLIANCE_WITHIN);
      add_response(&softness, projection_if(m.moves_both, m.other), COMPLIANCE_WITHIN);
    }
  }
  contact_response soft = sum_of_responses(&response, &softness);
  store_responses_if(wanted, f, stride, at, &response, &soft);
}

/* An item is a contact, of a tree that has its contacts for itself and stands where its table of paths was made. In a
 * pass that has not made the table, speeds alone are new. */
SHARED void project_tree_contacts_item(GLOBAL const Parameters *parameters, read_contacts contacts,
                                       read_patches patches, read_turning_bodies bodies, read_links links,
                                       GLOBAL const uint *counts, write_link_states states,
                                       GLOBAL const float4 *solver_velocity, write_contact_freedoms freedoms, uint pass,
                                       item_index i)
{
  uint_lanes a = load_uint(contacts.a, i), b = load_uint(contacts.b, i), link = choose(is_link(links.of_body, a), a, b);
  mask wanted = is_link(links.of_body, link);
  if (!any_of(wanted)) return;
  uint_lanes tree = choose(wanted, articulation_of_body(links.of_body, link), (uint_lanes)0u);
  articulation t = articulation_in_pass(links, states, tree, pass);
  wanted = wanted & has_links(&t) & !is_mixed(states, tree);
  if (!any_of(wanted)) return;
  point_planes planes = planes_of(counts);
  contact_places places = places_of_contacts(counts);
  uint_lanes at = i;
  if (places.by_tree)
    at = choose(wanted, place_by_tree(places, tree, number_in_list(states, tree, at)), (uint_lanes)0u);
  link_contact c = load_tree_contact(wanted, parameters, &t, contacts, patches, bodies, links, solver_velocity, i);
  see_velocities(&c);
  vec4 separations;
  contact_rows rows = load_contact_rows(&c, patches, planes, i, &separations);
  projected_rows speeds = project_rows(&rows, c.body.velocity);
  real fixed = choose(c.a.is_link & c.b.is_link, (real)R(0.0), (real)R(1.0));
  store_term_if(wanted, freedoms, places.stride, CONTACT_TERM_NORMAL_SPEEDS, at, speeds.normals);
  store_term_if(wanted, freedoms, places.stride, CONTACT_TERM_SPEEDS, at,
                make_vec4(speeds.others.x, speeds.others.y, speeds.others.z, fixed));
  mask fresh = wanted & (load_uint(states.colors, TREE_COLOR_WORDS * tree) == (uint_lanes)(uint)PATHS_ARE_NEW);
  if (!any_of(fresh)) return;
  store_term_if(fresh, freedoms, places.stride, CONTACT_TERM_SEPARATIONS, at, separations);
  project_freedoms_if(fresh, &t, &c, &rows, freedoms, places.stride, at);
}

#endif
