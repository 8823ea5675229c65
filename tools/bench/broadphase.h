/* broadphase.h - `tandem bench broadphase`: every broadphase on the same moving bodies, from thousands to a
 * million of them.
 *
 * They must give the same pair list in every frame, or the benchmark says which did not. How time grows with the number
 * of bodies is what tells them apart: the slope of the line through the two largest on a chart whose axes are both
 * logarithmic.
 */
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/pipeline/broadphases/broadphase.h"
#include "tools/bench/broadphase_inputs.h"
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
  std::vector<uint64_t> hashes;     /* warm ones included */
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

/* Of all that there is those that are named, in the order of the list; all if none are. InputError for a scene that
 * does not exist. */
BroadphaseRequest broadphase_request(const std::vector<std::string> &broadphases,
                                     const std::vector<std::string> &scenes);

/* `after_scene` hears of each as it is done: all take minutes. InputError as make_backend. */
std::vector<BroadphaseScene> bench_broadphase(const BroadphaseRequest &request,
                                              const std::function<void(const BroadphaseScene &)> &after_scene = {});

struct TimeAt {
  double bodies, milliseconds;
};
/* d log(time) / d log(bodies) between the last two: 1 where time is proportional to bodies, 2 to their square. None
 * with less than two. */
std::optional<double> slope_of(const std::vector<TimeAt> &times);
/* What a frame of so many bodies may take: along that slope, taken to be 1 to 2, and 2 after one time; none without
 * any. */
std::optional<double> predicted_milliseconds(const std::vector<TimeAt> &times, double bodies);

/* One line each. */
std::vector<std::string> differences_of(const std::vector<BroadphaseScene> &scenes);
std::string broadphase_text(const BroadphaseScene &scene);
Json broadphase_json(const BroadphaseScene &scene);
/* One chart a scene, below each other. */
std::string broadphase_chart(const std::vector<BroadphaseScene> &scenes, const std::string &backend);

} // namespace tandem
