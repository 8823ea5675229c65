/* specialise.cpp - derives the features of a scene from its contents; see specialise.h. */
#include "host/scene/specialise.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <tandem/settings.h>

#include "host/runtime/interface/built_features.h"
#include "host/runtime/interface/features.h"
#include "host/runtime/interface/pair_tests.h"
#include "host/scene/axis_bits.h"
#include "host/scene/coupling_graph.h"
#include "host/scene/joint_buffers.h"
#include "host/scene/shape_bounds.h"
#include "shared/body_codes.h"
#include "shared/pair_kinds.h"

namespace tandem {
namespace {

bool is_dynamic(const Body &body) { return body.type == BodyType::dynamic; }

bool is_posed(const Body &body)
{
  return body.shape_position != Vec3{0, 0, 0} || body.shape_orientation != Quat{0, 0, 0, 1};
}

bool has_one_radius(const Shape &capsule) { return capsule.size[0] == capsule.size[2]; }

/* Whether a row of pairs.def names the shape. */
bool has_test_of_its_own(uint32_t code)
{
#define GENERAL_PAIR(kind, first, second, kernel, follower, what)
#define PAIR(kind, first, second, kernel, follower, what) \
  if (code == SHAPE_##first || code == SHAPE_##second) return true;
#include "shared/pairs.def"
#undef PAIR
#undef GENERAL_PAIR
  return false;
}

bool has_triggers(const Scene &scene)
{
  return std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const Body &body) { return body.trigger; });
}

constexpr uint32_t shape_codes = 8; /* of body_flags */

struct Presence {
  bool fixed[shape_codes] = {};   /* by shape: bodies that cannot be moved */
  bool dynamic[shape_codes] = {}; /* with triggers also kinematic bodies, because they meet fixed triggers */
};

/* Calls visit with the code of the body, or of each child of its compound. */
template <class Visit> void for_each_code(const Scene &scene, const Body &body, const Visit &visit)
{
  const Shape &shape = scene.shapes[body.shape];
  if (!shape.compound) visit(shape_code(scene, body));
  else
    for (const Child &child : shape.compound->children) visit(shape_code(body, child));
}

Presence presence_of(const Scene &scene)
{
  Presence present;
  const bool triggers = has_triggers(scene);
  for (const Body &body : scene.bodies) {
    const bool moves = is_dynamic(body) || (triggers && body.type == BodyType::kinematic);
    for_each_code(scene, body, [&](uint32_t code) { (moves ? present.dynamic : present.fixed)[code] = true; });
  }
  return present;
}

bool has_children_with_tests(const Scene &scene)
{
  return std::any_of(scene.bodies.begin(), scene.bodies.end(), [&](const Body &body) {
    bool found = false;
    if (scene.shapes[body.shape].compound)
      for_each_code(scene, body, [&](uint32_t code) { found = found || code != SHAPE_OTHER; });
    return found;
  });
}

/* Tests the shapes of bodies and of children of compounds. */
bool any_shape(const Scene &scene, std::initializer_list<ShapeType> types)
{
  const auto wanted = [&](const Shape &shape) {
    return std::find(types.begin(), types.end(), shape.type) != types.end();
  };
  return std::any_of(scene.bodies.begin(), scene.bodies.end(), [&](const Body &body) {
    const Shape &shape = scene.shapes[body.shape];
    if (wanted(shape)) return true;
    return shape.compound && std::any_of(shape.compound->children.begin(), shape.compound->children.end(),
                                         [&](const Child &child) { return wanted(child.shape); });
  });
}

Features convex_features(const Scene &scene)
{
  const bool general =
      std::any_of(scene.bodies.begin(), scene.bodies.end(), [&](const Body &body) { return is_general(scene, body); });
  if (!general) return 0;
  Features features = FEATURE_CONVEX;
  if (any_shape(scene, {ShapeType::hull})) features |= FEATURE_HULL;
  if (any_shape(scene, {ShapeType::capsule, ShapeType::cylinder})) features |= FEATURE_ROUND;
  if (any_shape(scene, {ShapeType::mesh, ShapeType::compound})) features |= with_needs(FEATURE_TREES);
  return features;
}

/* The depth of polytopes is found by separating axes; that of triangles, and of everything else that is not sampled, by
 * an expanding polytope. */
Features narrowphase_features(const Scene &scene, Features features, const Settings &settings)
{
  if ((features & FEATURE_CONVEX) == 0) return 0;
  switch (settings.narrowphase) {
  case Narrowphase::gjk_sampled: return FEATURE_SAMPLED | ((features & FEATURE_TREES) != 0 ? FEATURE_EXPANSION : 0);
  case Narrowphase::gjk_epa: return FEATURE_EXPANSION;
  case Narrowphase::cube_map: return FEATURE_FIELDS | FEATURE_EXPANSION;
  case Narrowphase::sat:
  case Narrowphase::sat_split: break;
  }
  const bool others = any_shape(scene, {ShapeType::sphere, ShapeType::capsule, ShapeType::cylinder, ShapeType::mesh});
  return FEATURE_AXES | (others ? FEATURE_EXPANSION : 0) |
         (settings.narrowphase == Narrowphase::sat_split ? FEATURE_SAT_SPLIT : 0);
}

Features support_features(Features features, const Settings &settings)
{
  if ((features & FEATURE_HULL) == 0) return 0;
  switch (settings.support) {
  case Support::hill_climbing: return FEATURE_HILL_CLIMBING;
  case Support::cube_map: return FEATURE_CUBE_MAP;
  case Support::brute_force: break;
  }
  return 0;
}

/* Other solvers have kernels that every scene may need: overflow constraints are solved as `jacobi` solves all. */
Features solver_features(Solver solver)
{
  switch (solver) {
  case Solver::pgs: return FEATURE_PGS;
  case Solver::nncg: return FEATURE_PGS | FEATURE_NNCG;
  case Solver::xpbd: return FEATURE_XPBD;
  case Solver::avbd: return FEATURE_AVBD;
  case Solver::soft_step:
  case Solver::jacobi:
  case Solver::direct: break;
  }
  return 0;
}

/* The features of all kinds of pairs that shapes of the scene can make. */
Features pair_features(const Presence &present)
{
  Features features = 0;
  for (uint32_t a = 0; a < shape_codes; ++a)
    for (uint32_t b = 0; b < shape_codes; ++b)
      if (const uint32_t kind = pair_kind(a, b);
          kind != PAIR_KIND_NONE && present.dynamic[a] && (present.dynamic[b] || present.fixed[b]))
        features |= pair_tests[kind].feature;
  return features;
}

/* Lists pay if pairs of several kinds are mixed. Pairs with a half-space are few, because a body has at most one with
 * each half-space and only if it touches it; their kernel skips all other pairs in less time than the lists take.
 * Without lists the kinds of pairs are those of bodies (narrowphase/pair_lists.h), not those of their children. */
Features list_features(const Scene &scene, Features features)
{
  if (has_children_with_tests(scene)) return FEATURE_PAIR_KINDS;
  const auto counts = [&](const PairTest &test) {
    return (features & test.feature) != 0 && test.second != "HALF_SPACE";
  };
  return std::count_if(std::begin(pair_tests), std::end(pair_tests), counts) > 1 ? FEATURE_PAIR_KINDS : 0;
}

/* A ball touches a shape with a test of its own at one point. Parts of compounds share manifolds (midphase/merge.h). */
Features point_features(Features pairs)
{
  constexpr Features of_balls =
      FEATURE_SPHERE_SPHERE | FEATURE_SPHERE_BOX | FEATURE_SPHERE_CAPSULE | FEATURE_SPHERE_HALF_SPACE;
  return (pairs & ~of_balls) != 0 ? FEATURE_SEVERAL_POINTS : 0;
}

bool spins_unevenly(const Scene &scene, const Body &body)
{
  const Vec3 inverse = inverse_inertia_of(scene, body);
  return is_dynamic(body) && (inverse[0] != inverse[1] || inverse[1] != inverse[2]);
}

bool is_damped(const Body &body) { return is_dynamic(body) && (body.linear_damping > 0 || body.angular_damping > 0); }

bool is_locked(const Body &body) { return locks_of(body) != 0; }

bool is_limited(const Body &body)
{
  return is_dynamic(body) && (std::isfinite(body.max_linear_speed) || std::isfinite(body.max_angular_speed));
}

bool meet(const Filter &a, const Filter &b) { return (a.group & b.mask) != 0 && (b.group & a.mask) != 0; }

/* Visits the filters and materials of a body's shape, or of its children's. */
template <class Visit> void for_each_filter(const Scene &scene, const Body &body, const Visit &visit)
{
  const Shape &shape = scene.shapes[body.shape];
  if (!shape.compound) visit(filter_of(scene, body));
  else
    for (const Child &child : shape.compound->children) visit(filter_of(body, child));
}
template <class Visit> void for_each_material(const Scene &scene, const Body &body, const Visit &visit)
{
  const Shape &shape = scene.shapes[body.shape];
  if (!shape.compound) visit(scene.materials[body.material]);
  else
    for (const Child &child : shape.compound->children) visit(scene.materials[child.material.value_or(body.material)]);
}

/* No filtering is needed if all filters are equal and accept each other. */
bool filters(const Scene &scene)
{
  std::optional<Filter> first;
  bool result = false;
  for (const Body &body : scene.bodies)
    for_each_filter(scene, body, [&](const Filter &filter) {
      if (!first) first = filter;
      result = result || !meet(*first, filter) || filter.group != first->group;
    });
  return result;
}

Features features_of(const Material &material)
{
  Features features = 0;
  if (material.static_friction > 0 || material.dynamic_friction > 0) features |= FEATURE_FRICTION;
  if (material.restitution > 0) features |= FEATURE_RESTITUTION;
  if (material.rolling_friction > 0 || material.spinning_friction > 0) features |= FEATURE_ROLLING;
  return features;
}

Features body_features(const Scene &scene)
{
  Features features = 0;
  for (const Body &body : scene.bodies) {
    for_each_material(scene, body, [&](const Material &material) { features |= features_of(material); });
    if (spins_unevenly(scene, body)) features |= FEATURE_GYROSCOPIC;
    if (body.continuous) features |= FEATURE_CONTINUOUS;
    if (is_damped(body)) features |= FEATURE_DAMPING;
    if (is_locked(body)) features |= FEATURE_LOCKS | FEATURE_GYROSCOPIC;
    if (is_limited(body)) features |= FEATURE_MAX_SPEED;
  }
  if (filters(scene)) features |= FEATURE_FILTER;
  if (has_triggers(scene)) features |= FEATURE_TRIGGER;
  return features;
}

/* A fast body has bounds as large as its displacement. */
bool is_large(float radius, const Body &body, float median) { return radius > large_ratio * median || body.continuous; }

struct LargeBodies {
  std::vector<uint32_t> unbounded, large;
};

/* The bodies are numbered from 0. */
LargeBodies large_bodies(const Scene &scene, std::span<const Body> bodies, float median)
{
  std::vector<float> radii;
  for (const Body &body : bodies) radii.push_back(bounding_radius(scene, body));
  const auto radius = [&](uint32_t body) { return radii[body]; };
  std::vector<uint32_t> unbounded, large;
  for (uint32_t body = 0; body < bodies.size(); ++body) {
    if (scene.shapes[bodies[body].shape].type == ShapeType::half_space) unbounded.push_back(body);
    else if (is_large(radius(body), bodies[body], median)) large.push_back(body);
  }
  std::stable_sort(large.begin(), large.end(), [&](uint32_t a, uint32_t b) { return radius(a) > radius(b); });
  if (large.size() > most_large_bodies) large.resize(most_large_bodies);
  std::sort(large.begin(), large.end());
  return {unbounded, large};
}

float median_radius(const Scene &scene, std::span<const Body> bodies)
{
  std::vector<float> radii;
  for (const Body &body : bodies)
    if (scene.shapes[body.shape].type != ShapeType::half_space) radii.push_back(bounding_radius(scene, body));
  if (radii.empty()) return 0;
  std::nth_element(radii.begin(), radii.begin() + radii.size() / 2, radii.end());
  return radii[radii.size() / 2];
}

/* The order of the bodies of one world, and what of it is unbounded and large. */
Specialisation order_of(const Scene &scene, std::span<const Body> bodies)
{
  Specialisation result;
  result.median = median_radius(scene, bodies);
  const LargeBodies first = large_bodies(scene, bodies, result.median);
  result.order = first.unbounded;
  result.order.insert(result.order.end(), first.large.begin(), first.large.end());
  result.unbounded = static_cast<uint32_t>(first.unbounded.size());
  result.large = static_cast<uint32_t>(result.order.size());
  std::vector<bool> taken(bodies.size());
  for (uint32_t body : result.order) taken[body] = true;
  for (uint32_t body = 0; body < bodies.size(); ++body)
    if (!taken[body]) result.order.push_back(body);
  result.awake = static_cast<uint32_t>(result.order.size());
  return result;
}

} // namespace

