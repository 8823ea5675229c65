/* island_tables.h - joints and couplings as the stage solve_islands reads and writes them, in double on the host; of
 * contacts: island_rows.h. A scene without joints has none of this. */
#pragma once

#include <cstdint>
#include <vector>

#include "host/pipeline/solvers/changed_buffers.h"
#include "host/pipeline/solvers/in_double.h"

namespace tandem {

class JointTables {
public:
  using float4 = in_double::float4;

  /* Reads which bodies joints connect; returns whether any of it may be new. */
  bool read_graph(Memory &memory, ChangedBuffers &changed, const in_double::Parameters &parameters,
                  const uint32_t *counts);
  void read_rest(Memory &memory, ChangedBuffers &changed);
  void write(Memory &memory, ChangedBuffers &changed) const;

  in_double::read_joints joints() const
  {
    return {a.data(),     b.data(),       modes.data(),   arm_a.data(),
            arm_b.data(), frame_a.data(), frame_b.data(), offset.data()};
  }
  in_double::read_joint_axes axes() const { return {axis_kind.data(), axis_row.data()}; }
  in_double::read_couplings couplings() const
  {
    return {coupling_a.data(), coupling_b.data(), coupling_kind.data(), coupling_row.data()};
  }

  /* Of joints and couplings together, for which buffers have room. */
  size_t most() const { return most_; }

  uint32_t joint_count = 0, coupling_count = 0; /* of those awake */
  std::vector<uint32_t> rows;                   /* of each joint, at most */
  std::vector<uint32_t> a, b, modes, axis_kind, coupling_a, coupling_b, coupling_kind;
  std::vector<float4> arm_a, arm_b, frame_a, frame_b, offset, axis_row, linear, angular, axis, coupling_row;
  std::vector<double> coupling_impulse;

private:
  void count_rows(size_t stride, size_t most);

  size_t axes_ = 0; /* planes times joints */
  size_t most_ = 0;
  bool frames_ = false;
};

} // namespace tandem
