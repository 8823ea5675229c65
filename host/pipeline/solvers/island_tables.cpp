/* island_tables.cpp - reads what has changed of joints and couplings, and writes impulses; see island_tables.h. */
#include "host/pipeline/solvers/island_tables.h"

#include <bit>

namespace tandem {
namespace {

using in_double::float4;

/* Reads a buffer of so many elements if it may have changed. Lists have room for all that the buffer has, so that only
 * a larger buffer allocates. */
class Reader {
public:
  Reader(Memory &memory, ChangedBuffers &changed) : memory_(memory), changed_(changed) {}

  void read(Buffer buffer, size_t count, std::vector<uint32_t> &list)
  {
    if (take(buffer, count, sizeof(uint32_t), list)) memory_.download(buffer, list.data(), count * sizeof(uint32_t));
  }
  void read(Buffer buffer, size_t count, std::vector<double> &list)
  {
    if (take(buffer, count, sizeof(float), list)) memory_.read_reals(buffer, list.data(), count);
  }
  void read(Buffer buffer, size_t count, std::vector<float4> &list)
  {
    if (take(buffer, count, 4 * sizeof(float), list))
      memory_.read_reals(buffer, reinterpret_cast<double *>(list.data()), 4 * count);
  }
  bool any() const { return any_; }

private:
  template <class Element> bool take(Buffer buffer, size_t count, size_t element_bytes, std::vector<Element> &list)
  {
    list.reserve(memory_.bytes(buffer) / element_bytes);
    if (count != list.size()) changed_.forget(buffer);
    list.resize(count);
    if (count == 0 || !changed_.take(memory_, buffer)) return false;
    return any_ = true;
  }

  Memory &memory_;
  ChangedBuffers &changed_;
  bool any_ = false;
};

} // namespace

bool JointTables::read_graph(Memory &memory, ChangedBuffers &changed, const in_double::Parameters &parameters,
                             const uint32_t *counts)
{
  const size_t axes = HAS_FEATURE(&parameters, JOINT_AXES) ? size_t{parameters.joints} * parameters.joint_axes : 0;
  const uint32_t joints = HAS_FEATURE(&parameters, JOINTS) ? counts[COUNT_JOINTS] : 0,
                 couplings = HAS_FEATURE(&parameters, COUPLINGS) ? counts[COUNT_COUPLINGS] : 0;
  const bool resized = joints != joint_count || couplings != coupling_count || axes != axes_;
  joint_count = joints;
  coupling_count = couplings;
  axes_ = axes;
  frames_ = HAS_FEATURE(&parameters, JOINT_FRAMES);
  most_ = (memory.bytes(Buffer::joint_a) + memory.bytes(Buffer::coupling_a)) / sizeof(uint32_t);
  Reader reader(memory, changed);
  reader.read(Buffer::joint_a, joints, a);
  reader.read(Buffer::joint_b, joints, b);
  reader.read(Buffer::joint_modes, joints, modes);
  reader.read(Buffer::joint_axis_kind, axes, axis_kind);
  reader.read(Buffer::coupling_a, couplings, coupling_a);
  reader.read(Buffer::coupling_b, couplings, coupling_b);
  if (!resized && !reader.any()) return false;
  count_rows(parameters.joints, memory.bytes(Buffer::joint_a) / sizeof(uint32_t));
  return true;
}

/* An axis has a drive, friction, and two ends of its limits and its speed. */
void JointTables::count_rows(size_t stride, size_t most)
{
  rows.reserve(most);
  rows.resize(joint_count);
  for (size_t i = 0; i < joint_count; ++i) {
    rows[i] = static_cast<uint32_t>(std::popcount(modes[i]));
    for (size_t k = i; k < axes_; k += stride)
      if (axis_kind[k] != in_double::JOINT_AXIS_NONE) rows[i] += 6;
  }
}

void JointTables::read_rest(Memory &memory, ChangedBuffers &changed)
{
  Reader reader(memory, changed);
  const size_t framed = frames_ ? joint_count : 0;
  reader.read(Buffer::joint_arm_a, joint_count, arm_a);
  reader.read(Buffer::joint_arm_b, joint_count, arm_b);
  reader.read(Buffer::joint_frame_a, framed, frame_a);
  reader.read(Buffer::joint_frame_b, framed, frame_b);
  reader.read(Buffer::joint_offset, joint_count, offset);
  reader.read(Buffer::joint_axis_row, 3 * axes_, axis_row);
  reader.read(Buffer::joint_linear_impulse, joint_count, linear);
  reader.read(Buffer::joint_angular_impulse, framed, angular);
  reader.read(Buffer::joint_axis_impulse, axes_, axis);
  reader.read(Buffer::coupling_kind, coupling_count, coupling_kind);
  reader.read(Buffer::coupling_row, coupling_count, coupling_row);
  reader.read(Buffer::coupling_impulse, coupling_count, coupling_impulse);
}

void JointTables::write(Memory &memory, ChangedBuffers &changed) const
{
  const auto write_rows = [&](Buffer buffer, const std::vector<float4> &rows, size_t count) {
    if (count == 0) return;
    memory.write_reals(buffer, reinterpret_cast<const double *>(rows.data()), 4 * count, 0);
    changed.forget(buffer);
  };
  write_rows(Buffer::joint_linear_impulse, linear, joint_count);
  write_rows(Buffer::joint_angular_impulse, angular, frames_ ? joint_count : 0);
  write_rows(Buffer::joint_axis_impulse, axis, axes_);
  if (coupling_count == 0) return;
  memory.write_reals(Buffer::coupling_impulse, coupling_impulse.data(), coupling_count, 0);
  changed.forget(Buffer::coupling_impulse);
}

} // namespace tandem
