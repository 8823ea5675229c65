/* world_controls.cpp - see world_controls.h. */
#include "host/world/world_controls.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include <tandem/error.h>

#include "host/pipeline/scene_counts.h"
#include "host/runtime/parts.h"
#include "host/scene/actuators.h"
#include "host/scene/articulation_order.h"
#include "host/scene/joint_buffers.h"
#include "host/scene/joint_rows.h"
#include "shared/joints/joint_codes.h"

namespace tandem {
namespace {

/* A force is a damper towards a speed that a float must hold: damper_of in host/scene/joint_buffers.cpp. */
bool can_hold(float damping, float force) { return std::abs(force) / fastest_damper <= damping; }

/* Why an axis cannot have the control; nullptr: it can. */
const char *lack_of(const JointAxis &axis, Control what)
{
  const bool damped = axis.damping > 0;
  switch (what) {
  case Control::force:
    if (axis.motor) return "is a motor, which has no force; control its target_velocity";
    if (!damped) return "has no damping; a force needs some, and 1e-6 is enough";
    return can_hold(axis.damping, axis.force) ? nullptr : "has a force too large for its damping";
  case Control::target_position: return axis.stiffness > 0 ? nullptr : "has no stiffness to pull it to a position";
  case Control::target_velocity:
    return damped || axis.motor ? nullptr : "is no motor and has no damping to bring it to a velocity";
  }
  return "has no control of that kind";
}

/* The tree of an articulation has one axis of a hinge or slider; a ball has others only where they are rows. */
bool is_axis_of_tree(const Joint &joint, uint32_t axis)
{
  return (joint.type == JointType::hinge && axis == 3) || (joint.type == JointType::slider && axis == 0);
}

void check_control(const Joint &joint, bool in_tree, const ControlledAxis &control, const std::string &where)
{
  const auto fail = [&](const std::string &why) { throw InputError(where + why); };
  if (!joint.enabled) fail("is not enabled");
  if (control.axis >= 6)
    fail(fmt::format("axis {} does not exist; 0 to 2 are directions, 3 to 5 rotations", control.axis));
  if (kind_of_axis(joint, control.axis) == JOINT_AXIS_NONE) fail(fmt::format("axis {} is not free", control.axis));
  if (in_tree && !has_rows_besides_tree(joint) && !is_axis_of_tree(joint, control.axis))
    fail(fmt::format("axis {} is one of a ball of an articulation; hinges and sliders have controls there",
                     control.axis));
  if (const char *lack = lack_of(axis_of(joint, control.axis), control.what))
    fail(fmt::format("axis {} {}", control.axis, lack));
}

void check_distinct(std::span<const ControlledAxis> axes)
{
  for (size_t i = 0; i < axes.size(); ++i)
    for (size_t k = 0; k < i; ++k)
      if (axes[i].joint == axes[k].joint && axes[i].axis == axes[k].axis && axes[i].what == axes[k].what)
        throw InputError(fmt::format("choose_controls: entries {} and {} set the same of one axis; one of them is "
                                     "needed",
                                     k, i));
}

constexpr size_t no_partner = size_t(-1);

/* A force and a target velocity of one axis are one number of its row. */
std::vector<size_t> partners_among(std::span<const ControlledAxis> axes)
{
  std::vector<size_t> partners(axes.size(), no_partner);
  for (size_t i = 0; i < axes.size(); ++i)
    for (size_t k = 0; k < i; ++k)
      if (axes[i].joint == axes[k].joint && axes[i].axis == axes[k].axis && axes[i].what != Control::target_position &&
          axes[k].what != Control::target_position) {
        partners[i] = k;
        partners[k] = i;
      }
  return partners;
}

std::vector<ControlledAxis> axes_of(std::span<const Actuator> actuators)
{
  std::vector<ControlledAxis> axes;
  for (const Actuator &actuator : actuators) axes.push_back({actuator.joint, actuator.axis, actuator.sets});
  return axes;
}

void check_maps(std::span<const Actuator> actuators)
{
  for (size_t k = 0; k < actuators.size(); ++k) {
    const Actuator &one = actuators[k];
    if (std::isfinite(one.offset) && std::isfinite(one.factor) && has_control_range(one)) continue;
    throw InputError(
        fmt::format("choose_controls: entry {}: offset {:g}, factor {:g}, controls from {:g} to {:g}; finite "
                    "numbers are needed, and lower at most upper",
                    k, one.offset, one.factor, one.lower, one.upper));
  }
}

/* The place of the axis among those that the joint limits, drives or brakes. */
uint32_t place_of_axis(const Joint &joint, uint32_t kind)
{
  const std::vector<UsedAxis> used = axes_used_by(joint);
  const auto found = std::find_if(used.begin(), used.end(), [&](const UsedAxis &one) { return one.kind == kind; });
  return static_cast<uint32_t>(found - used.begin());
}

bool are_distinct(std::span<const uint32_t> worlds)
{
  return std::adjacent_find(worlds.begin(), worlds.end(), std::greater_equal<>{}) == worlds.end();
}

template <class Function> void for_each_in_parts(size_t items, size_t of_part, const Function &function)
{
  run_parts((items + of_part - 1) / of_part, PartFunction([&](size_t part) {
              const size_t end = std::min(items, (part + 1) * of_part);
              for (size_t i = part * of_part; i < end; ++i) function(i);
            }));
}

/* Runs function(i) for the world at each place i of the list, many at the same time. A list that is not in order may
 * have a world twice, of which the later place counts; its worlds are taken one after another. */
template <class Function> void for_each_world(std::span<const uint32_t> worlds, const Function &function)
{
  constexpr size_t worlds_of_part = 256;
  for_each_in_parts(worlds.size(), are_distinct(worlds) ? worlds_of_part : worlds.size(), function);
}

} // namespace

Worlds::Controls::Controls(const World::Implementation &engine, const SceneTables &tables,
                           std::span<const ControlledAxis> axes)
    : chosen_(axes.begin(), axes.end()), partner_(partners_among(axes)), joints_number_(engine.joints_number)
{
  check_distinct(axes);
  for (uint32_t world = 0; world < tables.worlds(); ++world)
    for (size_t k = 0; k < axes.size(); ++k) {
      const std::string where =
          fmt::format("choose_controls: entry {}: world {}: joint {}: ", k, engine.first_world + world, axes[k].joint);
      if (axes[k].joint >= tables.joints(world))
        throw InputError(fmt::format("{}it does not exist; the world has {} joints", where, tables.joints(world)));
      add_checked_target(engine, tables.first_joint(world) + axes[k].joint, axes[k], where);
    }
}

Worlds::Controls::Controls(const World::Implementation &engine, const SceneTables &tables,
                           std::span<const Actuator> actuators)
    : Controls(engine, tables, axes_of(actuators))
{
  check_maps(actuators);
  actuators_.assign(actuators.begin(), actuators.end());
}

void Worlds::Controls::add_checked_target(const World::Implementation &engine, uint32_t joint,
                                          const ControlledAxis &control, const std::string &where)
{
  check_control(engine.scene.joints[joint], engine.is_in_tree(joint), control, where);
  add_target(engine, joint, control);
}

void Worlds::Controls::add_target(const World::Implementation &engine, uint32_t joint, const ControlledAxis &control)
{
  const Joint &whole = engine.scene.joints[joint];
  Target target{joint, Buffer::link_range, 0};
  size_t row = 0;
  if (engine.is_in_tree(joint) && !has_rows_besides_tree(whole)) {
    const TreePlace &place = engine.links.places[engine.links.of_joint[joint]];
    row = place.row(1, engine.links.number_of_joint[joint], 0);
  } else {
    const size_t plane = size_t{3} * place_of_axis(whole, kind_of_axis(whole, control.axis));
    target.buffer = Buffer::joint_axis_row;
    row = plane * engine.scene.joints.size() + engine.joint_order.place_of(joint);
  }
  target.place = static_cast<uint32_t>(4 * row + (control.what == Control::target_position ? 2 : 3));
  add_map(axis_of(whole, control.axis), control);
  targets_.push_back(target);
}

void Worlds::Controls::add_map(const JointAxis &axis, const ControlledAxis &control)
{
  JointAxis rest = axis;
  maps_.value.push_back(controlled_number(rest, control.what));
  controlled_number(rest, control.what) = 0;
  const auto rows = row_of_axis(rest);
  const float damping = rows[1].y;
  const bool is_force = control.what == Control::force, is_position = control.what == Control::target_position;
  maps_.divisor.push_back(is_force ? damping : 1);
  maps_.rest.push_back(is_force || (damping > 0 && !is_position) ? rows[0].w : -0.0f);
  const size_t number = targets_.size() % count();
  float surely = std::numeric_limits<float>::max();
  if (is_force) surely = std::min(surely, 0.999f * fastest_damper * damping);
  if (maps_.surely.size() <= number) maps_.surely.push_back(surely);
  else maps_.surely[number] = std::min(maps_.surely[number], surely);
}

/* Joints that came or went since have moved the rows; the values are those that other calls have set since. */
void Worlds::Controls::find_targets_anew(World::Implementation &engine)
{
  if (joints_number_ == engine.joints_number) return;
  Controls found = *this;
  found.targets_.clear();
  found.maps_ = {};
  for (size_t i = 0; i < targets_.size(); ++i) {
    const uint32_t joint = targets_[i].joint;
    const ControlledAxis &control = chosen_[i % count()];
    const bool broke = !engine.scene.joints[joint].enabled; /* its axis is set as that of any joint */
    const auto where = [&] {
      return fmt::format("set_controls: control {} of world {}: ", i % count(), engine.first_world + i / count());
    };
    if (broke) found.add_target(engine, joint, control);
    else found.add_checked_target(engine, joint, control, where());
  }
  *this = std::move(found);
  of_all_.clear();
  has_places_of_all_ = false;
  joints_number_ = engine.joints_number;
}

void Worlds::Controls::find_numbers(const float *values, float *numbers) const
{
  if (actuators_.empty()) std::copy_n(values, count(), numbers);
  else numbers_at(actuators_, values, numbers);
}

void Worlds::Controls::check(uint32_t world, uint32_t in_message, const float *values, const float *numbers) const
{
  bool are_held = true;
  for (size_t k = 0; k < count(); ++k) are_held &= std::abs(numbers[k]) <= maps_.surely[k];
  if (are_held) return;
  for (size_t k = 0; k < count(); ++k) {
    const bool is_force = chosen_[k].what == Control::force;
    const float damping = maps_.divisor[world * count() + k];
    if (std::isfinite(numbers[k]) && (!is_force || can_hold(damping, numbers[k]))) continue;
    const bool is_mapped = !actuators_.empty() && std::isfinite(values[k]);
    throw InputError(fmt::format(
        "set_controls: control {} of world {} is {:g}{}; {} is needed", k, in_message, values[k],
        is_mapped ? fmt::format(", of which its axis gets {:g}", numbers[k]) : "",
        is_force ? fmt::format("at most {:g}, of its damping {:g}, in size", fastest_damper * damping, damping)
                 : "a finite number"));
  }
}

void Worlds::Controls::find_written(size_t world, const float *numbers, float *written) const
{
  const float *rest = &maps_.rest[world * count()], *divisor = &maps_.divisor[world * count()];
  for (size_t k = 0; k < count(); ++k) written[k] = rest[k] + numbers[k] / divisor[k];
}

/* A force and a target velocity of one axis have the bits of row_of_axis, whichever of them is written. */
void Worlds::Controls::keep(uint32_t world, const float *numbers)
{
  const size_t first = world * count();
  std::copy_n(numbers, count(), &maps_.value[first]);
  for (size_t k = 0; k < count(); ++k)
    if (partner_[k] != no_partner) maps_.rest[first + partner_[k]] = numbers[k] / maps_.divisor[first + k];
  find_written(world, numbers, &written_[first]);
}

/* Whether what is found before a call sets anything becomes what it sets: of all worlds in order, and without partners,
 * of which each changes the rest of the other one. */
bool Worlds::Controls::is_swapped() const
{
  return is_of_all_ && std::all_of(partner_.begin(), partner_.end(), [](size_t k) { return k == no_partner; });
}

/* Of two partners the first one does, so that no number is written twice at the same time. */
bool Worlds::Controls::writes(size_t control) const
{
  return partner_[control] == no_partner || control < partner_[control];
}

std::vector<Worlds::Controls::Written> Worlds::Controls::written_of(std::span<const uint32_t> worlds) const
{
  std::vector<uint32_t> distinct(worlds.begin(), worlds.end());
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  std::vector<Written> all = {{Buffer::link_range, {}, {}}, {Buffer::joint_axis_row, {}, {}}};
  for (const uint32_t world : distinct)
    for (size_t k = 0; k < count(); ++k) {
      const size_t target = world * count() + k;
      if (!writes(k)) continue;
      Written &written = all[targets_[target].buffer == Buffer::link_range ? 0 : 1];
      written.targets.push_back(static_cast<uint32_t>(target));
      written.places.push_back(targets_[target].place);
    }
  std::erase_if(all, [](const Written &written) { return written.targets.empty(); });
  return all;
}

const std::vector<Worlds::Controls::Written> &Worlds::Controls::written_of_all()
{
  if (!of_all_.empty()) return of_all_;
  std::vector<uint32_t> worlds(targets_.size() / count());
  std::iota(worlds.begin(), worlds.end(), 0u);
  of_all_ = written_of(worlds);
  return of_all_;
}

/* So that nothing has changed if there is none. */
void Worlds::Controls::make_room(Memory &memory, const Written &written)
{
  for (const Buffer buffer : {Buffer::control_number, Buffer::control_place}) {
    memory.grow(buffer, written.targets.size() * sizeof(float));
    memory.prepare_upload(buffer);
  }
  memory.prepare_upload(written.buffer);
}

void Worlds::Controls::write(World::Implementation &engine, const Written &written)
{
  const size_t items = written.targets.size();
  const bool is_whole = items == targets_.size(); /* then target i is the one at place i */
  if (!is_whole)
    for (size_t i = 0; i < items; ++i) numbers_[i] = written_[written.targets[i]];
  Memory &memory = engine.memory;
  const size_t bytes = items * sizeof(float);
  memory.upload(Buffer::control_number, (is_whole ? written_ : numbers_).data(), bytes);
  const bool has_places = has_places_of_all_ && allocations_then_ == engine.buffers.allocations();
  if (!has_places || &written != of_all_.data()) memory.upload(Buffer::control_place, written.places.data(), bytes);
  has_places_of_all_ = of_all_.size() == 1 && &written == of_all_.data();
  allocations_then_ = engine.buffers.allocations();
  const auto length = static_cast<uint32_t>(items);
  set_length(memory, length);
  engine.launcher.launch({Kernel::scatter_reals,
                          {Buffer::control_number, Buffer::control_place, written.buffer},
                          {1, 0, 1},
                          COUNT_ZERO,
                          COUNT_LENGTH,
                          length});
}

void Worlds::Controls::prepare(World::Implementation &engine, std::span<const uint32_t> worlds,
                               std::span<const float> values)
{
  worlds_.assign(worlds.begin(), worlds.end());
  if (values.empty()) return;
  find_targets_anew(engine);
  is_of_all_ = worlds.size() * count() == targets_.size() && are_distinct(worlds);
  written_.resize(targets_.size());
  next_written_.resize(targets_.size());
  numbers_.resize(values.size());
  const bool swaps = is_swapped();
  for_each_world(worlds, [&](size_t i) {
    float *numbers = &numbers_[i * count()];
    find_numbers(&values[i * count()], numbers);
    check(worlds[i], engine.first_world + worlds[i], &values[i * count()], numbers);
    if (swaps) find_written(i, numbers, &next_written_[i * count()]);
  });
  engine.settle();
  engine.buffers.make_ready(engine.sizes());
  if (!is_of_all_) of_some_ = written_of(worlds);
  for (const Written &written : is_of_all_ ? written_of_all() : of_some_) make_room(engine.memory, written);
}

void Worlds::Controls::set(World::Implementation &engine)
{
  if (worlds_.empty() || count() == 0) return;
  if (is_swapped()) {
    std::swap(maps_.value, numbers_);
    std::swap(written_, next_written_);
  } else {
    for_each_world(worlds_, [&](size_t i) { keep(worlds_[i], &numbers_[i * count()]); });
  }
  ++engine.state;
  scene_is_behind_ = true;
  for (const Written &written : is_of_all_ ? of_all_ : of_some_) write(engine, written);
}

void Worlds::Controls::write_scene(Scene &scene)
{
  if (!scene_is_behind_) return;
  for (size_t i = 0; i < targets_.size(); ++i) {
    const ControlledAxis &control = chosen_[i % count()];
    controlled_number(axis_of(scene.joints[targets_[i].joint], control.axis), control.what) = maps_.value[i];
  }
  scene_is_behind_ = false;
}

} // namespace tandem
