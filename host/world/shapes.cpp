/* shapes.cpp - shapes that are added to bodies and removed from them while a world runs.
 *
 * A body of several shapes is a body with a compound, whose children they are. A call makes new compounds for its
 * bodies and lays the tables out anew. A compound that was made here belongs to its body alone and is replaced in its
 * place, so that the scene's list of shapes does not grow with each call.
 */
#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include <tandem/error.h>
#include <tandem/round_to_float.h>

#include "host/geometry/shape_mass.h"
#include "host/world/implementation.h"
#include "host/world/placed_bodies.h"

namespace tandem {
namespace {

/* A shape that is not a compound is its own only part. */
std::vector<Child> parts_of_shape(const Shape &shape)
{
  if (shape.compound) return shape.compound->children;
  Child only;
  only.shape = shape;
  return {only};
}

void take_state(Body &body, const BodyState &state)
{
  body.position = state.position;
  body.orientation = unit(state.orientation);
  body.linear_velocity = state.linear_velocity;
  body.angular_velocity = state.angular_velocity;
}

/* The body's frame goes to the new centre of mass, which moves as the old body did there. The density stays. */
void take_new_mass(const Scene &scene, const Shape &old_shape, Body &body)
{
  const Point before = body.position;
  const double volume = mass_properties_of(old_shape).mass;
  body.mass = round_to_float(body.mass * (mass_properties_of(scene.shapes[body.shape]).mass / volume));
  take_mass_properties(scene, body);
  const Vec3 &w = body.angular_velocity;
  const double x = body.position[0] - before[0], y = body.position[1] - before[1], z = body.position[2] - before[2];
  const double swing[3] = {w[1] * z - w[2] * y, w[2] * x - w[0] * z, w[0] * y - w[1] * x};
  for (size_t k = 0; k < 3; ++k) body.linear_velocity[k] = round_to_float(body.linear_velocity[k] + swing[k]);
}

/* Puts the shapes of a scene back unless they are kept. */
class KeptShapes {
public:
  explicit KeptShapes(Scene &scene) : scene_(scene), before_(scene.shapes) {}
  ~KeptShapes()
  {
    if (!kept_) scene_.shapes.swap(before_);
  }
  KeptShapes(const KeptShapes &) = delete;
  KeptShapes &operator=(const KeptShapes &) = delete;
  void keep() noexcept { kept_ = true; }

private:
  Scene &scene_;
  std::vector<Shape> before_;
  bool kept_ = false;
};

} // namespace

std::vector<ShapeId> World::Implementation::shapes_of(const BodyId &id)
{
  const Body &body = scene.bodies[slots.slot_of("shapes_of", id)];
  return shapes.of(id, std::max(children_of(scene.shapes[body.shape]), 1u));
}

std::vector<ShapeId> World::Implementation::add_shapes(std::span<const BodyId> ids, std::span<const Child> given)
{
  if (ids.size() != given.size())
    throw InputError(fmt::format("add_shapes: {} handles and {} shapes; one shape for each handle is needed",
                                 ids.size(), given.size()));
  std::map<uint32_t, std::vector<Child>> parts;
  for (size_t i = 0; i < ids.size(); ++i) {
    const uint32_t slot = slots.slot_of("add_shapes", ids[i]);
    const auto [entry, is_new] = parts.try_emplace(slot);
    if (is_new) entry->second = parts_of_shape(scene.shapes[scene.bodies[slot].shape]);
    entry->second.push_back(given[i]);
  }
  for (const BodyId &id : ids) shapes_of(id); /* the shapes that the body has get their handles first */
  give_parts("add_shapes", parts);
  std::vector<ShapeId> added;
  std::map<uint32_t, size_t> next; /* by body: the number of its first new shape, and of those after it */
  for (const BodyId &id : ids) ++next[id.index];
  for (auto &[slot, count] : next) count = parts[slot].size() - count;
  for (const BodyId &id : ids) added.push_back(shapes.of(id, parts[id.index].size())[next[id.index]++]);
  return added;
}

void World::Implementation::remove_shapes(std::span<const ShapeId> ids)
{
  std::map<uint32_t, std::vector<bool>> removed; /* by body: of its shapes */
  for (const ShapeId &id : ids) {
    const ShapeSlots::Place place = shapes.place_of("remove_shapes", id);
    const uint32_t slot = slots.slot_of("remove_shapes", place.body);
    std::vector<bool> &gone = removed[slot];
    gone.resize(std::max(children_of(scene.shapes[scene.bodies[slot].shape]), 1u));
    if (gone[place.child]) throw InputError(fmt::format("remove_shapes: shape {} is given twice", id.index));
    gone[place.child] = true;
  }
  std::map<uint32_t, std::vector<Child>> parts;
  for (const auto &[slot, gone] : removed) {
    const std::vector<Child> all = parts_of_shape(scene.shapes[scene.bodies[slot].shape]);
    for (size_t k = 0; k < all.size(); ++k)
      if (!gone[k]) parts[slot].push_back(all[k]);
    if (parts[slot].empty())
      throw InputError(fmt::format("remove_shapes: body {} would have no shape; destroy_bodies removes bodies", slot));
  }
  give_parts("remove_shapes", parts);
  for (const ShapeId &id : ids) shapes.remove(id);
}

/* A place in the scene's list of shapes for the compound of a body: the one that it has, if it was made here for it
 * alone, or one that no body names any more, or a new one. A destroyed body names its shape until its index is used
 * again, because the scene that a snapshot holds must be valid. */
uint32_t World::Implementation::own_shape(uint32_t slot, const std::set<uint32_t> &taken)
{
  std::set<uint32_t> used = taken;
  for (uint32_t other = 0; other < slots.count(); ++other)
    if (other != slot) used.insert(scene.bodies[other].shape);
  const uint32_t present = scene.bodies[slot].shape;
  if (made_shapes.contains(present) && !used.contains(present)) return present;
  for (const uint32_t made : made_shapes)
    if (!used.contains(made)) return made;
  scene.shapes.emplace_back();
  return static_cast<uint32_t>(scene.shapes.size() - 1);
}

namespace {

bool takes_mass_of_shape(const Body &body) { return body.type == BodyType::dynamic && body.inertia == Vec3{0, 0, 0}; }

} // namespace

void World::Implementation::give_parts(const char *call, const std::map<uint32_t, std::vector<Child>> &parts)
{
  if (parts.empty()) return;
  settle_joints();
  std::vector<uint32_t> moved;
  for (const auto &[slot, children] : parts)
    if (takes_mass_of_shape(scene.bodies[slot])) moved.push_back(slot);
  refuse_joined(call, "its centre of mass cannot move", moved);
  settle(); /* what was called before comes before */
  std::vector<uint32_t> touched;
  for (const auto &[slot, children] : parts) touched.push_back(slot);
  wake_bodies(touched, true);
  buffers.make_ready(sizes());
  KeptShapes before(scene);
  std::vector<uint32_t> changed;
  std::vector<Body> bodies_with_parts;
  std::set<uint32_t> taken;
  for (const auto &[slot, children] : parts) {
    Body body = scene.bodies[slot];
    const Shape old_shape = scene.shapes[body.shape];
    take_state(body, download_body(memory, index_of_body[slot]));
    body.shape = own_shape(slot, taken);
    taken.insert(body.shape);
    scene.shapes[body.shape] = compound_shape(children);
    validate(scene.shapes[body.shape], body.shape, call);
    if (takes_mass_of_shape(body)) take_new_mass(scene, old_shape, body);
    validate(scene, body, slot, call);
    changed.push_back(slot);
    bodies_with_parts.push_back(std::move(body));
  }
  std::set<uint32_t> made = made_shapes;
  made.insert(taken.begin(), taken.end());
  PlacedBodies placed(scene, changed, bodies_with_parts);
  try {
    brings_features(changed);       /* notes their kinds */
    std::vector<uint32_t> restated; /* a quarantined body keeps its place */
    for (const uint32_t slot : changed)
      if (slots.status()[slot] != BodyStatus::quarantined) restated.push_back(slot);
    lay_out_anew(restated);
  } catch (...) {
    known_kinds.clear(); /* some may be of these bodies alone */
    throw;
  }
  placed.keep();
  ring.forget("shapes were added to bodies or removed");
  before.keep();
  made_shapes.swap(made);
}

} // namespace tandem
