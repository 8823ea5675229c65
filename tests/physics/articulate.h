/* All joints of a scene of a test as one articulation. */
#ifndef TANDEM_TESTS_PHYSICS_ARTICULATE_H
#define TANDEM_TESTS_PHYSICS_ARTICULATE_H

#include "tests/physics/physics.h"

namespace tandem::physics_tests {

/* root: of a tree that is free. */
inline void articulate(Scene &scene, uint32_t root = no_body)
{
  Articulation tree;
  tree.root = root;
  for (uint32_t k = 0; k < scene.joints.size(); ++k) tree.joints.push_back(k);
  scene.articulations = {tree};
}

} // namespace tandem::physics_tests

#endif
