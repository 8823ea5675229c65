/* controls.cpp - see controls.h. */
#include "tools/bench/controls.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include <tandem/load_scene.h>
#include <tandem/worlds.h>

#include "host/base/random.h"
#include "host/catalog/catalog.h"
#include "host/runtime/interface/kernel_list.h"
#include "tools/bench/controls_error.h"
#include "tools/command/measure.h"
#include "tools/command/progress.h"
#include "tools/command/scene_options.h"

namespace tandem {
namespace {

constexpr const char *robot_unless_given = "humanoid";
constexpr uint32_t worlds_unless_given = 1024, turns = 4, steps_of_turn = 50;
constexpr uint64_t untimed_steps = uint64_t{turns} * steps_of_turn, steps_unless_given = untimed_steps;
constexpr uint64_t profiled_steps = 20; /* after those that are timed, because measuring kernels slows launches */
constexpr size_t most_kernels_of_text = 8;
constexpr float control_step = 0.005f; /* s, as learners of walking take it */
constexpr float largest_force = 40;    /* N m, or N, of axes without actuators */

struct ControlsTime {
  std::string scene;
  uint32_t worlds = 0;
  size_t controls = 0;             /* of each world */
  double set = 0, step = 0;        /* ms for all worlds, on average over the steps */
  double contacts = 0;             /* points of a world, at the end */
  std::vector<KernelTime> kernels; /* of the profiled steps, the longest first */
};

/* Forces on hinges and sliders, which have one axis each. */
std::vector<Actuator> actuators_of_damped_axes(const Scene &scene)
{
  std::vector<Actuator> actuators;
  for (uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
    const Joint &one = scene.joints[joint];
    const bool is_hinge = one.type == JointType::hinge;
    const JointAxis &axis = is_hinge ? one.rotations[0] : one.directions[0];
    if ((is_hinge || one.type == JointType::slider) && axis.damping > 0 && !axis.motor)
      actuators.push_back({.name = one.name,
                           .joint = joint,
                           .axis = is_hinge ? 3u : 0u,
                           .lower = -largest_force,
                           .upper = largest_force});
  }
  if (actuators.empty())
    throw InputError(
        fmt::format("{}: it has no actuators, and no hinge or slider has damping; there is none to drive", scene.name));
  return actuators;
}

/* Those of the scene, as a learner has them, if there are some. One without a range has controls from -1 to 1. */
std::vector<Actuator> driving_actuators(const Scene &scene)
{
  std::vector<Actuator> actuators = scene.actuators.empty() ? actuators_of_damped_axes(scene) : scene.actuators;
  for (Actuator &actuator : actuators) {
    if (std::isfinite(actuator.lower) && std::isfinite(actuator.upper)) continue;
    actuator.lower = std::clamp(-1.0f, actuator.lower, actuator.upper);
    actuator.upper = std::clamp(1.0f, actuator.lower, actuator.upper);
  }
  return actuators;
}

Settings driven_settings()
{
  Settings settings;
  settings.step = control_step;
  settings.substeps = 1;
  return settings;
}

using Clock = std::chrono::steady_clock;
double milliseconds_from(Clock::time_point start, Clock::time_point end)
{
  return std::chrono::duration<double, std::milli>(end - start).count();
}

class DrivenWorlds {
public:
  DrivenWorlds(const Scene &scene, uint32_t worlds, const Placement &placement)
      : worlds_(scene, worlds, driven_settings(), placement), actuators_(driving_actuators(worlds_.scene(0))),
        values_(worlds * actuators_.size())
  {
    worlds_.choose_controls(actuators_);
  }

  ControlsTime run(uint64_t steps)
  {
    prepare_for_timing(worlds_);
    Progress progress(fmt::format("{} worlds", worlds_.count()), untimed_steps + steps);
    ControlsTime time;
    for (uint64_t step = 0; step < untimed_steps + steps; ++step) {
      if (step == untimed_steps) time.set = time.step = 0;
      advance(step, time);
      progress.update(step + 1);
    }
    time.worlds = worlds_.count();
    time.controls = actuators_.size();
    time.set /= static_cast<double>(steps);
    time.step /= static_cast<double>(steps);
    time.contacts = static_cast<double>(worlds_.statistics().contacts) / worlds_.count();
    time.kernels = profiled(untimed_steps + steps);
    return time;
  }

private:
  void advance(uint64_t step, ControlsTime &time)
  {
    for (size_t i = 0; i < values_.size(); ++i) {
      const Actuator &actuator = actuators_[i % actuators_.size()];
      values_[i] = static_cast<float>(random_.uniform(double{actuator.lower}, double{actuator.upper}));
    }
    worlds_.finish();
    const Clock::time_point before = Clock::now();
    if (step % steps_of_turn == 0) begin_anew(step / steps_of_turn % turns);
    worlds_.set_controls(values_);
    const Clock::time_point between = Clock::now();
    worlds_.step();
    worlds_.finish();
    time.set += milliseconds_from(before, between);
    time.step += milliseconds_from(between, Clock::now());
  }
  std::vector<KernelTime> profiled(uint64_t first_step)
  {
    ControlsTime untold;
    worlds_.set_profiling(true);
    worlds_.take_kernel_times();
    for (uint64_t step = first_step; step < first_step + profiled_steps; ++step) advance(step, untold);
    std::vector<KernelTime> kernels = worlds_.take_kernel_times();
    worlds_.set_profiling(false);
    std::sort(kernels.begin(), kernels.end(),
              [](const KernelTime &a, const KernelTime &b) { return a.milliseconds > b.milliseconds; });
    return kernels;
  }
  void begin_anew(uint64_t turn)
  {
    std::vector<uint32_t> numbers;
    for (auto world = static_cast<uint32_t>(turn); world < worlds_.count(); world += turns) numbers.push_back(world);
    worlds_.reset(numbers);
  }

