/* scenes.h - `tandem bench scenes`: what each built-in scene takes, in kernels, launches, bytes and milliseconds. A
 * scene should pay for nothing that it does not need; this is where that is counted. */
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tandem/backend.h>
#include <tandem/settings.h>

#include "tools/bench/options.h"
#include "tools/command/measure.h"
#include "tools/command/output.h"

namespace tandem {

/* The steps before the timed ones are one second, in which most scenes come to have contacts. */
constexpr uint64_t scene_warm_steps = 60, scene_timed_steps = 20;

struct ScenesRequest {
  std::vector<std::string> scenes; /* as load_scene reads them */
  uint64_t steps = scene_timed_steps;
  Settings settings;
  Placement placement;
};

struct SceneCost {
  std::string scene;
  bool specialised = true;
  std::string failure; /* why it did not run to its end; empty if it did, or nothing below is known */
  uint64_t moving = 0; /* bodies that are not fixed */
  uint64_t kernels = 0, bytes = 0;
  double build_milliseconds = 0;
  Spread launches{}, milliseconds{}; /* a step, over the timed ones */
  uint32_t pairs = 0, contacts = 0;  /* of the last step */
};

/* Every scene, and the first of them once more with all features. One that fails does not stop the others. Throws
 * InputError alone, for what is wrong with the request. */
std::vector<SceneCost> bench_scenes(const ScenesRequest &request);

/* Throws InputError that lists the names unless each is that of a built-in scene. No names stand for all scenes. */
std::vector<std::string> scene_names(const std::vector<std::string> &wanted);

std::vector<std::string> failures_of(const std::vector<SceneCost> &costs); /* a line each */
std::string scenes_text(const std::vector<SceneCost> &costs);
std::string scenes_markdown(const std::vector<SceneCost> &costs);
Json scenes_json(const std::vector<SceneCost> &costs);

/* Of the options of bench scenes and bench left-out. */
ScenesRequest scenes_request(const BenchOptions &options);
/* The command line that repeats the run, for the page that gets its table. */
std::string scenes_command_text(const BenchOptions &options);

/* The exit status is 1 if a scene failed; its row says so, and those of the others stand. */
int execute_scenes(const BenchOptions &options);

} // namespace tandem
