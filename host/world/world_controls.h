/* world_controls.h - what a program sets of the axes of joints in every step of a batch, such as the torques of robots.
 *
 * set_joint_axes checks whole joints and writes whole tables, milliseconds of a thousand robots. The controls are
 * checked once, when they are chosen. From then on a value goes into a copy of the one row of its axis that it changes,
 * and the rows of all axes are uploaded together:
 *
 *   link_range       lower  upper  target position  target velocity      of links of articulations
 *   joint_axis_row   the same, the first of the three rows of an axis    of other joints
 */
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <tandem/worlds.h>

#include "host/runtime/memory.h"
#include "host/world/implementation.h"
#include "host/world/scene_tables.h"

namespace tandem {

class Worlds::Controls {
public:
  Controls() = default;
  /* Throws InputError that names the first axis which cannot be controlled so. */
  Controls(const World::Implementation &engine, const SceneTables &tables, std::span<const ControlledAxis> axes);
  Controls(const World::Implementation &engine, const SceneTables &tables, std::span<const Actuator> actuators);

  size_t count() const { return chosen_.size(); } /* of each world */
  /* Checks what set() sets, and makes room for it; if it throws, nothing has changed. values: of each of these worlds
   * in turn. */
  void prepare(World::Implementation &engine, std::span<const uint32_t> worlds, std::span<const float> values);
  void set(World::Implementation &engine);
  /* The scene has what was set only after this, because a joint of it is far from the next one in memory. */
  void write_scene(Scene &scene);

private:
  /* A control of a world: what it writes, and where. */
  struct Target {
    uint32_t joint; /* of the scene of all worlds */
    Buffer buffer;
    uint32_t place; /* in the buffer: the number of a real */
  };
  /* What a row gets of a value: rest + value / divisor, as row_of_axis has it. Of each target, in arrays of their own,
   * because all of them are read in each step. */
  struct Maps {
    std::vector<float> value, divisor; /* divisor: the damping where the value is a force, else 1 */
    std::vector<float> rest;   /* of the speed to which the damper pulls: what the other of force and target velocity
                                makes; -0, which changes no bit of a sum, where there is none */
    std::vector<float> surely; /* of each control, all worlds: numbers up to this size can be held, and perhaps more */
  };
  /* Numbers of one buffer. */
  struct Written {
    Buffer buffer;
    std::vector<uint32_t> targets, places;
  };
  /* values: of the controls of that world; numbers: those of its axes for which they stand. */
  void find_numbers(const float *values, float *numbers) const;
  void check(uint32_t world, uint32_t in_message, const float *values, const float *numbers) const;
  void find_written(size_t world, const float *numbers, float *written) const;
  void keep(uint32_t world, const float *numbers);
  bool is_swapped() const;
  bool writes(size_t control) const;
  std::vector<Written> written_of(std::span<const uint32_t> worlds) const;
  const std::vector<Written> &written_of_all();
  static void make_room(Memory &memory, const Written &written);
  void write(World::Implementation &engine, const Written &written);
  void add_checked_target(const World::Implementation &engine, uint32_t joint, const ControlledAxis &control,
                          const std::string &where);
  void add_target(const World::Implementation &engine, uint32_t joint, const ControlledAxis &control);
  void add_map(const JointAxis &axis, const ControlledAxis &control);
  void find_targets_anew(World::Implementation &engine);

  std::vector<ControlledAxis> chosen_;
  std::vector<size_t> partner_;     /* of each control: the other one of the speed to which the damper pulls, or none */
  std::vector<Actuator> actuators_; /* of each control; none if axes were chosen */
  std::vector<Target> targets_;     /* [world, control] */
  Maps maps_;
  std::vector<uint32_t> worlds_; /* of the call that goes on, as the next two; kept for the next one */
  std::vector<float> numbers_;
  std::vector<Written> of_some_; /* unless it is of all */
  bool is_of_all_ = false;
  std::vector<float> written_;      /* of each target: what its row has */
  std::vector<float> next_written_; /* and what it will have */
  std::vector<Written> of_all_;     /* made when it is first asked for */
  bool has_places_of_all_ = false;  /* whether control_place has those of the only list of of_all_ */
  uint64_t allocations_then_ = 0;   /* of buffers, when it got them */
  uint64_t joints_number_ = 0;      /* World::Implementation::joints_number when the targets were found */
  bool scene_is_behind_ = false;
};

} // namespace tandem