float median_radius(const Scene &scene) { return median_radius(scene, scene.bodies); }

bool is_general(const Scene &scene, const Body &body)
{
  const ShapeType type = scene.shapes[body.shape].type;
  return is_posed(body) || type > ShapeType::half_space || (body.continuous && type != ShapeType::half_space);
}

uint32_t shape_code(const Scene &scene, const Body &body)
{
  const Shape &shape = scene.shapes[body.shape];
  const auto code = static_cast<uint32_t>(shape.type);
  const bool placed = code == SHAPE_CAPSULE ? has_one_radius(shape) : !is_posed(body);
  const bool plain = placed && (!body.continuous || code == SHAPE_HALF_SPACE);
  return plain && has_test_of_its_own(code) ? code : uint32_t{SHAPE_OTHER};
}

uint32_t shape_code(const Body &body, const Child &child)
{
  const ShapeType type = child.shape.type;
  const bool round = type == ShapeType::sphere || (type == ShapeType::capsule && has_one_radius(child.shape));
  return round && !body.continuous ? uint32_t{SHAPE_CAPSULE} : uint32_t{SHAPE_OTHER};
}

Filter filter_of(const Body &body, const Child &child)
{
  return {child.filter_group.value_or(body.filter_group), child.filter_mask.value_or(body.filter_mask)};
}

