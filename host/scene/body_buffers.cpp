/* body_buffers.cpp - packs the rows of bodies and their shapes; see body_buffers.h. */
#include "host/scene/body_buffers.h"

#include <cmath>

#include <tandem/round_to_float.h>

#include "host/geometry/shape_mass.h"
#include "host/scene/hull_buffers.h"
#include "host/scene/joint_buffers.h"
#include "host/scene/shape_bounds.h"
#include "host/scene/specialise.h"
#include "host/scene/tree_tables.h"
#include "shared/body_codes.h"

namespace tandem {
namespace {

/* A shape as it is placed in a body: the body's own, or a child of its compound. */
struct PlacedShape {
  const Body *body;
  const Shape *shape;
  Vec3 size;
  Vec3 position;
  Quat orientation;
  uint32_t code, material;
  Filter filter;
  float radius; /* of the whole body: kernels do not read that of a child */
};

PlacedShape shape_of_body(const Scene &scene, const Body &body)
{
  return {&body,
          &scene.shapes[body.shape],
          kernel_size(scene.shapes[body.shape]),
          body.shape_position,
          body.shape_orientation,
          shape_code(scene, body),
          body.material,
          filter_of(scene, body),
          bounding_radius(scene, body)};
}

/* Kernels take a ball of a compound for a capsule, of no length. */
Vec3 size_of_child(const Shape &shape)
{
  const Vec3 size = kernel_size(shape);
  return shape.type == ShapeType::sphere ? Vec3{size[0], 0, size[0]} : size;
}

PlacedShape shape_of_child(const Body &body, const Child &child)
{
  const ShapePlace place = place_of_child(body, child);
  const auto &[x, y, z] = place.position;
  const auto &[qx, qy, qz, qw] = place.orientation;
  return {&body,
          &child.shape,
          size_of_child(child.shape),
          {round_to_float(x), round_to_float(y), round_to_float(z)},
          {round_to_float(qx), round_to_float(qy), round_to_float(qz), round_to_float(qw)},
          shape_code(body, child),
          child.material.value_or(body.material),
          filter_of(body, child),
          0};
}

uint32_t flags_of(const PlacedShape &placed)
{
  return placed.code | static_cast<uint32_t>(placed.body->type) << 3 | placed.material << 8 |
         (placed.body->trigger ? uint32_t{BODY_FLAG_TRIGGER} : 0u) |
         (placed.body->continuous ? uint32_t{BODY_FLAG_CONTINUOUS} : 0u);
}

/* A slot without a body: a point that takes part in nothing. */
constexpr uint32_t flags_of_free_slot = uint32_t{BODY_TYPE_QUARANTINED} << 3 | uint32_t{SHAPE_SPHERE};

/* The rows of consecutive shapes that depend on properties of their bodies. */
class PropertyRows {
public:
  explicit PropertyRows(const Scene &scene) : scene_(scene), joined_(joined_bodies(scene)) {}

  void add(const PlacedShape &placed, BodyStatus status)
  {
    const uint32_t flags = flags_of(placed) | (is_joined(*placed.body) ? uint32_t{BODY_FLAG_JOINED} : 0u);
    flags_.push_back(status == BodyStatus::free          ? flags_of_free_slot
                     : status == BodyStatus::quarantined ? as_absent(flags)
                                                         : flags);
    filters_.insert(filters_.end(), {placed.filter.group, placed.filter.mask});
  }

  /* The flags come last, because they decide whether a body takes part. */
  void stage(StagedUploads &uploads, size_t first)
  {
    uploads.add(Buffer::body_filter, std::move(filters_), first);
    uploads.add(Buffer::body_flags, std::move(flags_), first);
  }

private:
  bool is_joined(const Body &body) const
  {
    return !joined_.empty() && joined_[static_cast<size_t>(&body - scene_.bodies.data())];
  }

  const Scene &scene_;
  std::vector<bool> joined_;
  std::vector<uint32_t> flags_, filters_;
};

/* The rows of consecutive shapes in the buffers of capacity SHAPES. */
class ShapeRows {
public:
  ShapeRows(const Scene &scene, const HullNumbers &hulls) : properties_(scene), hulls_(hulls) {}

  void add(const PlacedShape &placed, BodyStatus status)
  {
    const Shape &shape = *placed.shape;
    const Quat q = unit(placed.orientation);
    const bool is_free = status == BodyStatus::free;
    const ShapeBox box = shape.type == ShapeType::half_space || is_free
                             ? ShapeBox{}
                             : box_around(shape, placed.position, placed.orientation);
    properties_.add(placed, status);
    sizes_.push_back(is_free ? float4{0, 0, 0, 0} : float4_of_vec(placed.size, placed.radius));
    convexes_.insert(convexes_.end(),
                     {static_cast<uint32_t>(shape.type), shape.hull ? hulls_.at(shape.hull.get()) : 0});
    poses_.insert(poses_.end(), {float4_of_vec(placed.position, 0), float4{q[0], q[1], q[2], q[3]},
                                 float4_of_vec(box.center, 0), float4_of_vec(box.half_extents, 0)});
  }

