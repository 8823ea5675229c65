/* joint_readings.cpp - forces, angles and speeds of joints, computed on the host from the bodies and from the impulses
 * of the last step. */
#include "host/geometry/rotation.h"
#include "host/scene/body_records.h"
#include "host/scene/joint_rows.h"
#include "host/world/implementation.h"
#include "host/world/joint_coordinates.h"
#include "shared/joints/joint_codes.h"

namespace tandem {
namespace {

Vector vector_of_row(const float4 &row) { return {row.x, row.y, row.z}; }
Rotation rotation_in_double(const Quat &q) { return unit(Rotation{q[0], q[1], q[2], q[3]}); }

/* One side of a joint; the world is at rest at its origin. */
struct Side {
  Vector center, velocity, spin;
  Vector origin; /* of the frame */
  Rotation axes;

  Side(const std::vector<PreciseBodyState> &states, uint32_t body, const Point &position, const Quat &orientation)
      : origin(vector_of(position)), axes(rotation_in_double(orientation))
  {
    if (body == no_body) return;
    const PreciseBodyState &state = states[body];
    const Rotation turned = unit(state.orientation);
    center = vector_of(state.position);
    velocity = vector_of(state.linear_velocity);
    spin = vector_of(state.angular_velocity);
    origin = center + turn(turned, origin);
    axes = product_of(turned, axes);
  }
  Vector velocity_at(const Vector &point) const { return velocity + spin.cross(point - center); }
};

struct JointWrench {
  Vector force, torque;
};

class Reader {
public:
  Reader(const Joint &joint, const std::vector<PreciseBodyState> &states)
      : joint_(joint), a_(states, joint.body_a, joint.position_a, joint.orientation_a),
        b_(states, joint.body_b, joint.position_b, joint.orientation_b), frames_{array_of(b_.origin - a_.origin),
                                                                                 a_.axes, b_.axes}
  {}

  /* rate: of substeps, 1/s. */
  JointReading read(const JointImpulses &impulses, uint32_t joint, double rate) const
  {
    JointReading reading;
    read_coordinates(reading);
    const HeldAxes held = held_by(joint_);
    Vector linear = vector_of_row(impulses.linear(joint)),
           angular = turn(a_.axes, vector_of_row(impulses.angular(joint)));
    if (held.directions != JOINT_XYZ) linear = turn(a_.axes, linear);
    const std::vector<UsedAxis> used = axes_used_by(joint_);
    for (uint32_t k = 0; k < used.size(); ++k) {
      const CoordinateOfFrames c = coordinate_of(frames_, used[k].kind);
      const float4 kept = impulses.axis(joint, k); /* drive, limit and friction */
      const double sum = double{kept.x} + double{kept.y} + double{kept.z};
      linear += sum * vector_of(c.direction);
      angular += sum * vector_of(c.turn);
    }
    reading.force = array_of(rate * linear);
    reading.torque = array_of(rate * angular);
    return reading;
  }

  /* on_link: what the joint of a tree puts on its link, which is one of the bodies, at the origin of its frame. */
  void add(JointReading &reading, const JointWrench &on_link, bool link_is_b) const
  {
    const Vector force = link_is_b ? on_link.force : -on_link.force;
    Vector torque = link_is_b ? on_link.torque : -on_link.torque;
    if (!link_is_b) torque += (a_.origin - b_.origin).cross(force);
    reading.force = array_of(vector_of(reading.force) + force);
    reading.torque = array_of(vector_of(reading.torque) + torque);
  }

private:
  void read_coordinates(JointReading &reading) const
  {
    const Vector closing = b_.velocity_at(b_.origin) - a_.velocity_at(b_.origin), turning = b_.spin - a_.spin;
    const std::array<uint32_t, 6> kinds = axis_kinds_of(joint_);
    for (size_t k = 0; k < kinds.size(); ++k) {
      if (kinds[k] == JOINT_AXIS_NONE) continue;
      const CoordinateOfFrames c = coordinate_of(frames_, kinds[k]);
      (k < 3 ? reading.directions[k] : reading.rotations[k - 3]) = c.value;
      (k < 3 ? reading.direction_speeds[k] : reading.rotation_speeds[k - 3]) =
          vector_of(c.direction).dot(closing) + vector_of(c.turn).dot(turning);
    }
  }

  const Joint &joint_;
  Side a_, b_;
  JointFrames frames_;
};

/* What the joints of trees have put on their links, by index of the body; none before the first step. */
class TreeForces {
public:
  TreeForces(Memory &memory, size_t bodies)
  {
    if (memory.bytes(Buffer::body_joint_force) > 0) rows_ = memory.read<float4>(Buffer::body_joint_force, 2 * bodies);
  }
  JointWrench on(uint32_t body) const
  {
    if (rows_.empty()) return {};
    return {vector_of_row(rows_[2 * body]), vector_of_row(rows_[2 * body + 1])};
  }

private:
  std::vector<float4> rows_;
};

} // namespace

std::vector<JointReading> World::Implementation::read_joints(std::span<const JointId> ids)
{
  settle();
  const std::vector<uint32_t> joints = slots_of_joints("read_joints", ids);
  if (joints.empty()) return {};
  const std::vector<PreciseBodyState> states = download_precise_bodies(memory, special.order);
  const JointImpulses impulses(memory, joint_order.joints(), joint_graph.axes);
  const double rate = plan.substeps.of_cache / double{settings.step};
  const TreeForces of_trees(memory, settings.tree_joint_forces ? bodies() : 0);
  std::vector<JointReading> readings;
  readings.reserve(joints.size());
  for (const uint32_t slot : joints) {
    const Joint &joint = scene.joints[slot];
    JointReading &reading = readings.emplace_back();
    if (!joint.enabled) continue;
    const Reader reader(joint, states);
    reading = reader.read(impulses, slot, rate);
    if (!is_in_tree(slot)) continue;
    const uint32_t link = links.body_of_joint[slot];
    if (settings.tree_joint_forces) reader.add(reading, of_trees.on(index_of_body[link]), link == joint.body_b);
    else reading.force.fill(std::nan("")), reading.torque.fill(std::nan(""));
  }
  return readings;
}

} // namespace tandem