Filter filter_of(const Scene &scene, const Body &body)
{
  const Shape &shape = scene.shapes[body.shape];
  if (!shape.compound) return {body.filter_group, body.filter_mask};
  Filter any{0, 0};
  for (const Child &child : shape.compound->children) {
    const Filter own = filter_of(body, child);
    any = {any.group | own.group, any.mask | own.mask};
  }
  return any;
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

uint32_t locks_of(const Body &body)
{
  return is_dynamic(body) ? bits_of(body.linear_locks) | bits_of(body.angular_locks) << LOCK_ANGULAR_SHIFT : 0u;
}

Features all_features() { return built_features() & ~FEATURE_WORLDS; }

bool is_large(const Scene &scene, const Body &body, float median)
{
  return is_large(bounding_radius(scene, body), body, median);
}

BodyKind kind_of(const Scene &scene, const Body &body)
{
  return {body.shape,       body.material,   body.filter_group,
          body.filter_mask, body.type,       body.trigger,
          body.continuous,  is_posed(body),  spins_unevenly(scene, body),
          is_damped(body),  is_locked(body), is_limited(body)};
}

Features features_of(const Scene &scene, const Settings &settings)
{
  const Features pairs = pair_features(presence_of(scene));
  Features features =
      pairs | list_features(scene, pairs) | point_features(pairs) | convex_features(scene) | body_features(scene);
  features |= narrowphase_features(scene, features, settings) | support_features(features, settings) |
              solver_features(settings.solver);
  features |= joint_features(scene) | coupling_features(scene);
  if (settings.solver == Solver::jacobi && (features & FEATURE_JOINTS) != 0) features |= FEATURE_SPLIT_JOINTS;
  if (!scene.articulations.empty())
    features |= with_needs(settings.tree_joint_forces ? FEATURE_TREE_JOINT_FORCES : FEATURE_ARTICULATIONS);
  if (settings.events) features |= FEATURE_EVENTS;
  if (settings.solver == Solver::soft_step) features |= FEATURE_SUBSTEP_WARM_START;
  return features;
}

Specialisation specialise(const Scene &scene, const Settings &settings)
{
  Specialisation result = order_of(scene, scene.bodies);
  result.features = features_of(scene, settings);
  return result;
}

Specialisation specialise_worlds(const Scene &all, uint32_t worlds, const Settings &settings)
{
  Specialisation result;
  result.features = features_of(all, settings) | FEATURE_WORLDS;
  result.worlds = worlds;
  const size_t bodies = all.bodies.size() / worlds;
  for (uint32_t world = 0; world < worlds; ++world) {
    const auto first = static_cast<uint32_t>(world * bodies);
    for (const uint32_t body : order_of(all, std::span(all.bodies).subspan(first, bodies)).order)
      result.order.push_back(first + body);
  }
  result.awake = static_cast<uint32_t>(result.order.size());
  return result;
}

} // namespace tandem
