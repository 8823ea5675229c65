/* articulation.h - which joints of a scene are coordinates of a tree of links (articulations.h). */
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tandem/no_body.h>

namespace tandem {

/* The joints of a scene that are to be coordinates of a tree. They are fixed joints, hinges, sliders, and joints that
 * hold all directions and no rotation (ball, cone_twist, such a six_dof), and connect dynamic bodies without a loop; at
 * most one of them holds the tree to the world or to a fixed body. Without such a joint the tree is free. Other joints
 * of the scene may close loops of its links, or hold them otherwise. */
struct Articulation {
  std::string name;
  std::vector<uint32_t> joints; /* indices into Scene::joints, in any order */
  uint32_t root = no_body;      /* of a free tree: the body that is its root; no_body: the first of its bodies */
  /* What the rotors of a joint's motor add to its inertia, kg m^2 or kg, at least 0; of each joint, or none. */
  std::vector<float> armatures;
};

} // namespace tandem
