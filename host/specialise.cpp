/* specialise.cpp - derives the features of a scene from what is in it; see specialise.h. */
#include "host/specialise.h"

#include <algorithm>
#include <cmath>

#include "host/shape_bounds.h"
#include "shared/features.h"

namespace tandem {
namespace {

/* How many bodies may be tested against all others, and how much larger than the median they must be. */
constexpr size_t most_large_bodies = 64;
constexpr float large_ratio = 4.0f;

bool is_dynamic(const Body &body) { return body.motion == Motion::dynamic; }

struct Presence {
  bool fixed[3] = {};   /* by shape type: bodies that cannot be moved */
  bool dynamic[3] = {};
};

Presence presence_of(const Scene &scene)
{
  Presence present;
  for (const Body &body : scene.bodies) {
    const auto type = static_cast<size_t>(scene.shapes[body.shape].type);
    if (is_general(scene, body)) continue;
    (is_dynamic(body) ? present.dynamic : present.fixed)[type] = true;
  }
  return present;
}

uint32_t convex_features(const Scene &scene)
{
  const auto any = [&](const auto &wanted) { return std::any_of(scene.bodies.begin(), scene.bodies.end(), wanted); };
  if (!any([&](const Body &body) { return is_general(scene, body); })) return 0;
  const bool above = any([&](const Body &body) { return scene.shapes[body.shape].type == ShapeType::half_space; });
  return uint32_t{FEATURE_CONVEX} | (above ? uint32_t{FEATURE_CONVEX_HALF_SPACE} : 0u);
}

uint32_t pair_features(const Presence &present)
{
  const auto meets = [&](ShapeType first, ShapeType second) {
    const auto a = static_cast<size_t>(first), b = static_cast<size_t>(second);
    return (present.dynamic[a] && (present.dynamic[b] || present.fixed[b])) || (present.dynamic[b] && present.fixed[a]);
  };
  uint32_t features = 0;
  if (meets(ShapeType::sphere, ShapeType::sphere)) features |= FEATURE_SPHERE_SPHERE;
  if (meets(ShapeType::sphere, ShapeType::box)) features |= FEATURE_SPHERE_BOX;
  if (meets(ShapeType::box, ShapeType::box)) features |= FEATURE_BOX_BOX;
  if (meets(ShapeType::sphere, ShapeType::half_space)) features |= FEATURE_SPHERE_HALF_SPACE;
  if (meets(ShapeType::box, ShapeType::half_space)) features |= FEATURE_BOX_HALF_SPACE;
  return features;
}

bool spins_unevenly(const Scene &scene, const Body &body)
{
  const Vec3 inverse = inverse_inertia_of(scene, body);
  return is_dynamic(body) && (inverse[0] != inverse[1] || inverse[1] != inverse[2]);
}

bool filters(const Scene &scene)
{
  const Body &first = scene.bodies.front();
  const bool first_accepts_itself = (first.filter_group & first.filter_mask) != 0;
  return !first_accepts_itself || std::any_of(scene.bodies.begin(), scene.bodies.end(), [&](const Body &body) {
    return body.filter_group != first.filter_group || (body.filter_mask & first.filter_group) == 0;
  });
}

uint32_t body_features(const Scene &scene)
{
  uint32_t features = 0;
  for (const Body &body : scene.bodies) {
    const Material &material = scene.materials[body.material];
    if (material.static_friction > 0 || material.dynamic_friction > 0) features |= FEATURE_FRICTION;
    if (material.restitution > 0) features |= FEATURE_RESTITUTION;
    if (material.rolling_friction > 0 || material.spinning_friction > 0) features |= FEATURE_ROLLING;
    if (spins_unevenly(scene, body)) features |= FEATURE_GYROSCOPIC;
    if (body.continuous) features |= FEATURE_CONTINUOUS;
    if (is_dynamic(body) && (body.linear_damping > 0 || body.angular_damping > 0)) features |= FEATURE_DAMPING;
  }
  if (!scene.bodies.empty() && filters(scene)) features |= FEATURE_FILTER;
  return features;
}

std::vector<uint32_t> large_bodies(const Scene &scene)
{
  const float limit = large_ratio * median_radius(scene);
  const auto radius = [&](uint32_t body) { return bounding_radius(scene, scene.bodies[body]); };
  std::vector<uint32_t> boundless, large;
  for (uint32_t body = 0; body < scene.bodies.size(); ++body) {
    if (scene.shapes[scene.bodies[body].shape].type == ShapeType::half_space) boundless.push_back(body);
    else if (radius(body) > limit || scene.bodies[body].continuous) large.push_back(body); /* what is fast has bounds as large */
  }
  std::stable_sort(large.begin(), large.end(), [&](uint32_t a, uint32_t b) { return radius(a) > radius(b); });
  if (large.size() > most_large_bodies) large.resize(most_large_bodies);
  large.insert(large.end(), boundless.begin(), boundless.end());
  std::sort(large.begin(), large.end());
  return large;
}

} // namespace

float median_radius(const Scene &scene)
{
  std::vector<float> radii;
  for (const Body &body : scene.bodies)
    if (scene.shapes[body.shape].type != ShapeType::half_space) radii.push_back(bounding_radius(scene, body));
  if (radii.empty()) return 0;
  std::nth_element(radii.begin(), radii.begin() + radii.size() / 2, radii.end());
  return radii[radii.size() / 2];
}

bool is_general(const Scene &scene, const Body &body)
{
  const bool posed = body.shape_position != Vec3{0, 0, 0} || body.shape_orientation != Quat{0, 0, 0, 1};
  const ShapeType type = scene.shapes[body.shape].type;
  return posed || type > ShapeType::half_space || (body.continuous && type != ShapeType::half_space);
}

Vec3 inverse_inertia_of(const Scene &scene, const Body &body)
{
  if (!is_dynamic(body) || body.infinite_inertia) return {0, 0, 0};
  const bool own = body.inertia[0] != 0 || body.inertia[1] != 0 || body.inertia[2] != 0;
  const Vec3 moments = own ? body.inertia : inertia_of(scene.shapes[body.shape], body.mass);
  Vec3 inverse;
  for (int axis = 0; axis < 3; ++axis) inverse[axis] = moments[axis] > 0 ? 1.0f / moments[axis] : 0.0f;
  return inverse;
}

uint32_t all_features() { return (1u << FEATURE_COUNT) - 1; }

Specialisation specialise(const Scene &scene)
{
  Specialisation result;
  result.features = pair_features(presence_of(scene)) | convex_features(scene) | body_features(scene);
  result.order = large_bodies(scene);
  result.large = static_cast<uint32_t>(result.order.size());
  std::vector<bool> taken(scene.bodies.size());
  for (uint32_t body : result.order) taken[body] = true;
  for (uint32_t body = 0; body < scene.bodies.size(); ++body)
    if (!taken[body]) result.order.push_back(body);
  return result;
}

} // namespace tandem
