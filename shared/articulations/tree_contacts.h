/* tree_contacts.h - trees that have all of their contacts for themselves.
 *
 *      tree_contact     tree 0 | 4  7  -  9  - ..      the contact of each colour, of 64
 *                       tree 1 | 5  -  8  -  - ..
 *      tree_colors      tree 0 | 0b1011  0  0  -       a bit for each colour in use, in two words; is it mixed
 *
 *      order_tree_contacts
 *      tree_contact     tree 0 | 4  7  9 ..            in the order of the colours, without gaps, so that trees which
 *                       tree 1 | 5  8  ..              a device solves side by side each have one to solve
 *      tree_colors      tree 0 | 0  0  0  3            is its table of paths made; how many; 0 of a mixed tree
 *
 * Contacts within one tree, and with what does not move, concern no other tree. An item a tree solves them one after
 * another in the order of their colours: a tree of 25 contacts needs one launch a pass instead of 25. They read and
 * push the tree by its table of paths (path.h), which holds as long as the tree stands still:
 *
 *     velocity = that of the links before the pass + J^T z,    inverse inertia = J^T J,    a push f: z += J f
 *
 * with J the rows of the seen link less those of the other one, and z what all contacts of the pass have pushed. So
 * what two links of one tree do to each other through it is exact; rows between them have smaller masses than that
 * allows (COMPLIANCE_WITHIN). A tree is mixed if a contact of it has another body that moves, or no colour of its own,
 * or if it has no table; then all of its contacts walk, by colour.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_TREE_CONTACTS_H
#define TANDEM_SHARED_ARTICULATIONS_TREE_CONTACTS_H

#include "shared/articulations/contact.h"
#include "shared/articulations/path.h"

#ifndef TANDEM_LANES /* ITEM kernels take one item at a time */
SHARED uint color_of_contact(GLOBAL const uint *counts, uint i)
{
  uint low = 0u, high = COLOR_OVERFLOW;
  while (low < high) {
    uint middle = low + (high - low) / 2u;
    if (counts[COLOR_START + middle + 1u] <= i) low = middle + 1u;
    else high = middle;
  }
  return low;
}

SHARED uint tree_has_paths(read_links links, uint tree)
{
  return links.place[(uint)PLACE_WORDS * tree + (uint)PLACE_FREEDOMS] > 0u ? 1u : 0u;
}

/* The tree of a body, or INDEX_NONE. */
SHARED uint tree_of_body(read_links links, uint body)
{
  return is_link(links.of_body, body) ? articulation_of_body(links.of_body, body) : INDEX_NONE;
}

SHARED void note_mixed(write_link_states states, uint tree)
{
  if (tree != INDEX_NONE) ATOMIC_OR(states.colors + TREE_COLOR_WORDS * tree + 2u, 1u);
}

SHARED mask can_move(GLOBAL const float4 *solver_velocity, uint body)
{
  return load_velocity(solver_velocity, body).inverse_mass > R(0.0);
}

/* An item is a contact; begin_articulations has cleared the words of colours. */
SHARED void list_tree_contacts_item(read_contacts contacts, read_links links, GLOBAL const uint *counts,
                                    GLOBAL const float4 *solver_velocity, write_link_states states, uint i)
{
  uint a = contacts.a[i], b = contacts.b[i], tree_a = tree_of_body(links, a), tree_b = tree_of_body(links, b);
  if (tree_a == INDEX_NONE && tree_b == INDEX_NONE) return;
  uint tree = tree_a == INDEX_NONE ? tree_b : tree_a, color = color_of_contact(counts, i);
  mask within = tree_a == tree_b, on_rest = tree_a == INDEX_NONE   ? !can_move(solver_velocity, a)
                                            : tree_b == INDEX_NONE ? !can_move(solver_velocity, b)
                                                                   : 0;
  if (color >= LINK_COLORS || !(within || on_rest) || !tree_has_paths(links, tree)) {
    note_mixed(states, tree_a);
    note_mixed(states, tree_b);
    return;
  }
  states.contact[TREE_COLORS * tree + color] = i;
  ATOMIC_OR(states.colors + TREE_COLOR_WORDS * tree + (color >> 5u), 1u << (color & 31u));
}

