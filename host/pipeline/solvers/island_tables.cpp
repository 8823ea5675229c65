/* island_tables.cpp - reads what has changed of joints and couplings, and writes impulses; see island_tables.h. */
#include "host/pipeline/solvers/island_tables.h"

namespace tandem {
namespace {

using in_double::float4;

/* Reads a buffer of so many elements if it may have changed. */
class Reader {
public:
  Reader(Memory &memory, ChangedBuffers &changed) : memory_(memory), changed_(changed) {}

  void read(Buffer buffer, size_t count, std::vector<uint32_t> &list)
  {
    if (count == 0 || !take(buffer)) return;
    list.resize(count);
    memory_.download(buffer, list.data(), count * sizeof(uint32_t));
  }
  void read(Buffer buffer, size_t count, std::vector<double> &list)
  {
    if (count == 0 || !take(buffer)) return;
    list.resize(count);
    memory_.read_reals(buffer, list.data(), count);
  }
  void read(Buffer buffer, size_t count, std::vector<float4> &list)
  {
    if (count == 0 || !take(buffer)) return;
    list.resize(count);
    memory_.read_reals(buffer, reinterpret_cast<double *>(list.data()), 4 * count);
  }
  bool any() const { return any_; }

private:
  bool take(Buffer buffer)
  {
    const bool taken = changed_.take(memory_, buffer);
    any_ |= taken;
    return taken;
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
  if (resized) changed.forget_all();
  joint_count = joints;
  coupling_count = couplings;
  axes_ = axes;
  frames_ = HAS_FEATURE(&parameters, JOINT_FRAMES);
  Reader reader(memory, changed);
  reader.read(Buffer::joint_a, joints, a);
  reader.read(Buffer::joint_b, joints, b);
  reader.read(Buffer::joint_modes, joints, modes);
  reader.read(Buffer::joint_axis_kind, axes, axis_kind);
  reader.read(Buffer::coupling_a, couplings, coupling_a);
  reader.read(Buffer::coupling_b, couplings, coupling_b);
  return resized || reader.any();
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
