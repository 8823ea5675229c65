/* joint_impulses.cpp - see joint_impulses.h. */
#include "host/world/joint_impulses.h"

#include <algorithm>

namespace tandem {
namespace {

/* What the next step will write, which is the other side of a carried buffer. */
Buffer other_side_of(Buffer buffer) { return buffer_at(index_of(buffer) + 1); }

} // namespace

JointImpulses::JointImpulses(Memory &memory, std::span<const uint32_t> by_place, uint32_t axes)
    : joints_(by_place.size()), rows_{Rows{Buffer::cached_joint_linear_impulse, 1, {}},
                                      Rows{Buffer::cached_joint_angular_impulse, 1, {}},
                                      Rows{Buffer::cached_joint_axis_impulse, axes, {}},
                                      Rows{Buffer::cached_joint_linear_penalty, 1, {}},
                                      Rows{Buffer::cached_joint_angular_penalty, 1, {}},
                                      Rows{Buffer::cached_joint_axis_penalty, axes, {}}}
{
  for (Rows &rows : rows_) {
    if (joints_ == 0 || memory.bytes(rows.buffer) == 0) continue;
    const auto read = memory.read<float4>(rows.buffer, rows.planes * joints_);
    rows.by_joint.resize(read.size());
    for (size_t row = 0; row < read.size(); ++row)
      rows.by_joint[row - row % joints_ + by_place[row % joints_]] = read[row];
  }
}

void JointImpulses::forget(uint32_t joint)
{
  for (Rows &rows : rows_)
    for (size_t row = joint; joint < joints_ && row < rows.by_joint.size(); row += joints_) rows.by_joint[row] = {};
}

float4 JointImpulses::of(const Rows &rows, uint32_t joint, uint32_t plane) const
{
  const size_t row = plane * joints_ + joint;
  return joint < joints_ && row < rows.by_joint.size() ? rows.by_joint[row] : float4{0, 0, 0, 0};
}

void JointImpulses::stage(StagedUploads &uploads, std::span<const uint32_t> by_place, uint32_t axes) const
{
  for (const Rows &rows : rows_) {
    const uint32_t planes = row_of(rows.buffer).capacity == Capacity::JOINT_AXES ? axes : 1;
    std::vector<float4> staged;
    staged.reserve(planes * by_place.size());
    for (uint32_t plane = 0; plane < planes; ++plane)
      for (const uint32_t joint : by_place) staged.push_back(of(rows, joint, plane));
    uploads.add(other_side_of(rows.buffer), staged);
    uploads.add(rows.buffer, std::move(staged));
  }
}

} // namespace tandem