/* Whether the world of a tree has overflow constraints. */
SHARED uint overflows_of_tree(read_links links, read_joint_worlds worlds, write_link_states states, uint tree)
{
  articulation t = articulation_at(links, states, tree);
  return worlds.overflows[worlds.of_body[2u * body_of_link(links, &t, 0u)]];
}

/* An item is a tree. by_world: whether some world of a batch takes further passes; those of the tree's own are noted
 * then. */
SHARED void order_tree_contacts_item(read_links links, read_joint_worlds worlds, write_link_states states,
                                     uint by_world, uint i)
{
  GLOBAL uint *colors = states.colors + TREE_COLOR_WORDS * i;
  GLOBAL uint *contact = states.contact + TREE_COLORS * i;
  uint listed = 0u;
  for (uint word = 0u; word < 2u; ++word)
    for (uint color = 32u * word, left = colors[word]; left != 0u; ++color, left >>= 1u)
      if (left & 1u) contact[listed++] = contact[color];
  colors[0] = 0u;
  colors[1] = by_world ? overflows_of_tree(links, worlds, states, i) : 0u;
  colors[3] = colors[2] == 0u ? listed : 0u;
}
#endif

/* --- by the table of paths ------------------------------------------------------------------------------------ */
SHARED void make_paths_if(mask wanted, const articulation *t, GLOBAL uint *tree_colors)
{
  uint_lanes word = TREE_COLOR_WORDS * t->number;
  wanted = wanted & (load_uint(tree_colors, word) == 0u);
  if (!any_of(wanted)) return;
  prepare_paths_if(wanted, t);
  store_uint_if(wanted, tree_colors, word, (uint_lanes)1u);
}

/* Of what the freedoms that move both links would move each of them by: so much more they seem to answer than the tree
 * lets them, which keeps pushes small where it holds them to each other. With a sixteenth, some links that began deep
 * in each other came apart with twenty to a thousand times the energy. */
#define COMPLIANCE_WITHIN R(0.5)

SHARED void see_freedom(relative_body *body, spatial_motion row, real change)
{
  body->velocity.angular = add_scaled(body->velocity.angular, row.angular, change);
  body->velocity.linear = add_scaled(body->velocity.linear, row.linear, change);
  add_square_of_motion(&body->inverse, row, R(1.0));
}
SHARED void soften_if(mask both, const relative_body *body, symmetric6 *softness, spatial_motion seen,
                      spatial_motion other)
{
  if (!any_of(both)) return;
  symmetric6 softer = *softness;
  add_square_of_motion(&softer, seen, COMPLIANCE_WITHIN);
  add_square_of_motion(&softer, motion_at(other, body->to_seen), COMPLIANCE_WITHIN);
  *softness = choose_symmetric6(both, softer, *softness);
}

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
                                      read_links links, GLOBAL const float4 *solver_velocity, uint_lanes i)
{
  contact c = load_shape_of_contact(wanted, parameters, contacts, bodies, solver_velocity, i);
  pushed_side a = side_of_tree_contact(wanted, t, links, c.a, c.velocity_a),
              b = side_of_tree_contact(wanted, t, links, c.b, c.velocity_b);
  link_contact loaded = load_contact_of_sides(wanted, c, a, b, patches, bodies, i);
  loaded.walks_within = wanted & !wanted;
  return loaded;
}

/* The links of a contact as the freedoms of their paths move them. */
typedef struct {
  path_walk seen, other;
  symmetric6 softness;
} seen_paths;

SHARED seen_paths paths_of_contact(const articulation *t, const link_contact *c)
{
  mask is_b = c->body.is_b;
  seen_paths p;
  p.seen = walk_of_path_if(c->a.is_link | c->b.is_link, t, choose(is_b, c->b.k, c->a.k));
  p.other = walk_of_path_if(is_b & c->a.is_link, t, c->a.k);
  p.softness = zero_symmetric6();
  return p;
}

/* What a freedom does to the two links. */
typedef struct {
  mask moves_seen, moves_other;
  spatial_motion seen, other;
} freedom_motions;

SHARED freedom_motions next_motions(const articulation *t, seen_paths *p, uint freedom)
{
  freedom_motions m;
  m.moves_seen = has_freedom(p->seen.freedoms, freedom);
  m.moves_other = has_freedom(p->other.freedoms, freedom);
  m.seen = next_motion_if(m.moves_seen, t, &p->seen);
  m.other = next_motion_if(m.moves_other, t, &p->other);
  return m;
}

