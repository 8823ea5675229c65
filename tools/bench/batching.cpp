/* batching.cpp - see batching.h.
 *
 * One world provides the list of contacts; each batcher then batches that list repeatedly, starting without colours.
 * `coloring` is measured a second time with the colours of the last step, as in a run.
 */
#include "tools/bench/batching.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "host/catalog/catalog.h"
#include "host/pipeline/batching/batcher.h"
#include "host/pipeline/layout.h"
#include "host/runtime/interface/kernel_list.h"
#include "tools/command/progress.h"
#include "tools/command/scene_options.h"

namespace tandem {
namespace {

constexpr int batching_repetitions = 9;

/* Sizes of batches on the CPU in the 2009 talk. */
const std::vector<uint32_t> talk_2d = {4931, 4836, 4711, 4502, 4197, 3702, 2702, 1375, 470, 138, 31, 7};
const std::vector<uint32_t> talk_3d = {1064, 909, 767, 579, 392, 208, 87, 26, 5, 1, 1, 1};

/* Batches the contacts of a world repeatedly, by launching kernels directly. */
class BatchingBench {
public:
  BatchingBench(World &world, Backend &backend) : world_(world), backend_(backend), launcher_(world.memory(), backend)
  {
    Memory &memory = world.memory();
    memory.download(Buffer::counts, counts_.data(), sizeof counts_);
    plan_.features = world.features();
    plan_.bodies = counts_[COUNT_BODIES];
    plan_.capacity_pairs = counts_[CAPACITY_PAIRS];
    plan_.rounds = 256;
    const Sizes sizes{.bodies = plan_.bodies,
                      .materials = 1,
                      .hulls = {},
                      .trees = {},
                      .pairs = plan_.capacity_pairs,
                      .cells = counts_[CAPACITY_CELLS],
                      .features = plan_.features};
    for (Buffer buffer : {Buffer::body_cells, Buffer::body_marks, Buffer::pair_marks})
      memory.resize(buffer, bytes_of(buffer, sizes));
    prepare_kernels();
  }

  BatchTable run(const BatcherRow &batcher, bool keep)
  {
    std::vector<double> times;
    for (int k = 0; k < batching_repetitions; ++k) times.push_back(batch(batcher, keep));
    BatchTable table = check();
    table.batcher = std::string(batcher.name) + (batcher.keeps_colors ? keep ? ", kept" : ", afresh" : "");
    table.milliseconds = spread_of(times);
    return table;
  }

private:
  void prepare_kernels()
  {
    std::vector<Kernel> kernels;
    for (size_t k = 0; k < kernel_count; ++k)
      if (const Stage stage = row_of(kernel_at(k)).stage; stage == Stage::batching || stage == Stage::parallel)
        kernels.push_back(kernel_at(k));
    kernels.push_back(Kernel::prepare_bodies);
    backend_.prepare(plan_.features, kernels);
  }

  void begin(bool keep)
  {
    for (int entry : {COUNT_UNCOLORED, COUNT_ROUNDS, COUNT_COLORS, COUNT_CONFLICTS, COUNT_MISBATCHED})
      counts_[entry] = 0;
    counts_[COUNT_FIRST_CONFLICT] = counts_[COUNT_FIRST_MISBATCHED] = INDEX_NONE;
    world_.memory().upload(Buffer::counts, counts_.data(), sizeof counts_);
    plan_.known = counts_;
    step_.run(Kernel::prepare_bodies);
    step_.run(Kernel::match_pairs, {keep ? 1u : 0u});
    backend_.finish();
  }

  /* Launches the rounds of the last time, as in a run that has settled. A run with too few rounds is not timed. */
  double batch(const BatcherRow &batcher, bool keep)
  {
    using Clock = std::chrono::steady_clock;
    for (;;) {
      begin(keep);
      const Clock::time_point start = Clock::now();
      batcher.launch(step_);
      backend_.finish();
      const double milliseconds = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
      const auto after = world_.memory().read<uint32_t>(Buffer::counts, COUNT_TOTAL);
      const bool whole = after[COUNT_UNCOLORED] == 0, wasteful = plan_.rounds > std::max(after[COUNT_ROUNDS] + 3, 4u);
      plan_.rounds = whole ? std::max(after[COUNT_ROUNDS] + 3, 4u) : 2 * plan_.rounds;
      if (whole && !wasteful) return milliseconds;
    }
  }

