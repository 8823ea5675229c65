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
 * another in the order of their colours: a tree of 25 contacts needs one launch a pass instead of 25.
 *
 *     prepare_tree_paths      a tree      its table of paths (path.h), where it stands
 *     project_tree_contacts   a contact   its rows, in the freedoms of the tree (contact_rows.h)
 *     solve_tree_contacts     a tree      its contacts, one after another; z, what they push its freedoms with
 *
 * What two links of one tree do to each other through it is exact. A tree is mixed if a contact of it has another body
 * that moves, or no colour of its own, or if it has no table; then all of its contacts walk, by colour (contact.h).
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_TREE_CONTACTS_H
#define TANDEM_SHARED_ARTICULATIONS_TREE_CONTACTS_H

#include "shared/articulations/contact_rows.h"

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

/* --- between passes ------------------------------------------------------------------------------------------- */
/* An item is a tree. The first pass in which it stands where it does makes its table of paths. */
SHARED void prepare_tree_paths_item(read_links links, write_link_states states, uint pass, item_index i)
{
  uint_lanes word = TREE_COLOR_WORDS * (uint_lanes)i, listed = load_uint(states.colors, word + 3u);
  if (!any_of(listed > 0u)) return;
  articulation t = articulation_in_pass(links, states, i, pass);
  mask touches = (listed > 0u) & has_links(&t);
  settle_if_pending(touches, &t);
  mask missing = load_uint(states.colors, word) == (uint_lanes)(uint)PATHS_ARE_MISSING;
  if (any_of(touches & missing)) prepare_paths_if(touches & missing, &t);
  store_uint_if(touches, states.colors, word,
                choose(missing, (uint_lanes)(uint)PATHS_ARE_NEW, (uint_lanes)(uint)PATHS_ARE_KEPT));
}

/* An item is a tree. What its contacts have borne is a force on its links in the next substep. */
SHARED void warm_start_tree_contacts_item(GLOBAL const Parameters *parameters, read_contacts contacts,
                                          read_patches patches, read_turning_bodies bodies, read_links links,
                                          GLOBAL const uint *counts, write_link_states states,
                                          write_contact_impulses contact_impulses, GLOBAL const float4 *solver_velocity,
                                          GLOBAL float4 *warm_start_impulse, item_index i)
{
  uint_lanes tree = i, listed = load_uint(states.colors, TREE_COLOR_WORDS * tree + 3u);
  if (!any_of(listed > 0u)) return;
  articulation t = articulation_at(links, states, tree);
  listed = choose(has_links(&t), listed, (uint_lanes)0u);
  for (uint n = 0u; any_of(n < listed); ++n) {
    mask wanted = n < listed;
    uint_lanes at = choose(wanted, load_uint(states.contact, TREE_COLORS * tree + n), (uint_lanes)0u);
    link_contact c = load_tree_contact(wanted, parameters, &t, contacts, patches, bodies, links, solver_velocity, at);
    warm_start_link_contact(parameters, &c, patches, planes_of(counts), contact_impulses, warm_start_impulse, at);
  }
}

#endif