  void stage(StagedUploads &uploads, size_t first)
  {
    uploads.add(Buffer::body_shape, std::move(sizes_), first);
    uploads.add(Buffer::body_convex, std::move(convexes_), first);
    uploads.add(Buffer::body_shape_pose, std::move(poses_), first);
    properties_.stage(uploads, first);
  }

private:
  PropertyRows properties_;
  const HullNumbers &hulls_;
  std::vector<float4> sizes_, poses_;
  std::vector<uint32_t> convexes_;
};

Vec3 velocity_of(const Body &body, const Vec3 &velocity)
{
  return body.type == BodyType::fixed ? Vec3{0, 0, 0} : velocity;
}

} // namespace

float4 float4_of_vec(const Vec3 &v, float w) { return {v[0], v[1], v[2], w}; }

uint32_t as_absent(uint32_t flags) { return (flags & ~(3u << 3)) | uint32_t{BODY_TYPE_QUARANTINED} << 3; }

float inverse_mass_of(const Body &body) { return body.type == BodyType::dynamic ? 1.0f / body.mass : 0.0f; }

std::array<float4, 2> double_float3_of(const Point &p)
{
  const float4 high{round_to_float(p[0]), round_to_float(p[1]), round_to_float(p[2]), 0};
  return {high,
          {round_to_float(p[0] - double{high.x}), round_to_float(p[1] - double{high.y}),
           round_to_float(p[2] - double{high.z}), 0}};
}

Quat unit(const Quat &q)
{
  const double length =
      std::sqrt(double(q[0]) * q[0] + double(q[1]) * q[1] + double(q[2]) * q[2] + double(q[3]) * q[3]);
  if (std::abs(length - 1) < 1e-6) return q;
  return {round_to_float(q[0] / length), round_to_float(q[1] / length), round_to_float(q[2] / length),
          round_to_float(q[3] / length)};
}

namespace {

struct MassRows {
  std::vector<float4> mass;
  std::vector<uint32_t> locks;
  std::vector<float> damping, speeds;

  void add(const Scene &scene, const Body &body)
  {
    mass.push_back(float4_of_vec(inverse_inertia_of(scene, body), body.gravity_factor));
    damping.insert(damping.end(), {body.linear_damping, body.angular_damping});
    locks.push_back(locks_of(body));
    speeds.insert(speeds.end(), {body.max_linear_speed, body.max_angular_speed});
  }
  void stage(StagedUploads &uploads, size_t first)
  {
    uploads.add(Buffer::body_mass, std::move(mass), first);
    uploads.add(Buffer::body_damping, std::move(damping), first);
    uploads.add(Buffer::body_lock, std::move(locks), first);
    uploads.add(Buffer::body_max_speed, std::move(speeds), first);
  }
};

struct StateRows {
  std::vector<float4> position, orientation, velocity;

