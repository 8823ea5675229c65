/* world_bodies.cpp - the functions of <tandem/world.h> about bodies and their shapes: they come and go, are read, set
 * and pushed. */
#include <fmt/format.h>

#include <tandem/world.h>

#include "host/runtime/interface/floating_point.h"
#include "host/world/answers.h"
#include "host/world/implementation.h"

namespace tandem {

std::vector<BodyState> World::bodies()
{
  return answer_in_turn(*implementation_, "the bodies", [&] {
    implementation_->settle();
    return download_bodies(implementation_->memory, implementation_->special.order);
  });
}

std::vector<PreciseBodyState> World::precise_bodies()
{
  return answer_in_turn(*implementation_, "the bodies", [&] {
    implementation_->settle();
    return download_precise_bodies(implementation_->memory, implementation_->special.order);
  });
}

void World::set_body(uint32_t body, const BodyState &state)
{
  if (!implementation_->slots.exists(body))
    throw InputError(
        fmt::format("set_body: body {} does not exist; the scene has {}", body, implementation_->slots.existing()));
  if (!is_finite(state)) throw InputError(fmt::format("set_body: body {} would not be finite", body));
  set_body_unchecked(body, state);
}

void World::set_body_unchecked(uint32_t body, const BodyState &state)
{
  const minicl::ExactFloatingPoint environment;
  ++implementation_->state;
  answer("a body", implementation_->slots.existing(), [&] {
    implementation_->settle(); /* what was called before comes before */
    implementation_->wake_bodies(std::span(&body, 1), true);
    implementation_->note_motion(body, {state.linear_velocity, state.angular_velocity});
    upload_body(implementation_->memory, implementation_->index_of_body.at(body), state);
  });
  note(implementation_->log, RecordedCall::set_body, body, state);
}

BodyId World::id_of(uint32_t body) const
{
  if (!implementation_->slots.exists(body))
    throw InputError(
        fmt::format("id_of: body {} does not exist; the world has {}", body, implementation_->slots.existing()));
  return implementation_->slots.id_of(body);
}

bool World::exists(const BodyId &id) const
{
  return implementation_->slots.exists(id.index) && implementation_->slots.id_of(id.index) == id;
}

std::vector<BodyId> World::body_ids() const
{
  const BodySlots &slots = implementation_->slots;
  std::vector<BodyId> ids;
  ids.reserve(slots.existing());
  for (uint32_t slot = 0; slot < slots.count(); ++slot)
    if (slots.exists(slot)) ids.push_back(slots.id_of(slot));
  return ids;
}

uint32_t World::body_count() const { return implementation_->slots.existing(); }

std::vector<BodyId> World::create_bodies(std::span<const Body> bodies)
{
  return answer("new bodies", implementation_->slots.existing(), [&] {
    const std::vector<Body> given(bodies.begin(), bodies.end()); /* they may be those of scene(), which move */
    std::vector<BodyId> ids = implementation_->create(given);
    note(implementation_->log, RecordedCall::create_bodies, std::span<const Body>(given), ids);
    return ids;
  });
}

void World::destroy_bodies(std::span<const BodyId> ids)
{
  answer("the destruction of bodies", implementation_->slots.existing(), [&] { implementation_->destroy(ids); });
  note(implementation_->log, RecordedCall::destroy_bodies, ids);
}

uint32_t World::add_shape(const Shape &shape)
{
  const uint32_t index =
      answer("a shape", implementation_->slots.existing(), [&] { return implementation_->add_shape(shape); });
  note(implementation_->log, RecordedCall::add_shape, scene().shapes[index], index); /* `shape` may have moved */
  return index;
}

uint32_t World::add_material(const Material &material)
{
  const uint32_t index =
      answer("a material", implementation_->slots.existing(), [&] { return implementation_->add_material(material); });
  note(implementation_->log, RecordedCall::add_material, scene().materials[index], index);
  return index;
}

void World::set_properties(std::span<const BodyId> ids, std::span<const BodyProperties> properties)
{
  const minicl::ExactFloatingPoint environment;
  answer("properties of bodies", implementation_->slots.existing(),
         [&] { implementation_->set_properties(ids, properties); });
  note(implementation_->log, RecordedCall::set_properties, ids, properties);
}

Body World::body_description(const BodyId &id) const
{
  return implementation_->scene.bodies[implementation_->slots.slot_of("body_description", id)];
}

std::vector<ShapeId> World::add_shapes(std::span<const BodyId> ids, std::span<const Child> shapes)
{
  const minicl::ExactFloatingPoint environment;
  return answer("shapes of bodies", implementation_->slots.existing(), [&] {
    const std::vector<Child> given(shapes.begin(), shapes.end()); /* they may be those of a compound that goes */
    std::vector<ShapeId> added = implementation_->add_shapes(ids, given);
    note(implementation_->log, RecordedCall::add_shapes, ids, std::span<const Child>(given), added);
    return added;
  });
}

void World::remove_shapes(std::span<const ShapeId> ids)
{
  const minicl::ExactFloatingPoint environment;
  answer("shapes of bodies", implementation_->slots.existing(), [&] { implementation_->remove_shapes(ids); });
  note(implementation_->log, RecordedCall::remove_shapes, ids);
}

std::vector<ShapeId> World::shapes_of(const BodyId &id)
{
  return answer_in_turn(*implementation_, "shapes of bodies", [&] {
    std::vector<ShapeId> shapes = implementation_->shapes_of(id);
    note(implementation_->log, RecordedCall::shapes_of, id); /* it makes handles */
    return shapes;
  });
}

BodyId World::body_of(const ShapeId &id) const
{
  const std::lock_guard guard(implementation_->reading);
  return implementation_->shapes.place_of("body_of", id).body;
}

std::vector<BodyState> World::read_bodies(std::span<const BodyId> ids)
{
  return answer_in_turn(*implementation_, "the bodies", [&] { return implementation_->read(ids); });
}

void World::set_states(std::span<const BodyId> ids, std::span<const BodyState> states)
{
  const minicl::ExactFloatingPoint environment;
  answer("calls to bodies", implementation_->slots.existing(), [&] { implementation_->set_states(ids, states); });
  note(implementation_->log, RecordedCall::set_states, ids, states);
}

void World::set_velocities(std::span<const BodyId> ids, std::span<const Velocity> velocities)
{
  answer("calls to bodies", implementation_->slots.existing(),
         [&] { implementation_->set_velocities(ids, velocities); });
  note(implementation_->log, RecordedCall::set_velocities, ids, velocities);
}

void World::move_to(std::span<const BodyId> ids, std::span<const Pose> poses)
{
  const minicl::ExactFloatingPoint environment;
  answer("calls to bodies", implementation_->slots.existing(), [&] { implementation_->move_to(ids, poses); });
  note(implementation_->log, RecordedCall::move_to, ids, poses);
}

void World::add_impulses(std::span<const BodyId> ids, std::span<const Impulse> impulses)
{
  const minicl::ExactFloatingPoint environment;
  answer("calls to bodies", implementation_->slots.existing(), [&] { implementation_->add_impulses(ids, impulses); });
  note(implementation_->log, RecordedCall::add_impulses, ids, impulses);
}

void World::add_forces(std::span<const BodyId> ids, std::span<const Force> forces)
{
  const minicl::ExactFloatingPoint environment;
  answer("calls to bodies", implementation_->slots.existing(), [&] { implementation_->add_forces(ids, forces); });
  note(implementation_->log, RecordedCall::add_forces, ids, forces);
}

} // namespace tandem