  Worlds worlds_;
  std::vector<Actuator> actuators_;
  std::vector<float> values_;
  Random random_{1};
};

double driven_steps_a_second(const ControlsTime &time)
{
  return 1e3 * time.worlds / std::max(time.set + time.step, 1e-9);
}

double milliseconds_of_step(const KernelTime &kernel) { return kernel.milliseconds / profiled_steps; }

std::string text_of_kernels(const std::vector<KernelTime> &kernels)
{
  std::string text = "  ms of a step in kernels:";
  for (size_t k = 0; k < std::min(kernels.size(), most_kernels_of_text); ++k)
    text += fmt::format("{} {} {:.3f}", k ? "," : "", row_of(kernels[k].kernel).name, milliseconds_of_step(kernels[k]));
  return text + "\n";
}

Json json_of_kernels(const std::vector<KernelTime> &kernels)
{
  Json list = Json::array();
  for (const KernelTime &kernel : kernels)
    list.push_back({{"name", row_of(kernel.kernel).name},
                    {"backend", kernel.backend},
                    {"launches", static_cast<double>(kernel.launches) / profiled_steps},
                    {"ms", milliseconds_of_step(kernel)}});
  return list;
}

std::string text_of(const ControlsTime &time, uint64_t steps)
{
  return fmt::format("  {}: {} worlds, {} controls drawn anew for each in {} steps of {:g} ms\n"
                     "  setting them {:.3f} ms, stepping {:.3f} ms: {:.0f} world-steps/s; {:.1f} contact points in a "
                     "world\n",
                     time.scene, time.worlds, time.controls, steps, 1e3 * control_step, time.set, time.step,
                     driven_steps_a_second(time), time.contacts) +
         text_of_kernels(time.kernels);
}

Json json_of(const ControlsTime &time)
{
  return {{"scene", time.scene},
          {"worlds", time.worlds},
          {"controls", time.controls},
          {"set_ms", time.set},
          {"step_ms", time.step},
          {"world_steps_per_second", driven_steps_a_second(time)},
          {"contact_points", time.contacts},
          {"kernels", json_of_kernels(time.kernels)}};
}

/* What the benchmark tells of one robot. */
struct RobotReport {
  std::string text;
  Json json;
};

RobotReport report_of(const std::string &name, uint32_t worlds, uint64_t steps, const BenchOptions &options)
{
  const Scene scene = load_scene(name, OutsideFiles::allowed, Coordinates::reduced);
  if (options.error) check_comparable(scene); /* before the time that the rest takes */
  const Placement placement{options.on, {}, options.inexact};
  ControlsTime time = DrivenWorlds(scene, worlds, placement).run(steps);
  time.scene = name;
  RobotReport report{text_of(time, steps), json_of(time)};
  if (options.error) {
    const ControlsError error = controls_error(scene, driving_actuators(scene), std::min(worlds, most_worlds_of_error),
                                               driven_settings(), placement);
    report.text += text_of(error);
    report.json["error"] = json_of(error);
  }
  return report;
}

} // namespace

int execute_controls(const BenchOptions &options)
{
  const std::vector<std::string> scenes =
      options.scenes.empty() ? std::vector<std::string>{robot_unless_given} : scenes_of_parts(options.scenes);
  const auto worlds = options.count.empty()
                          ? worlds_unless_given
                          : static_cast<uint32_t>(whole_number("--n", options.count, 1, most_bodies / 16));
  const uint64_t steps =
      options.steps.empty() ? steps_unless_given : whole_number("--steps", options.steps, 1, uint64_t{1000000});
  options.json.check();
  Json robots = Json::array();
  for (const std::string &name : scenes) {
    const RobotReport report = report_of(name, worlds, steps, options);
    if (!options.json.takes_standard_output()) fmt::print("controls on {}\n{}", options.on, report.text);
    robots.push_back(report.json);
  }
  options.json.write({{"what", options.what}, {"backend", options.on}, {"robots", robots}});
  return 0;
}

} // namespace tandem
