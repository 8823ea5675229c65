/* axis_bits.h - a choice of axes as the bits that kernels read: locks of bodies, and what joints hold. */
#pragma once

#include <cstdint>

#include <tandem/axes.h>

#include "shared/body_codes.h"
#include "shared/joints/joint_codes.h"

namespace tandem {

static_assert(int{LOCK_X} == int{JOINT_X} && int{LOCK_Y} == int{JOINT_Y} && int{LOCK_Z} == int{JOINT_Z});

inline uint32_t bits_of(const Axes &axes)
{
  return (axes.x ? uint32_t{LOCK_X} : 0u) | (axes.y ? uint32_t{LOCK_Y} : 0u) | (axes.z ? uint32_t{LOCK_Z} : 0u);
}

} // namespace tandem
