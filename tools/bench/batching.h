/* batching.h - `tandem bench batching`: every batcher on the same contacts, beside the batch tables of the talks. */
#pragma once

#include <string>
#include <vector>

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
  std::vector<uint32_t> talk; /* the talk's sizes; empty if it has none */
  std::vector<BatchTable> tables;
};

/* The scenes of the talk, or a cube of about `boxes` boxes if that is not 0. */
std::vector<BatchScene> bench_batching(const std::string &backend, uint64_t boxes, bool allow_inexact);

std::string batch_text(const BatchScene &scene);
Json batch_json(const BatchScene &scene);

} // namespace tandem
