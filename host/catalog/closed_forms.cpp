/* closed_forms.cpp - the scenes of closed_forms.h and their exact motion.
 *
 *   free-flight   boxes thrown apart, spinning about no principal axis: parabolas
 *   incline       a box on a slope, tan(slope) above its friction: x = (g/2) (sin - mu cos) t^2
 *   bounce        balls dropped: each impact leaves e times the speed, and so e^2 of the height
 *   mass-ratio    a column whose boxes get heavier upwards, for which Gauss-Seidel converges worst
 */
#include "host/catalog/closed_forms.h"

#include <cmath>

#include <tandem/round_to_float.h>

#include "host/base/random.h"
#include "host/catalog/builders.h"

namespace tandem {

using namespace scene_builders;

namespace {

using Vector = std::array<double, 3>;

/* --- free-flight ------------------------------------------------------------------------------- */

uint64_t only_n(const SceneValues &v) { return uint64_t(whole(v, "n")); }

Scene free_flight(const SceneValues &v)
{
  Random random(uint64_t(whole(v, "seed")));
  Scene scene;
  const double spin = number(v, "spin");
  const uint32_t box = add_shape(scene, box_shape(0.2f, 0.3f, 0.5f));
  for (int64_t i = 0; i < whole(v, "n"); ++i) {
    Body &body = add_body(scene, box, {double(4 * (i % 100)), 0, double(4 * (i / 100))});
    body.linear_velocity = {round_to_float(random.uniform(-0.5, 0.5)), round_to_float(random.uniform(3, 8)),
                            round_to_float(random.uniform(-0.5, 0.5))};
    body.angular_velocity = {round_to_float(spin * random.uniform(-1, 1)), round_to_float(spin * random.uniform(-1, 1)),
                             round_to_float(spin * random.uniform(-1, 1))};
    body.orientation = random.orientation();
  }
  return scene;
}

/* --- incline: the slope is a tangent, so that the scene has the same bits everywhere --------------- */

Vec3 uphill_normal(double slope)
{
  const double length = std::sqrt(1 + slope * slope);
  return {round_to_float(slope / length), round_to_float(1 / length), 0}; /* down the slope is +x */
}

/* The rotation about -z by the angle of the slope, with half angles computed from the tangent. */
Quat slope_turn(double slope)
{
  const double cosine = 1 / std::sqrt(1 + slope * slope);
  return {0, 0, round_to_float(-std::sqrt((1 - cosine) / 2)), round_to_float(std::sqrt((1 + cosine) / 2))};
}

uint64_t two_bodies(const SceneValues &) { return 2; }

Scene incline(const SceneValues &v)
{
  const double slope = number(v, "slope"), half = number(v, "half_extent");
  Scene scene;
  scene.materials[0].static_friction = scene.materials[0].dynamic_friction = round_to_float(number(v, "friction"));
  add_ground(scene).orientation = slope_turn(slope);
  Body &box =
      add_body(scene, add_shape(scene, box_shape(round_to_float(half), round_to_float(half), round_to_float(half))));
  const Vec3 normal = uphill_normal(slope);
  for (int k = 0; k < 3; ++k) box.position[k] = round_to_float(half * normal[k]);
  box.orientation = slope_turn(slope);
  return scene;
}

/* --- bounce ---------------------------------------------------------------------------------------- */

Scene bounce(const SceneValues &v)
{
  const double radius = number(v, "radius"), height = number(v, "height");
  const int64_t n = whole(v, "n");
  Scene scene;
  scene.materials[0].restitution = round_to_float(number(v, "restitution"));
  add_ground(scene);
  const uint32_t ball = add_shape(scene, sphere_shape(round_to_float(radius)));
  for (int64_t i = 0; i < n; ++i) {
    /* The heights differ, so that impacts fall at all times within a step. */
    const double own = height * (1 + 0.5 * double(i) / double(n));
    add_body(scene, ball,
             {round_to_float(4 * radius * double(i % 1000)), round_to_float(radius + own),
              round_to_float(4 * radius * double(i / 1000))});
  }
  return scene;
}

/* --- mass-ratio ------------------------------------------------------------------------------------ */

Scene mass_ratio(const SceneValues &v)
{
  const double half = number(v, "half_extent"), ratio = number(v, "ratio");
  Scene scene;
  add_ground(scene);
  double mass = 1;
  const uint32_t box = add_shape(scene, box_shape(round_to_float(half), round_to_float(half), round_to_float(half)));
  for (int64_t i = 0; i < whole(v, "n"); ++i, mass *= ratio)
    add_body(scene, box, {0, round_to_float(half * double(2 * i + 1)), 0}, round_to_float(mass));
  return scene;
}

/* --- exact motion ----------------------------------------------------------------------------------- */

PreciseBodyState start_of(const Body &body)
{
  PreciseBodyState state{};
  for (int k = 0; k < 3; ++k) {
    state.position[k] = body.position[k];
    state.linear_velocity[k] = body.linear_velocity[k];
    state.angular_velocity[k] = body.angular_velocity[k];
  }
  for (int k = 0; k < 4; ++k) state.orientation[k] = body.orientation[k];
  return state;
}

void accelerate(PreciseBodyState &state, const Vector &acceleration, double time)
{
  for (int k = 0; k < 3; ++k) {
    state.position[k] += state.linear_velocity[k] * time + 0.5 * acceleration[k] * time * time;
    state.linear_velocity[k] += acceleration[k] * time;
  }
}

Vector gravity_of(const Scene &scene) { return {scene.gravity[0], scene.gravity[1], scene.gravity[2]}; }

/* Motion from rest straight down the slope. The normal is computed from the ground's own orientation, because the
 * simulation uses that. */
void slide(PreciseBodyState &state, const Scene &scene, double time)
{
  const Quat &q = scene.bodies[0].orientation;
  const double z = q[2], w = q[3], length = z * z + w * w;
  const double across = -2 * z * w / length, up = (w * w - z * z) / length; /* the turned y axis */
  const double gravity = -double{scene.gravity[1]},
               pull = gravity * (across - double{scene.materials[0].dynamic_friction} * up);
  if (pull > 0) accelerate(state, {pull * up, -pull * across, 0}, time);
}

void fall_and_bounce(PreciseBodyState &state, double radius, double restitution, double gravity, double time)
{
  double height = state.position[1] - radius, speed = std::sqrt(2 * gravity * height), at = speed / gravity;
  if (time < at) return accelerate(state, {0, -gravity, 0}, time);
  for (speed *= restitution; time >= at + 2 * speed / gravity; speed *= restitution) {
    at += 2 * speed / gravity;
    if (speed < 1e-9) { /* the impacts end in finite time */
      state.position[1] = radius, state.linear_velocity[1] = 0;
      return;
    }
  }
  state.position[1] = radius;
  state.linear_velocity[1] = speed;
  accelerate(state, {0, -gravity, 0}, time - at);
}

bool is_named(const Scene &scene, const char *name)
{
  const std::string own = scene.name.substr(0, scene.name.find(':'));
  return own == name;
}

} // namespace

std::vector<BuiltInScene> closed_form_scenes()
{
  const SceneParameter seed = seed_parameter(), half_extent = half_extent_parameter();
  return {
      {"free-flight",
       "boxes thrown apart, each spinning about no axis of its own; they meet nothing",
       {{"n", integer, 16, 1, 100000, "boxes"},
        {"spin", real, 5, 0, 1000, "largest angular speed about each axis, rad/s"},
        seed},
       only_n,
       free_flight},
      {"incline",
       "a box on a slope: slides with (sin - friction cos) g if the slope's tangent is above the friction",
       {{"slope", real, 0.75, 0, 10, "tangent of the slope's angle"},
        {"friction", real, 0.3, 0, 10, "coefficient"},
        half_extent},
       two_bodies,
       incline},
      {"bounce",
       "balls dropped on a ground, from height to 1.5 times height; each returns to restitution^2 of its height",
       {{"n", integer, 16, 1, 100000, "balls"},
        {"restitution", real, 0.8, 0, 1, "of balls and ground"},
        {"height", real, 2, 0.01, 10000, "free height under the lowest ball, m"},
        {"radius", real, 0.25, 0.001, 1000, "m"}},
       ground_and_n,
       bounce},
      {"mass-ratio",
       "a column of cubes, each `ratio` times as heavy as the one below",
       {{"n", integer, 5, 1, 100, "cubes"}, {"ratio", real, 4, 0.1, 1000, "mass against the cube below"}, half_extent},
       ground_and_n,
       mass_ratio}};
}

std::optional<std::vector<PreciseBodyState>> closed_form_state(const Scene &scene, double time)
{
  std::vector<PreciseBodyState> states;
  for (const Body &body : scene.bodies) states.push_back(start_of(body));
  const Vector gravity = gravity_of(scene);
  if (is_named(scene, "free-flight"))
    for (PreciseBodyState &state : states) accelerate(state, gravity, time);
  else if (is_named(scene, "incline")) slide(states[1], scene, time);
  else if (is_named(scene, "bounce"))
    for (size_t i = 1; i < states.size(); ++i)
      fall_and_bounce(states[i], scene.shapes[scene.bodies[i].shape].size[0], scene.materials[0].restitution,
                      -gravity[1], time);
  else return std::nullopt;
  return states;
}

} // namespace tandem
