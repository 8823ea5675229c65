/* broadphase_frames.cpp - allocates the buffers of one broadphase and runs its frames; see broadphase_frames.h. */
#include "tools/bench/broadphase_frames.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include <fmt/format.h>

#include "host/pipeline/layout.h"
#include "host/pipeline/scene_counts.h"
#include "host/runtime/interface/floating_point.h"
#include "host/runtime/recorder.h"
#include "host/scene/body_buffers.h"
#include "host/scene/buffer_measures.h"
#include "host/scene/parameters.h"

namespace tandem {
namespace {

constexpr int most_repetitions = 8; /* one is enough, because the count includes pairs that did not fit */

void prepare(StepLaunches &step)
{
  step.run(Kernel::begin_step);
  step.run(Kernel::compute_bounds);
}

} // namespace

BroadphaseFrames::BroadphaseFrames(const MovingBodies &bodies, const BroadphaseRow &broadphase, Backend &backend,
                                   uint32_t pairs)
    : bodies_(bodies), broadphase_(broadphase), backend_(backend)
{
  const minicl::ExactFloatingPoint environment;
  settings_.broadphase = broadphase.choice;
  plan_.features = bodies.special.features;
  plan_.bodies = static_cast<uint32_t>(bodies.scene.bodies.size());
  plan_.capacity_cells = cells_for(plan_.bodies);
  plan_.capacity_pairs = pairs ? pairs : 5 * plan_.bodies + 1024;
  plan_.capacity_candidates = plan_.capacity_pairs;
  record_kernels();
  allocate();
  upload();
  guess_counts();
}

void BroadphaseFrames::record_kernels()
{
  Recorder recorder;
  StepLaunches step(recorder, plan_, settings_);
  prepare(step);
  broadphase_.launch(step);
  kernels_ = recorder.kernels;
  touched_ = recorder.touched;
  backend_.prepare(plan_.features, kernels_);
}

/* As in a world, what a broadphase keeps from frame to frame is lost. */
void BroadphaseFrames::allocate()
{
  const Sizes sizes{.bodies = plan_.bodies,
                    .materials = 1,
                    .hulls = {},
                    .trees = {},
                    .pairs = plan_.capacity_pairs,
                    .cells = plan_.capacity_cells,
                    .candidates = plan_.capacity_candidates,
                    .features = plan_.features};
  for (size_t k = 0; k < buffer_count; ++k)
    if (touched_[k]) memory_.resize(buffer_at(k), bytes_of(buffer_at(k), sizes));
}

void BroadphaseFrames::upload()
{
  StagedUploads uploads;
  stage_bodies(uploads, bodies_.scene, bodies_.special.order);
  stage_shapes(uploads, bodies_.scene, bodies_.special.order, plan_.bodies);
  uploads.write(memory_);
  const Parameters parameters = parameters_of(bodies_.scene, settings_, plan_.features, bodies_.special.median);
  memory_.upload(Buffer::parameters, &parameters, sizeof parameters);
  std::vector<uint32_t> counts(COUNT_TOTAL);
  for (const auto &[entry, value] : entries_of({plan_.bodies, bodies_.special.unbounded, bodies_.special.large}))
    counts[entry] = value;
  counts[CAPACITY_PAIRS] = plan_.capacity_pairs;
  counts[CAPACITY_CELLS] = plan_.capacity_cells;
  counts[CAPACITY_CANDIDATES] = plan_.capacity_candidates;
  memory_.upload(Buffer::counts, counts.data(), counts.size() * sizeof(uint32_t));
}

/* As in a world before its first step, and after its buffers have grown. */
void BroadphaseFrames::guess_counts()
{
  plan_.known.fill(plan_.capacity_pairs);
  for (const auto &[entry, value] : entries_of({plan_.bodies, bodies_.special.unbounded, bodies_.special.large}))
    plan_.known[entry] = value;
  plan_.known[COUNT_CELLS_PLUS_ONE] = plan_.capacity_cells + 1;
}

double BroadphaseFrames::run(uint32_t frame)
{
  move_bodies(frame);
  for (int repetition = 0; repetition < most_repetitions; ++repetition) {
    const double milliseconds = find_pairs();
    const uint32_t pairs = plan_.known[COUNT_PAIRS_NEEDED], candidates = plan_.known[COUNT_CANDIDATES_NEEDED];
    if (pairs <= plan_.capacity_pairs && candidates <= plan_.capacity_candidates) return milliseconds;
    grow(pairs, candidates);
  }
  throw std::runtime_error(
      fmt::format("{}: frame {} found more pairs each time that it ran again", broadphase_.name, frame));
}

void BroadphaseFrames::move_bodies(uint32_t frame)
{
  const std::vector<float4> places = bodies_.places_at(frame);
  memory_.upload(Buffer::body_position, places.data(), places.size() * sizeof(float4));
}

double BroadphaseFrames::find_pairs()
{
  using Clock = std::chrono::steady_clock;
  prepare(step_);
  backend_.finish();
  const Clock::time_point start = Clock::now();
  broadphase_.launch(step_);
  backend_.finish();
  const double milliseconds = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  memory_.download(Buffer::counts, plan_.known.data(), sizeof plan_.known);
  return milliseconds;
}

void BroadphaseFrames::grow(uint32_t pairs, uint32_t candidates)
{
  plan_.capacity_pairs = std::max(plan_.capacity_pairs, pairs + pairs / 8);
  plan_.capacity_candidates = std::max(plan_.capacity_candidates, candidates + candidates / 8);
  record_kernels(); /* longer scans and sorts need other kernels */
  allocate();
  set_count(memory_, CAPACITY_PAIRS, plan_.capacity_pairs);
  set_count(memory_, CAPACITY_CANDIDATES, plan_.capacity_candidates);
  forget_kept(memory_);
  guess_counts();
}

uint64_t BroadphaseFrames::hash()
{
  const uint64_t list = hash_buffers(memory_, {Buffer::pair_a, Buffer::pair_b}, pairs(), pairs());
  return hash_buffers(memory_, {Buffer::pair_start}, size_t{plan_.bodies} + 1, list);
}

} // namespace tandem
