/* full_day.h - a scripted day in which all of a world changes: beside what scripted_day.h does with bodies, their
 * properties and shapes change, and gravity does; the world is saved, restored from what was saved some steps before,
 * and goes back to states that it kept; in the nights bodies are left alone and fall asleep.
 *
 * All of it follows from the world, the number of the step and the seed, as in scripted_day.h, but for the snapshot: it
 * is the one of the first of several equal worlds, and the others restore it, too, wherever they run. */
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/parity/scripted_day.h"

namespace tandem::parity {

/* What happened to all worlds of a day together. */
struct Happened {
  uint64_t creations = 0, removals = 0, properties = 0, added_shapes = 0, removed_shapes = 0, gravity = 0;
  uint64_t restored = 0, went_back = 0, fell_asleep = 0, woke = 0;
};

/* Properties and shapes that a day draws from. Those of all features bring in kernels, for each set of which an OpenCL
 * compiler takes a minute. */
enum class Changes { without_features, all };

class FullDay {
public:
  /* rounds: of creations, removals and pushes in each step. */
  explicit FullDay(uint64_t seed, Changes changes = Changes::all, uint32_t rounds = 1)
      : day_(seed, 40), seed_(seed), changes_(changes), rounds_(rounds)
  {
  }

  void operator()(World &world, uint64_t step)
  {
    Random random(seed_ + 104729 * step);
    const uint64_t hour = step % length;
    note_sleep(world);
    if (step % save_every == 32) restore(world, step);
    if (hour == 0) world.keep_states(5);
    if (hour < night_from) live(world, step, random);
    if (hour == night_from || hour == 56) stop_all(world);
    if (hour == 76) world.wake_bodies(world.body_ids());
    if (step % save_every == 25) save(world, step);
    if (step % 10 == 4 && world.states_kept() > 0) go_back(world, random);
  }

  static constexpr uint64_t length = 80; /* in steps; more than half of it is night */

  const Happened &happened() const { return *happened_; }
  static Settings settings()
  {
    Settings settings;
    settings.events = settings.sleeping = true;
    settings.step = 1 / 30.0f; /* so that a night is long enough to fall and come to rest */
    settings.sleep_time = 0.05f;
    settings.sleep_speed = 0.3f;
    return settings;
  }

private:
  /* Bodies that come last fall for half of the night. */
  static constexpr uint64_t night_from = 33, save_every = 40;
  static double coordinate(Random &random) { return random.uniform(-1, 1); }
  static Vec3 vector(Random &random)
  {
    Vec3 v;
    for (float &x : v) x = static_cast<float>(coordinate(random));
    return v;
  }

  void note_sleep(World &world)
  {
    for (const SleepEvent &event : world.sleep_events()) ++(event.asleep ? happened_->fell_asleep : happened_->woke);
  }

  /* Balls would roll all night, and the sweeper moves as it was told last. */
  static void stop_all(World &world)
  {
    const std::vector<BodyId> ids = world.body_ids();
    world.set_velocities(ids, std::vector<Velocity>(ids.size()));
  }

  void live(World &world, uint64_t step, Random &random)
  {
    for (uint64_t round = 0; round < rounds_; ++round) create_and_destroy(world, step + 1'000'003 * round);
    if (world.scene().materials.size() < 2) world.add_material({"ice", 0.1f, 0.05f});
    for (int k = 0; k < 2; ++k)
      if (const std::optional<BodyId> id = any_but_half_spaces(world, random)) change_property(world, *id, random);
    if (changes_ == Changes::all && step % 10 > 4) change_shapes(world, random); /* forgets the states kept so far */
    if (random.below(12) != 0) return;
    world.set_gravity({vector(random)[0], -9.81f + vector(random)[0], vector(random)[0]});
    ++happened_->gravity;
  }
  void create_and_destroy(World &world, uint64_t step)
  {
    const std::vector<BodyId> before = world.body_ids();
    day_(world, step);
    const auto gone = std::count_if(before.begin(), before.end(), [&](const BodyId &id) { return !world.exists(id); });
    happened_->removals += static_cast<uint64_t>(gone);
    happened_->creations += world.body_count() + static_cast<uint64_t>(gone) - before.size();
  }

