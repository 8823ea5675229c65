/* broadphase.h - `tandem bench broadphase`: every broadphase on the same moving bodies, from thousands to a million of
 * them.
 *
 * They must give the same pair list in every frame; otherwise the benchmark reports which one did not. They are
 * compared by how time grows with the number of bodies: the slope of the line through the two largest numbers on a
 * chart with two logarithmic axes.
 */
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/pipeline/broadphases/broadphase.h"
#include "tools/bench/broadphase_inputs.h"
#include "tools/bench/options.h"
#include "tools/command/measure.h"
#include "tools/command/output.h"

namespace tandem {

/* One broadphase on so many bodies of an input. */
struct BroadphaseRun {
  std::string broadphase;
  uint32_t bodies = 0;
  std::string skipped;              /* why it did not run; empty if it did */
  std::vector<double> milliseconds; /* of the timed frames */
  std::vector<uint32_t> pairs;      /* of all frames, */
  std::vector<uint64_t> hashes;     /* warm-up frames included */
  std::string difference;           /* where its pairs differ from those of the others; empty if nowhere */
};

struct BroadphaseScene {
  const BroadphaseInput *input;
  std::vector<BroadphaseRun> runs; /* by bodies, then by broadphase */
};

struct BroadphaseRequest {
  std::string backend;
  std::vector<uint32_t> bodies; /* ascending */
  std::vector<BroadphaseRow> broadphases;
  std::vector<const BroadphaseInput *> inputs;
  bool allow_inexact = false;
};

/* The broadphases and inputs with these names, in the order of the list, or all if no names are given. Throws
 * InputError for a scene that does not exist. */
BroadphaseRequest broadphase_request(const std::vector<std::string> &broadphases,
                                     const std::vector<std::string> &scenes);

/* `after_scene` is called after each scene, because all together take minutes. Throws InputError as make_backend
 * does. */
std::vector<BroadphaseScene> bench_broadphase(const BroadphaseRequest &request,
                                              const std::function<void(const BroadphaseScene &)> &after_scene = {});

struct TimeAt {
  double bodies, milliseconds;
};
/* d log(time) / d log(bodies) between the last two: 1 if time is proportional to bodies, 2 if it is to their square.
 * Nothing if there are fewer than two. */
std::optional<double> slope_of(const std::vector<TimeAt> &times);
/* The expected time of a frame of so many bodies, extrapolated with that slope, clamped to 1 .. 2, or with 2 after a
 * single time; nothing without any time. */
std::optional<double> predicted_milliseconds(const std::vector<TimeAt> &times, double bodies);

/* One line for each difference. */
std::vector<std::string> differences_of(const std::vector<BroadphaseScene> &scenes);
std::string broadphase_text(const BroadphaseScene &scene);
Json broadphase_json(const BroadphaseScene &scene);
/* One chart for each scene, one below the other. */
std::string broadphase_chart(const std::vector<BroadphaseScene> &scenes, const std::string &backend);

/* The exit status is 1 if any two broadphases give different pairs. */
int execute_broadphase(const BenchOptions &options);

} // namespace tandem
