/* tree_contacts.h - trees that have all of their contacts for themselves.
 *
 *      tree_contact     tree 0 | 4  7  -  9  - ..      the contact of each colour, of 64
 *                       tree 1 | 5  -  8  -  - ..
 *      tree_colors      tree 0 | 0b1011  0  0  -       a bit for each colour in use, in two words; is it mixed
 *
 *      order_tree_contacts
 *      tree_contact     tree 0 | 4  7  9 ..            in the order of the colours, without gaps, so that trees which
 *                       tree 1 | 5  8  ..              a device solves side by side each have one to solve
 *      tree_colors      tree 0 | 0b1011  0  0  3       how many; 0 of a mixed tree
 *
 * Contacts within one tree, and with what does not move, concern no other tree. An item a tree solves them one after
 * another in the order of their colours, which they would have in launches by colour, so the bits are the same: a tree
 * of 25 contacts needs one launch a pass instead of 25, and finds its own numbers in its cache. A tree is mixed if a
 * contact of it has another body that moves, or no colour of its own; then all of its contacts are solved by colour.
 */
#ifndef TANDEM_SHARED_ARTICULATIONS_TREE_CONTACTS_H
#define TANDEM_SHARED_ARTICULATIONS_TREE_CONTACTS_H

#include "shared/articulations/contact.h"

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
  if (color >= LINK_COLORS || !(within || on_rest)) {
    note_mixed(states, tree_a);
    note_mixed(states, tree_b);
    return;
  }
  states.contact[TREE_COLORS * tree + color] = i;
  ATOMIC_OR(states.colors + TREE_COLOR_WORDS * tree + (color >> 5u), 1u << (color & 31u));
}

/* An item is a tree. */
SHARED void order_tree_contacts_item(write_link_states states, uint i)
{
  GLOBAL uint *colors = states.colors + TREE_COLOR_WORDS * i;
  GLOBAL uint *contact = states.contact + TREE_COLORS * i;
  uint listed = 0u;
  for (uint word = 0u; word < 2u; ++word)
    for (uint color = 32u * word, left = colors[word]; left != 0u; ++color, left >>= 1u)
      if (left & 1u) contact[listed++] = contact[color];
  colors[3] = colors[2] == 0u ? listed : 0u;
}
#endif

/* An item is a tree. */
SHARED void solve_tree_contacts_item(GLOBAL const Parameters *parameters, read_contacts contacts, read_patches patches,
                                     read_turning_bodies bodies, read_links links, GLOBAL const uint *counts,
                                     write_link_states states, write_contact_impulses contact_impulses,
                                     GLOBAL float4 *solver_velocity, GLOBAL float4 *warm_start_impulse, uint pass,
                                     item_index i)
{
  uint_lanes tree = i, listed = load_uint(states.colors, TREE_COLOR_WORDS * tree + 3u);
  for (uint n = 0u; any_of(n < listed); ++n) {
    uint_lanes next = load_uint(states.contact, TREE_COLORS * tree + n);
    solve_link_contact_at(parameters, contacts, patches, bodies, links, counts, states, contact_impulses,
                          solver_velocity, warm_start_impulse, pass, choose(n < listed, next, (uint_lanes)INDEX_NONE));
  }
}

#endif