  /* Neither the floor nor the sweeper; a half-space can be neither dynamic nor part of a compound. */
  static std::optional<BodyId> any_but_half_spaces(World &world, Random &random)
  {
    const std::vector<BodyId> ids = world.body_ids();
    if (ids.size() < 3) return std::nullopt;
    const BodyId id = ids[2 + random.below(static_cast<uint32_t>(ids.size() - 2))];
    if (world.scene().shapes[world.scene().bodies[id.index].shape].type == ShapeType::half_space) return std::nullopt;
    return id;
  }

  void change_property(World &world, const BodyId &id, Random &random)
  {
    const auto some = [&](double most) { return static_cast<float>(random.uniform(0.1, most)); };
    const float one = some(2), other = some(9); /* drawn here, because arguments have no order */
    const uint32_t group = random.below(3), choice = random.below(3);
    ++happened_->properties;
    switch (random.below(changes_ == Changes::all ? 13 : 7)) {
    case 0: return world.set_type(id, BodyType{choice});
    case 1: return world.set_mass(id, one);
    case 2: return world.set_mass(id, 2, {1, 1.2f, 0.9f});
    case 3: return world.set_properties(id, {.infinite_inertia = choice == 0});
    case 4: return world.set_gravity_factor(id, one);
    case 5: return world.set_material(id, choice % 2);
    case 6: return world.set_user_data(id, uint64_t{group} << 33 | choice);
    case 7: return world.set_damping(id, one, 0.1f * other);
    case 8: return world.set_filter(id, 1u << group, ~(1u << choice));
    case 9: return world.set_trigger(id, choice == 0);
    case 10: return world.set_continuous(id, choice == 0);
    case 11: return world.set_locks(id, {choice == 0, false, group == 0}, {false, true, false});
    default: return world.set_max_speeds(id, other, other);
    }
  }

  void change_shapes(World &world, Random &random)
  {
    const std::array<Shape, 3> all = {sphere_shape(0.2f), box_shape(0.3f, 0.1f, 0.2f), capsule_shape(0.1f, 0.2f)};
    if (const std::optional<BodyId> id = any_but_half_spaces(world, random); id && world.shapes_of(*id).size() < 4) {
      const Shape &shape = all[random.below(3)];
      world.add_shape_to(*id, child_at(shape, vector(random)));
      ++happened_->added_shapes;
    }
    if (random.below(2) == 0) return;
    for (const BodyId &id : world.body_ids()) {
      const std::vector<ShapeId> shapes = world.shapes_of(id);
      if (shapes.size() < 2) continue;
      world.remove_shape(shapes[random.below(static_cast<uint32_t>(shapes.size()))]);
      ++happened_->removed_shapes;
      return;
    }
  }

  /* Equal worlds have equal bytes, so that it does not matter whose are kept. */
  void save(World &world, uint64_t step)
  {
    std::vector<std::byte> bytes = world.save();
    if (saved_->step == step && saved_->bytes != bytes)
      throw std::logic_error("a world's snapshot differs from that of its equal before step " + std::to_string(step));
    if (saved_->step != step) *saved_ = {step, std::move(bytes)};
  }
  void restore(World &world, uint64_t step)
  {
    if (saved_->step + 7 != step) throw std::logic_error("no snapshot before step " + std::to_string(step));
    world.restore(saved_->bytes);
    ++happened_->restored;
  }
  void go_back(World &world, Random &random)
  {
    world.go_back(random.below(world.states_kept()));
    ++happened_->went_back;
  }

  struct Saved {
    uint64_t step = 0;
    std::vector<std::byte> bytes;
  };

  ScriptedDay day_;
  uint64_t seed_;
  Changes changes_;
  uint32_t rounds_;
  std::shared_ptr<Saved> saved_ = std::make_shared<Saved>(); /* copies of a day share it, and what happened */
  std::shared_ptr<Happened> happened_ = std::make_shared<Happened>();
};

} // namespace tandem::parity
