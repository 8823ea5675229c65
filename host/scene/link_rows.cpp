/* link_rows.cpp - see link_rows.h. */
#include "host/scene/link_rows.h"

#include "host/geometry/rotation.h"
#include "host/scene/specialise.h"

namespace tandem {
namespace {

using Row = std::array<double, 4>;

template <class Vector> Row row_of(const Vector &v, double w) { return {double(v[0]), double(v[1]), double(v[2]), w}; }

/* Of unit length to the rounding of doubles, since a scene has floats. */
Rotation rotation_of(const Quat &q) { return unit(Rotation{q[0], q[1], q[2], q[3]}); }
Row row_of(const Rotation &q) { return {q[0], q[1], q[2], q[3]}; }

uint32_t joint_code(const OrderedLink &l)
{
  if (l.is_free) return TREE_JOINT_FREE;
  switch (l.type) {
  case JointType::hinge: return TREE_JOINT_HINGE;
  case JointType::slider: return TREE_JOINT_SLIDER;
  case JointType::ball: return TREE_JOINT_BALL;
  default: return TREE_JOINT_FIXED;
  }
}

bool is_held_root(const OrderedLink &l) { return l.link.parent == ArticulationLink::none && !l.is_free; }

/* Frame a of a root that is held stands in the world, or in a fixed body. */
void find_ground(const Scene &scene, const OrderedLink &l, LinkRows &rows)
{
  const Joint &joint = scene.joints[l.link.joint];
  const uint32_t base = joint.body_a == l.link.body ? joint.body_b : joint.body_a;
  rows.numbers[LINK_FRAME_A] = {0, 0, 0, l.armature};
  rows.ground = {l.position_a[0], l.position_a[1], l.position_a[2]};
  if (base == no_body) return;
  const Body &body = scene.bodies[base];
  const Rotation turned = rotation_of(body.orientation);
  const Vector arm = turn(turned, Vector(l.position_a[0], l.position_a[1], l.position_a[2]));
  rows.ground = {body.position[0] + arm.x, body.position[1] + arm.y, body.position[2] + arm.z};
  rows.numbers[LINK_FRAME_A_ORIENTATION] = row_of(product_of(turned, rotation_of(l.orientation_a)));
}

} // namespace

std::array<double, 3> moments_of_link(const Scene &scene, const Body &body)
{
  const Vec3 inverse = inverse_inertia_of(scene, body);
  return {1.0 / inverse[0], 1.0 / inverse[1], 1.0 / inverse[2]};
}

uint32_t code_of_link(const OrderedLink &l)
{
  const uint32_t parent = l.link.parent == ArticulationLink::none ? LINK_NO_PARENT : l.link.parent;
  return parent | joint_code(l) << LINK_JOINT_SHIFT;
}

LinkRows rows_of_link(const Scene &scene, const OrderedLink &l)
{
  const Body &body = scene.bodies[l.link.body];
  LinkRows rows{};
  rows.code = code_of_link(l);
  rows.freedom = {uint32_t(l.path & UINT32_MAX), uint32_t(l.path >> 32), l.path_entries, l.link.first_velocity};
  rows.numbers[LINK_FRAME_A] = row_of(l.position_a, l.armature);
  rows.numbers[LINK_FRAME_A_ORIENTATION] = row_of(rotation_of(l.orientation_a));
  rows.numbers[LINK_FRAME_B] = row_of(l.position_b, body.mass);
  rows.numbers[LINK_FRAME_B_ORIENTATION] = row_of(rotation_of(l.orientation_b));
  rows.numbers[LINK_MOMENTS] = row_of(moments_of_link(scene, body), 0);
  if (is_held_root(l)) find_ground(scene, l, rows);
  return rows;
}

} // namespace tandem
