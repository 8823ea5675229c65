/* joint_graph.h - the colours of joints, and the order in which kernels have them.
 *
 * Joints are edges of the graph of bodies, as contacts are (shared/batching/coloring.h), but they seldom change. So the
 * host colours them once, each with the lowest colour that is free at both of its bodies, in the order of the scene;
 * contacts take what is left. Joints of a body that has all colours in use are overflow joints: a colour behind all
 * others, solved in order.
 *
 *   colour 0 | hinge hinge slider | colour 1 | ball hinge | ... | overflow | of links: colour 0 | ... | overflow
 *
 * Joints that hold links of articulations from outside of their trees are solved besides contacts, not among them
 * (shared/articulations/joint.h), so they have colours of their own, where a tree is one node. One that holds nothing,
 * and only keeps two bodies from colliding, needs none.
 *
 * Joints that are not enabled have no colour and stand behind all others, where no kernel of a step looks.
 *
 * The joints of one world of a batch have the colours and the order that they have alone. Overflow joints stand world
 * after world (shared/joints/by_world.h).
 */
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <tandem/scene.h>

namespace tandem {

struct JointGraph {
  std::vector<uint32_t> without_rows; /* joints of articulations but for balls with rows besides their tree, and those
                                         of links that hold nothing; they have no colour */
  std::vector<uint32_t> order;       /* joints of the scene by colour; of one colour by type, then by number; those that
                                        are not enabled last */
  std::vector<uint32_t> starts;      /* in that order: the first of each colour and of the overflow joints; the same of
                                        those that hold links, which begin where these end; and the end */
  std::vector<uint32_t> body_colors; /* two words a body of the scene: a bit for each colour in use */
  uint32_t colors = 0;               /* in use; COLOR_LIMIT + 1 if there are overflow joints */
  uint32_t link_colors = 0;          /* the same of joints that hold links */
  uint32_t axes = 0;                 /* the most that a joint limits, drives or brakes */
  /* The size of the table of pairs that do not collide (shared/broadphase/joined_pairs.h): a power of two, or 0 if
   * there are none. */
  uint32_t joined_pairs = 0;
};

/* worlds: of a batch, which have equally many bodies and stand in the scene one after the other. */
JointGraph joint_graph_of(const Scene &scene, uint32_t worlds = 1);

/* One of the bodies of a joint, of which the world is none. */
inline uint32_t some_body_of(const Joint &joint) { return joint.body_a == no_body ? joint.body_b : joint.body_a; }

} // namespace tandem
