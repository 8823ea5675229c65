/* link_rows.h - a link of a tree as the rows of numbers that shared/articulations/ reads, in double precision. */
#pragma once

#include <array>
#include <cstdint>

#include <tandem/scene.h>

#include "host/scene/articulation_order.h"
#include "shared/articulations/joint_types.h"

namespace tandem {

struct LinkRows {
  uint32_t code;                                        /* joint and parent: shared/articulations/joint_types.h */
  std::array<uint32_t, PATH_WORDS> freedom;             /* of a tree of more than TREE_FREEDOMS none of its bits */
  std::array<std::array<double, 4>, LINK_AXIS> numbers; /* the rows before LINK_AXIS; no drive is implicit */
  std::array<double, 3> ground;                         /* of a root that is held: its frame a in the world */
};

/* About the principal axes, kg m^2. */
std::array<double, 3> moments_of_link(const Scene &scene, const Body &body);

/* Its joint and its parent. */
uint32_t code_of_link(const OrderedLink &link);
LinkRows rows_of_link(const Scene &scene, const OrderedLink &link);

} // namespace tandem