/* A row of another lane's freedom does nothing, to the bit, so the bits of a tree depend on no other one. */
SHARED void see_motions(link_contact *c, tree_freedoms *z, seen_paths *p, const freedom_motions *m, uint n)
{
  mask moves = m->moves_seen | m->moves_other;
  z->row[n] = choose_motion(moves, motion_seen(&c->body, m->seen, m->other), no_motion());
  see_freedom(&c->body, z->row[n], zero_if(!moves, z->change[z->freedom[n]]));
  soften_if(m->moves_seen & m->moves_other, &c->body, &p->softness, m->seen, m->other);
}

/* The contact after all that the pass has pushed with, and its rows. Motions are read by some at once, so that a device
 * waits for their memory once. */
SHARED void see_by_paths(const articulation *t, link_contact *c, tree_freedoms *z)
{
  see_velocities(c);
  c->body.velocity = add_motions(c->body.velocity, no_motion()); /* -0 becomes 0, to which adding 0 does nothing */
  seen_paths p = paths_of_contact(t, c);
  list_freedoms(z, freedoms_of_either(&p.seen, &p.other));
  for (uint first = 0u; first < z->rows; first += PATH_CHUNK) {
    freedom_motions motions[PATH_CHUNK];
    for (uint n = 0u; n < PATH_CHUNK; ++n)
      if (first + n < z->rows) motions[n] = next_motions(t, &p, z->freedom[first + n]);
    for (uint n = 0u; n < PATH_CHUNK; ++n)
      if (first + n < z->rows) see_motions(c, z, &p, &motions[n], first + n);
  }
  c->body.response = add_symmetric6(c->body.inverse, p.softness);
}

SHARED void push_by_paths_if(mask wanted, tree_freedoms *z, spatial_force f)
{
  for (uint n = 0u; n < z->rows; ++n) {
    uint freedom = z->freedom[n];
    real change = z->change[freedom] + power_of(f, z->row[n]);
    z->change[freedom] = choose(wanted & has_freedom(z->moved, freedom), change, z->change[freedom]);
  }
}

/* Those of a pass that is not the warm start move the tree. */
SHARED void begin_moving_if(mask touches, const articulation *t, GLOBAL uint *tree_colors)
{
  settle_if_pending(touches, t);
  make_paths_if(touches, t, tree_colors);
}

SHARED void end_moving_if(mask wanted, const articulation *t, const tree_freedoms *z, mask pushed)
{
  leave_pending_if(wanted, t, z);
  note_pushed_if(pushed, t, R(1.0));
}

/* An item is a tree. */
SHARED void solve_tree_contacts_item(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                                     read_turning_bodies bodies, read_links links, GLOBAL const uint *counts,
                                     write_link_states states, write_contact_impulses contact_impulses,
                                     GLOBAL float4 *solver_velocity, GLOBAL float4 *warm_start_impulse, uint pass,
                                     item_index i)
{
  uint_lanes tree = i, listed = load_uint(states.colors, TREE_COLOR_WORDS * tree + 3u);
  if (!any_of(listed > 0u)) return;
  articulation t = articulation_in_pass(links, states, tree, pass);
  listed = choose(has_links(&t), listed, (uint_lanes)0u);
  mask touches = listed > 0u, pushed = touches & !touches;
  uint moves = pass != (uint)PASS_WARM_STARTING ? 1u : 0u;
  tree_freedoms z;
  begin_freedoms(&t, &z);
  if (moves) begin_moving_if(touches, &t, states.colors);
  articulation own = t; /* known to no function that is called */
  for (uint n = 0u; any_of(n < listed); ++n) {
    mask wanted = n < listed;
    uint_lanes at = choose(wanted, load_uint(states.contact, TREE_COLORS * tree + n), (uint_lanes)0u);
    link_contact c = load_tree_contact(wanted, parameters, &own, contacts, patches, bodies, links, solver_velocity, at);
    if (moves) see_by_paths(&own, &c, &z);
    run_pass_of_link_contact(parameters, &c, patches, planes_of(counts), contact_impulses, warm_start_impulse,
                             kind_of_pass(pass), at);
    mask pushes = wanted & is_push(c.body.pushed);
    if (any_of(pushes)) push_by_paths_if(pushes, &z, c.body.pushed);
    pushed = pushed | pushes;
  }
  if (moves) end_moving_if(touches, &t, &z, pushed);
}

#endif
