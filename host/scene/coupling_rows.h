/* coupling_rows.h - what kernels are told of a coupling: the coordinates, and the row of shared/joints/couplings.h. */
#pragma once

#include <cstdint>

#include <tandem/scene.h>

namespace tandem {

struct CouplingRow {
  uint32_t kind_a, kind_b; /* JOINT_AXIS_ of joint_codes.h; JOINT_AXIS_NONE if the joint has no such coordinate */
  double of_a, of_b, offset;
  double period;  /* 0: none */
  bool one_sided; /* the value of the row is at least 0 */
};

/* The joints of the coupling exist. */
TANDEM_API CouplingRow row_of(const Coupling &coupling, const Scene &scene);

} // namespace tandem