  void add(const Body &body)
  {
    const Quat q = unit(body.orientation);
    const auto place = double_float3_of(body.position);
    position.insert(position.end(), place.begin(), place.end());
    orientation.push_back({q[0], q[1], q[2], q[3]});
    velocity.push_back(float4_of_vec(velocity_of(body, body.linear_velocity), inverse_mass_of(body)));
    velocity.push_back(float4_of_vec(velocity_of(body, body.angular_velocity), body.gravity_factor));
  }
  void stage(StagedUploads &uploads, size_t first)
  {
    uploads.add(Buffer::body_position, std::move(position), first);
    uploads.add(Buffer::body_orientation, std::move(orientation), first);
    uploads.add(Buffer::body_velocity, std::move(velocity), first);
  }
};

} // namespace

void stage_bodies(StagedUploads &uploads, const Scene &scene, const std::vector<uint32_t> &order)
{
  stage_masses(uploads, scene, order);
  StateRows rows;
  for (const uint32_t body : order) rows.add(scene.bodies[body]);
  rows.stage(uploads, 0);
}

void stage_masses(StagedUploads &uploads, const Scene &scene, const std::vector<uint32_t> &order)
{
  MassRows rows;
  for (const uint32_t body : order) rows.add(scene, scene.bodies[body]);
  rows.stage(uploads, 0);
}

void stage_shapes(StagedUploads &uploads, const Scene &scene, const std::vector<uint32_t> &order, uint32_t first_child,
                  const std::vector<BodyStatus> &status)
{
  const HullNumbers hulls = hull_numbers(scene);
  ShapeRows bodies(scene, hulls), children(scene, hulls);
  for (const uint32_t body : order) bodies.add(shape_of_body(scene, scene.bodies[body]), status_of(status, body));
  for (const uint32_t index : order) {
    const Body &body = scene.bodies[index];
    if (status_of(status, index) == BodyStatus::free) continue;
    const Shape &shape = scene.shapes[body.shape];
    for (uint32_t k = 0; k < children_of(shape); ++k)
      children.add(shape_of_child(body, shape.compound->children[k]), status_of(status, index));
  }
  children.stage(uploads, first_child);
  bodies.stage(uploads, 0);
}

void stage_no_past(StagedUploads &uploads, size_t first, size_t bodies)
{
  uploads.add(Buffer::resting_steps, std::vector<uint32_t>(bodies), first);
  uploads.add(Buffer::cached_standing, std::vector<uint32_t>(2 * bodies), first);
  uploads.add(Buffer::cached_wish, std::vector<uint32_t>(bodies), first);
}

void stage_new_bodies(StagedUploads &uploads, const Scene &scene, const HullNumbers &hulls,
                      std::span<const uint32_t> bodies, uint32_t first)
{
  MassRows masses;
  StateRows states;
  ShapeRows shapes(scene, hulls);
  for (const uint32_t index : bodies) {
    const Body &body = scene.bodies[index];
    masses.add(scene, body);
    states.add(body);
    shapes.add(shape_of_body(scene, body), BodyStatus::present);
  }
  masses.stage(uploads, first);
  uploads.add(Buffer::body_force, std::vector<float4>(2 * bodies.size()), first);
  uploads.add(Buffer::body_tree, std::vector<uint32_t>(2 * bodies.size(), INDEX_NONE), first);
  stage_no_past(uploads, first, bodies.size());
  states.stage(uploads, first);
  shapes.stage(uploads, first);
}

void stage_properties(StagedUploads &uploads, const Scene &scene, std::span<const uint32_t> bodies, uint32_t first,
                      const std::vector<BodyStatus> &status)
{
  MassRows masses;
  PropertyRows properties(scene);
  for (const uint32_t index : bodies) {
    masses.add(scene, scene.bodies[index]);
    properties.add(shape_of_body(scene, scene.bodies[index]), status_of(status, index));
  }
  masses.stage(uploads, first);
  properties.stage(uploads, first);
}

void stage_child_properties(StagedUploads &uploads, const Scene &scene, uint32_t body, uint32_t first_child,
                            const std::vector<BodyStatus> &status)
{
  PropertyRows properties(scene);
  for (const Child &child : scene.shapes[scene.bodies[body].shape].compound->children)
    properties.add(shape_of_child(scene.bodies[body], child), status_of(status, body));
  properties.stage(uploads, first_child);
}

void stage_fixed_rows(StagedUploads &uploads, const Scene &scene, const HullNumbers &hulls, uint32_t body,
                      uint32_t index, BodyStatus status)
{
  MassRows masses;
  ShapeRows shapes(scene, hulls);
  masses.add(scene, scene.bodies[body]);
  shapes.add(shape_of_body(scene, scene.bodies[body]), status);
  masses.stage(uploads, index);
  shapes.stage(uploads, index);
}

void stage_states(StagedUploads &uploads, const Scene &scene, std::span<const uint32_t> bodies, uint32_t first)
{
  StateRows states;
  for (const uint32_t body : bodies) states.add(scene.bodies[body]);
  states.stage(uploads, first);
}

void stage_starts(StagedUploads &uploads, const Scene &scene, std::span<const uint32_t> order, uint32_t first)
{
  StateRows states;
  for (const uint32_t body : order) states.add(scene.bodies[body]);
  std::vector<float4> poses;
  for (size_t i = 0; i < order.size(); ++i)
    poses.insert(poses.end(), {states.position[2 * i], states.position[2 * i + 1], states.orientation[i]});
  uploads.add(Buffer::start_pose, std::move(poses), first);
  uploads.add(Buffer::start_velocity, std::move(states.velocity), first);
}

void stage_free_rows(StagedUploads &uploads, uint32_t first, uint32_t bodies)
{
  const std::vector<float4> zeros(2 * size_t{bodies});
  uploads.add(Buffer::body_flags, std::vector<uint32_t>(bodies, flags_of_free_slot), first);
  uploads.add(Buffer::body_velocity, zeros, first);
  uploads.add(Buffer::body_force, zeros, first);
  uploads.add(Buffer::body_shape, std::vector<float4>(bodies), first);
}

void stage_materials(StagedUploads &uploads, const Scene &scene)
{
  std::vector<float4> rows, rolling;
  for (const Material &material : scene.materials) {
    const float rules =
        static_cast<uint32_t>(material.friction_combine) + 8 * static_cast<uint32_t>(material.restitution_combine);
    rows.push_back({material.static_friction, material.dynamic_friction, material.restitution, rules});
    rolling.push_back({material.rolling_friction, material.spinning_friction, 0, 0});
  }
  uploads.add(Buffer::material, std::move(rows));
  uploads.add(Buffer::material_rolling, std::move(rolling));
}

} // namespace tandem