  BatchTable check()
  {
    step_.run(Kernel::color_keys);
    step_.sort(Buffer::sort_key, Buffer::sort_value, COUNT_PAIRS, plan_.capacity_pairs, 0, 8);
    step_.run(Kernel::color_starts);
    launch_check(step_);
    const auto after = world_.memory().read<uint32_t>(Buffer::counts, COUNT_TOTAL);
    BatchTable table;
    for (uint32_t color = 0; color < COLOR_LIMIT; ++color)
      if (const uint32_t size = after[COLOR_START + color + 1] - after[COLOR_START + color])
        table.sizes.push_back(size);
    table.overflow = after[COLOR_START + COLOR_LIMIT + 1] - after[COLOR_START + COLOR_LIMIT];
    table.rounds = after[COUNT_ROUNDS];
    table.right = after[COUNT_CONFLICTS] == 0 && after[COUNT_MISBATCHED] == 0;
    return table;
  }

  World &world_;
  Backend &backend_;
  DirectLauncher launcher_;
  StepPlan plan_;
  Settings settings_;
  StepLaunches step_{launcher_, plan_, settings_};
  std::array<uint32_t, COUNT_TOTAL> counts_{};
};

/* A body that cannot move joins no contacts, and no solver writes it. */
void measure_chains(World &world, BatchScene &scene)
{
  const auto a = world.memory().read<uint32_t>(Buffer::constraint_a, scene.constraints),
             b = world.memory().read<uint32_t>(Buffer::constraint_b, scene.constraints);
  const auto moves = [&](uint32_t body) {
    return world.scene().bodies[world.scene_body(body)].type == BodyType::dynamic;
  };
  std::vector<uint32_t> contacts(scene.bodies), chains(scene.bodies);
  for (uint32_t i = 0; i < scene.constraints; ++i) {
    uint32_t chain = 0;
    for (const uint32_t body : {a[i], b[i]})
      if (moves(body)) chain = std::max(chain, chains[body]), ++contacts[body];
    for (const uint32_t body : {a[i], b[i]})
      if (moves(body)) chains[body] = chain + 1;
    scene.longest_chain = std::max(scene.longest_chain, chain + 1);
  }
  if (scene.bodies > 0) scene.most_of_body = *std::max_element(contacts.begin(), contacts.end());
}

/* Steps until so many pairs touch. */
BatchScene batch_scene(const std::string &text, const BatchingRequest &request, uint64_t most_steps, uint32_t wanted)
{
  World world(load_scene(text), Settings{}, Placement{request.backend, {}, request.allow_inexact});
  world.set_observer([](const Launch &) {}); /* what the kernels read is kept for them to run again */
  BatchScene result;
  result.scene = text;
  Progress progress("simulating " + text, most_steps);
  std::vector<uint32_t> counts;
  do {
    world.step();
    counts = world.memory().read<uint32_t>(Buffer::counts, COUNT_TOTAL);
    progress.update(++result.steps);
  } while (result.steps < most_steps && counts[COUNT_CONSTRAINTS] < wanted);
  progress.clear();
  result.bodies = counts[COUNT_BODIES];
  result.pairs = counts[COUNT_PAIRS];
  result.constraints = counts[COUNT_CONSTRAINTS];
  measure_chains(world, result);
  BatchingBench bench(world, world.backend_of(Kernel::match_pairs));
  for (const BatcherRow &batcher : batchers()) {
    result.tables.push_back(bench.run(batcher, false));
    if (batcher.keeps_colors) result.tables.push_back(bench.run(batcher, true));
  }
  return result;
}

uint32_t sum_of(const std::vector<uint32_t> &sizes) { return std::accumulate(sizes.begin(), sizes.end(), 0u); }

/* Lists batches side by side, one row for each batch, so that they can be compared with the talk's. */
std::string size_table(const BatchScene &scene)
{
  std::vector<std::string> header{"batch"};
  size_t rows = scene.talk.size();
  if (!scene.talk.empty()) header.push_back("the talk");
  for (const BatchTable &table : scene.tables) {
    header.push_back(table.batcher);
    rows = std::max(rows, table.sizes.size());
  }
  Table text(header);
  const auto cell = [](const std::vector<uint32_t> &sizes, size_t k) {
    return k < sizes.size() ? fmt::format("{}", sizes[k]) : "";
  };
  for (size_t k = 0; k < rows; ++k) {
    std::vector<std::string> row{fmt::format("{}", k)};
    if (!scene.talk.empty()) row.push_back(cell(scene.talk, k));
    for (const BatchTable &table : scene.tables) row.push_back(cell(table.sizes, k));
    text.add(row);
  }
  std::vector<std::string> sum{"sum"};
  if (!scene.talk.empty()) sum.push_back(fmt::format("{}", sum_of(scene.talk)));
  for (const BatchTable &table : scene.tables) sum.push_back(fmt::format("{}", sum_of(table.sizes)));
  text.add(sum);
  return text.text("  ");
}

double fill_of(const BatchTable &table)
{
  if (table.sizes.empty()) return 1;
  const double largest = *std::max_element(table.sizes.begin(), table.sizes.end());
  return sum_of(table.sizes) / (largest * static_cast<double>(table.sizes.size()));
}

} // namespace

std::vector<BatchScene> bench_batching(const BatchingRequest &request)
{
  std::vector<BatchScene> scenes;
  for (const std::string &scene : request.scenes)
    scenes.push_back(batch_scene(scene, request, request.steps, UINT32_MAX));
  if (request.boxes) {
    const auto side = static_cast<uint64_t>(std::max(1.0, std::round(std::cbrt(static_cast<double>(request.boxes)))));
    scenes.push_back(batch_scene(fmt::format("box-grid:nx={0},ny={0},nz={0}", side), request, 60, UINT32_MAX));
  }
  if (!scenes.empty()) return scenes;
  scenes.push_back(batch_scene("pyramid-2d", request, 1, 0));
  scenes.back().talk = talk_2d;
  scenes.push_back(batch_scene("talk-3d", request, 1000, sum_of(talk_3d)));
  scenes.back().talk = talk_3d;
  return scenes;
}

std::string batch_text(const BatchScene &scene)
{
  std::string text = fmt::format("{} after {} steps: {} bodies, {} pairs of bounds, {} contacts, at most {} of one "
                                 "body, the longest chain {}\n{}",
                                 scene.scene, scene.steps, scene.bodies, scene.pairs, scene.constraints,
                                 scene.most_of_body, scene.longest_chain, size_table(scene));
  Table table({"batcher", "batches", "tail", "fill", "rounds", "ms", "least", "most", "check"});
  for (const BatchTable &t : scene.tables)
    table.add({t.batcher, fmt::format("{}", t.sizes.size()), fmt::format("{}", t.overflow),
               fmt::format("{:.0f}%", 100 * fill_of(t)), fmt::format("{}", t.rounds),
               fmt::format("{:.3f}", t.milliseconds.median), fmt::format("{:.3f}", t.milliseconds.minimum),
               fmt::format("{:.3f}", t.milliseconds.maximum), t.right ? "right" : "WRONG"});
  return text + "\n" + table.text("  ");
}

Json batch_json(const BatchScene &scene)
{
  Json json = {{"scene", scene.scene},
               {"steps", scene.steps},
               {"bodies", scene.bodies},
               {"pairs", scene.pairs},
               {"contacts", scene.constraints},
               {"talk", scene.talk},
               {"most_of_body", scene.most_of_body},
               {"longest_chain", scene.longest_chain},
               {"batchers", Json::array()}};
  for (const BatchTable &t : scene.tables)
    json["batchers"].push_back(
        {{"name", t.batcher},
         {"batches", t.sizes.size()},
         {"sizes", t.sizes},
         {"tail", t.overflow},
         {"fill", fill_of(t)},
         {"rounds", t.rounds},
         {"ms", {{"median", t.milliseconds.median}, {"min", t.milliseconds.minimum}, {"max", t.milliseconds.maximum}}},
         {"right", t.right}});
  return json;
}

int execute_batching(const BenchOptions &options)
{
  BatchingRequest request{options.on, options.inexact, {}};
  if (!options.scenes.empty()) request.scenes = scenes_of_parts(options.scenes);
  if (!options.count.empty()) request.boxes = whole_number("--n", options.count, 1, most_bodies);
  if (!options.steps.empty()) request.steps = whole_number("--steps", options.steps, 1, 100000);
  if (!options.steps.empty() && options.scenes.empty())
    throw InputError(
        "--steps: bench batching takes it with --scene alone, whose contacts are those after so many steps");
  options.json.check();
  const std::vector<BatchScene> scenes = bench_batching(request);
  Json json = {{"what", options.what}, {"backend", options.on}, {"scenes", Json::array()}};
  bool right = true;
  for (const BatchScene &scene : scenes) {
    if (!options.json.takes_standard_output())
      fmt::print("{}on {}: {}", &scene == &scenes.front() ? "" : "\n", options.on, batch_text(scene));
    json["scenes"].push_back(batch_json(scene));
    for (const BatchTable &table : scene.tables) right = right && table.right;
  }
  options.json.write(json);
  return right ? 0 : 1;
}

} // namespace tandem
