/* starts.h - `tandem bench starts`: the time from nothing to the first step of a scene, and to its first step on the
 * device, with the caches of the driver empty and filled, and with the first steps on the device and on the CPU.
 *
 * Each start is made by a process of its own, because a driver keeps in memory what it has compiled.
 */
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tandem/backend.h>

#include "tools/bench/options.h"
#include "tools/command/output.h"

namespace tandem {

struct StartTime {
  std::string scene;
  bool cached = false;
  Start start = Start::on_device;
  uint64_t kernels = 0, steps_on_cpu = 0;
  /* In ms since the process began: */
  double made = 0;        /* the world is */
  double first_step = 0;  /* has been made */
  double device_step = 0; /* the first one that ran on the device */
  /* The longest step of all these, without pauses. */
  double longest_step = 0;
  std::string hash; /* of the state after the first step */
};

/* Throws InputError if the placement is on no device, or a scene does not exist. */
std::vector<StartTime> bench_starts(const std::vector<std::string> &scenes, const Placement &placement);

/* A line for each start whose first step has other bits than the first start of its scene. */
std::vector<std::string> differences_of(const std::vector<StartTime> &starts);

std::string starts_text(const std::vector<StartTime> &starts);
std::string starts_markdown(const std::vector<StartTime> &starts);
Json starts_json(const std::vector<StartTime> &starts);

/* The exit status is 1 if two starts of a scene differ in their bits. */
int execute_starts(const BenchOptions &options);

} // namespace tandem
