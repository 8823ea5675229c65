/* bodies.h - handles of bodies, and what a program may ask of bodies between two steps: World::create_bodies and the
 * functions after it.
 *
 * A body has an index, its place in Scene::bodies, in lists of events and in hits of queries, and a generation. The
 * index of a destroyed body is used again by a later one of the same kind of bounds, but not before a step has ended
 * its events; the generation then differs, so a handle never refers to another body than the one it was made for. The
 * bodies of the scene itself have their index there and generation 1. The same calls give the same indices on every
 * machine.
 *
 * Calls take effect in the order in which they are made. They are collected and applied together before the next step,
 * or before the world is read (docs/worlds.md).
 */
#pragma once

#include <cstdint>
#include <optional>

#include <tandem/queries.h>
#include <tandem/scene.h>
#include <tandem/shapes.h>

namespace tandem {

struct BodyId {
  uint32_t index = no_body;
  uint32_t generation = 0; /* 0: of no body */
  friend bool operator==(const BodyId &, const BodyId &) = default;
};

/* A shape of a body: see World::shapes_of. */
struct ShapeId {
  uint32_t index = 0xffffffffu;
  uint32_t generation = 0; /* 0: of no shape */
  friend bool operator==(const ShapeId &, const ShapeId &) = default;
};

struct Velocity {
  Vec3 linear{0, 0, 0};  /* m/s, world axes */
  Vec3 angular{0, 0, 0}; /* rad/s, world axes */
};

/* What acts on a body throughout the next step. The point is where the force acts, in world coordinates; without one it
 * acts at the centre of mass. */
struct Force {
  Vec3 force{0, 0, 0};  /* N */
  Vec3 torque{0, 0, 0}; /* N m */
  std::optional<Point> point = std::nullopt;
};

/* Changes the velocity at once. The point is as that of a force. */
struct Impulse {
  Vec3 impulse{0, 0, 0};         /* N s */
  Vec3 angular_impulse{0, 0, 0}; /* N m s */
  std::optional<Point> point = std::nullopt;
};

/* A body that fell asleep or woke. */
struct SleepEvent {
  BodyId body;
  bool asleep = false;
};

/* What World::set_properties changes of a body: the fields that are given, as Body describes them. The others stay.
 *
 *   world.set_properties(id, {.type = BodyType::kinematic, .gravity_factor = 0.5f});
 *
 * Inertia that the user did not give follows shape and mass; given inertia stays until it is given again, and all 0
 * makes it follow again. A body that becomes fixed comes to rest; one that becomes dynamic must have a valid mass. */
struct BodyProperties {
  std::optional<BodyType> type = std::nullopt;
  std::optional<bool> trigger = std::nullopt;
  std::optional<bool> continuous = std::nullopt;
  std::optional<uint32_t> material = std::nullopt;
  std::optional<float> mass = std::nullopt;   /* kg */
  std::optional<Vec3> inertia = std::nullopt; /* kg m^2 */
  std::optional<bool> infinite_inertia = std::nullopt;
  std::optional<float> gravity_factor = std::nullopt;
  std::optional<float> linear_damping = std::nullopt;  /* 1/s */
  std::optional<float> angular_damping = std::nullopt; /* 1/s */
  std::optional<uint32_t> filter_group = std::nullopt;
  std::optional<uint32_t> filter_mask = std::nullopt;
  std::optional<Axes> linear_locks = std::nullopt;
  std::optional<Axes> angular_locks = std::nullopt;
  std::optional<float> max_linear_speed = std::nullopt;  /* m/s */
  std::optional<float> max_angular_speed = std::nullopt; /* rad/s */
  std::optional<uint64_t> user_data = std::nullopt;
};

/* All properties of a body, for instance to restore them later. */
TANDEM_API BodyProperties properties_of(const Body &body);

} // namespace tandem
