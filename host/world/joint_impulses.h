/* joint_impulses.h - the impulses that joints hand on to the next step, and with avbd the penalties, by joint of the
 * scene, while joints change their places in the buffers (host/world/joint_order.h). */
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/runtime/memory.h"
#include "host/scene/staged_uploads.h"
#include "shared/platform.h"

namespace tandem {

class JointImpulses {
public:
  /* Reads them. by_place: the joints in the order of the buffers; axes: JointGraph::axes. */
  JointImpulses(Memory &memory, std::span<const uint32_t> by_place, uint32_t axes);

  void forget(uint32_t joint); /* it begins with none */
  /* Of a joint, or 0 where it has none; axis: of those that it limits, drives or brakes. */
  float4 linear(uint32_t joint) const { return of(rows_[0], joint, 0); }
  float4 angular(uint32_t joint) const { return of(rows_[1], joint, 0); }
  float4 axis(uint32_t joint, uint32_t axis) const { return of(rows_[2], joint, axis); }
  /* For joints in a new order; also into what the next step will write, which leaves the rows of joints that sleep or
   * are not enabled. */
  void stage(StagedUploads &uploads, std::span<const uint32_t> by_place, uint32_t axes) const;

private:
  struct Rows {
    Buffer buffer;
    uint32_t planes;
    std::vector<float4> by_joint; /* plane after plane */
  };
  float4 of(const Rows &rows, uint32_t joint, uint32_t plane) const;

  size_t joints_;
  std::array<Rows, 6> rows_; /* impulses, then penalties: linear, angular, of axes */
};

} // namespace tandem
