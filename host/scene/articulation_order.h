/* articulation_order.h - the links of an articulation in the order of its tree, and the refusal of what is none. */
#pragma once

#include <string>
#include <vector>

#include <tandem/articulations.h>

namespace tandem {

/* A link with its joint as seen from its parent: frame a is on the parent, or in the world, and frame b on the link. */
struct OrderedLink {
  ArticulationLink link;
  JointType type = JointType::ball; /* fixed, hinge, slider or ball; of a free root meaningless */
  bool is_free = false;
  Point position_a{0, 0, 0}, position_b{0, 0, 0};
  Quat orientation_a{0, 0, 0, 1}, orientation_b{0, 0, 0, 1};
  JointAxis axis; /* of one degree of freedom, or of all three of a ball */
  float armature = 0;
  uint64_t path = 0;         /* a bit for each velocity of the joints between it and the root, its own among them */
  uint32_t path_entries = 0; /* how many come before its own */
};

/* Whether the joint is a ball for a tree: one that holds all directions and no rotation. */
bool is_ball_of_tree(const Joint &joint);

/* Whether the tree holds the ball alone, and the rows of its axes are those of a joint between its links
 * (shared/articulations/joint.h): of all balls but those with one stiffness and one damping about all axes. */
bool has_rows_besides_tree(const Joint &joint);

/* The axis of a joint that a tree drives, limits and brakes. */
JointAxis axis_of_tree(const Joint &joint);

/* After each link come those beyond the first of its joints, as Articulation::joints has them, then those beyond the
 * second, and so on: the way of a sweep (shared/articulations/sweep.h). */
std::vector<OrderedLink> ordered_links_of(const Scene &scene, const Articulation &articulation,
                                          const std::string &where);

} // namespace tandem
