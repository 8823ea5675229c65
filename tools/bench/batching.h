/* batching.h - `tandem bench batching`: every batcher on the same contacts, beside the batch tables of the talks. */
#pragma once

#include <string>
#include <vector>

#include "tools/bench/options.h"
#include "tools/command/measure.h"
#include "tools/command/output.h"

namespace tandem {

struct BatchTable {
  std::string batcher;
  std::vector<uint32_t> sizes; /* of the non-empty batches, in order; without the overflow constraints */
  uint32_t overflow = 0;
  uint32_t rounds = 0;
  Spread milliseconds; /* from the list of contacts to a colour for each; without the sort by colour */
  bool right = false;  /* the check found no conflict and no pair in a wrong number of batches */
};

struct BatchScene {
  std::string scene;
  uint64_t steps = 0; /* simulated before the contacts were taken */
  uint32_t bodies = 0, pairs = 0, constraints = 0;
  /* The most contacts of one moving body, and the longest chain of contacts, each of which shares a moving body with a
   * later one, in the order of the run's colours: no schedule that keeps the bits takes fewer phases. */
  uint32_t most_of_body = 0, longest_chain = 0;
  std::vector<uint32_t> talk; /* the talk's sizes; empty if it has none */
  std::vector<BatchTable> tables;
};

/* Scenes with parameters and the steps before their contacts are taken; or a cube of about `boxes` boxes, if that is
 * not 0; or else the scenes of the talk. */
struct BatchingRequest {
  std::string backend;
  bool allow_inexact = false;
  std::vector<std::string> scenes;
  uint64_t steps = 200, boxes = 0;
};
std::vector<BatchScene> bench_batching(const BatchingRequest &request);

std::string batch_text(const BatchScene &scene);
Json batch_json(const BatchScene &scene);

/* Runs every batcher on one list of contacts; the exit status is 1 if the check finds a wrong batch. */
int execute_batching(const BenchOptions &options);

} // namespace tandem
