/* bullet_bench.cpp - compares Bullet's broadphase (btDbvtBroadphase: two dynamic AABB trees, updated incrementally, on
 * one thread) with Tandem's.
 *
 *    frame:   Tandem 1 -> Tandem 2 -> ... -> bounds -> Bullet       in turn, so that a busy machine slows all alike
 *
 * Bullet receives the same bounds as Tandem: setAabb for every body that moves, then calculateOverlappingPairs. Its
 * result differs in one respect: it enlarges the boxes in its trees, so that a body need not be reinserted every frame,
 * and removes pairs of boxes that have separated only gradually. Its pairs are therefore a superset of Tandem's, which
 * the program checks. Its work also comes in bursts, when bodies reach the edge of their enlarged boxes, so the mean is
 * as important as the median, and many frames are needed.
 */
#include <chrono>
#include <memory>
#include <numeric>

#include <CLI/CLI.hpp>
#include <btBulletCollisionCommon.h>
#include <fmt/format.h>

#include "host/catalog/catalog.h"
#include "host/runtime/make_backend.h"
#include "tools/bench/broadphase_frames.h"
#include "tools/command/measure.h"
#include "tools/command/output.h"
#include "tools/command/progress.h"
#include "tools/command/scene_options.h"

namespace tandem {
namespace {

constexpr uint32_t warm_frames = 2;

struct Options {
  std::string on = "tbb:threads=2", bodies = "100000", frames = "60";
  std::vector<std::string> broadphases = {"grid", "trees"};
};

/* A request whose values have been checked. */
struct Request {
  uint32_t bodies, frames;
  std::vector<std::string> broadphases;
};

struct BodyBounds {
  float4 lower, upper;
};

btVector3 vector_of(const float4 &r) { return {r.x, r.y, r.z}; }

class BulletFrames {
public:
  BulletFrames(const MovingBodies &moving, const std::vector<BodyBounds> &bounds)
  {
    for (size_t k = 0; k < bounds.size(); ++k) {
      const Body &body = moving.scene.bodies[moving.special.order[k]];
      const bool fixed = body.type == BodyType::fixed;
      const int group = fixed ? btBroadphaseProxy::StaticFilter : btBroadphaseProxy::DefaultFilter;
      const int mask =
          fixed ? btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter : btBroadphaseProxy::AllFilter;
      proxies_.push_back(broadphase_.createProxy(vector_of(bounds[k].lower), vector_of(bounds[k].upper),
                                                 BOX_SHAPE_PROXYTYPE, number(k), group, mask, nullptr));
      if (!fixed) moving_.push_back(k);
    }
  }
  ~BulletFrames()
  {
    for (btBroadphaseProxy *proxy : proxies_) broadphase_.destroyProxy(proxy, nullptr);
  }

  double run(const std::vector<BodyBounds> &bounds)
  {
    const auto start = std::chrono::steady_clock::now();
    for (size_t k : moving_)
      broadphase_.setAabb(proxies_[k], vector_of(bounds[k].lower), vector_of(bounds[k].upper), nullptr);
    broadphase_.calculateOverlappingPairs(nullptr);
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }

  int pairs() { return broadphase_.getOverlappingPairCache()->getNumOverlappingPairs(); }
  bool has_pair(uint32_t a, uint32_t b)
  {
    return broadphase_.getOverlappingPairCache()->findPair(proxies_[a], proxies_[b]) != nullptr;
  }

private:
  /* Bullet ignores proxies without a client object, and uses the object for nothing else. */
  static void *number(size_t k) { return reinterpret_cast<void *>(k + 1); }

  btDbvtBroadphase broadphase_;
  std::vector<btBroadphaseProxy *> proxies_;
  std::vector<size_t> moving_;
};

struct Row {
  std::string name;
  std::vector<double> milliseconds;
  uint32_t pairs = 0;
};

/* The number of Tandem's pairs that Bullet has not found. */
uint32_t missing_pairs(BroadphaseFrames &frames, BulletFrames &bullet)
{
  const auto a = frames.memory().read<uint32_t>(Buffer::pair_a, frames.pairs()),
             b = frames.memory().read<uint32_t>(Buffer::pair_b, frames.pairs());
  uint32_t missing = 0;
  for (size_t k = 0; k < a.size(); ++k) missing += !bullet.has_pair(a[k], b[k]);
  return missing;
}

/* Measures Tandem's broadphases, then Bullet's; returns false if Bullet misses a pair. */
bool measure_input(const BroadphaseInput &input, const Request &request, Backend &backend, std::vector<Row> &rows)
{
  const MovingBodies moving(input, request.bodies);
  std::vector<std::unique_ptr<BroadphaseFrames>> ours;
  for (const std::string &name : request.broadphases)
    ours.push_back(std::make_unique<BroadphaseFrames>(moving, row_of(parse_setting<Broadphase>(name)), backend));
  std::unique_ptr<BulletFrames> bullet;
  uint32_t missing = 0;
  Progress progress(fmt::format("{}, {} bodies", input.name, request.bodies), warm_frames + request.frames);
  for (uint32_t frame = 0; frame < warm_frames + request.frames; ++frame) {
    std::vector<double> times;
    for (const auto &frames : ours) times.push_back(frames->run(frame));
    const auto bounds = ours.front()->memory().read<BodyBounds>(Buffer::bounds, request.bodies);
    if (!bullet) bullet = std::make_unique<BulletFrames>(moving, bounds);
    times.push_back(bullet->run(bounds));
    missing += missing_pairs(*ours.front(), *bullet);
    for (size_t k = 0; k < rows.size() && frame >= warm_frames; ++k) rows[k].milliseconds.push_back(times[k]);
    progress.update(frame + 1);
  }
  for (size_t k = 0; k < ours.size(); ++k) rows[k].pairs = ours[k]->pairs();
  rows.back().pairs = static_cast<uint32_t>(bullet->pairs());
  return missing == 0;
}

double mean_of(const std::vector<double> &values)
{
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

void print_rows(const std::vector<Row> &rows)
{
  const double median = spread_of(rows.back().milliseconds).median, mean = mean_of(rows.back().milliseconds);
  Table table({"broadphase", "median", "mean", "least", "most", "pairs", "Bullet's median / this", "mean / this"});
  const auto number = [](double value) { return fmt::format("{:.3f}", value); };
  for (const Row &row : rows) {
    const Spread time = spread_of(row.milliseconds);
    const double own_mean = mean_of(row.milliseconds);
    table.add({row.name, number(time.median), number(own_mean), number(time.minimum), number(time.maximum),
               fmt::format("{}", row.pairs), fmt::format("{:.2f}", median / time.median),
               fmt::format("{:.2f}", mean / own_mean)});
  }
  fmt::print("{}", table.text("  "));
}

int compare(const std::string &on, const Request &request)
{
  const std::unique_ptr<Backend> backend = make_backend(on);
  int status = 0;
  for (const char *name : {"pile", "spheres"}) {
    std::vector<Row> rows;
    for (const std::string &broadphase : request.broadphases) rows.push_back({broadphase, {}, 0});
    rows.push_back({"Bullet", {}, 0});
    const bool complete = measure_input(broadphase_input_named(name), request, *backend, rows);
    fmt::print("{}, {} bodies, ours on {}: ms a frame, of {} frames\n", name, request.bodies, on, request.frames);
    print_rows(rows);
    if (!complete) fmt::print(stderr, "tandem_bullet_bench: {}: Bullet misses pairs of ours\n", name);
    status |= !complete;
  }
  return status;
}

int parse_and_compare(int count, char **arguments)
{
  CLI::App parser("Bullet's broadphase beside ours, on the same moving bodies.", "tandem_bullet_bench");
  Options options;
  parser.add_option("--on", options.on, "backend of ours")->type_name("B")->capture_default_str();
  parser.add_option("--n", options.bodies, "bodies")->type_name("N")->capture_default_str();
  parser.add_option("--frames", options.frames, "timed frames, a sixtieth of a second each")
      ->type_name("N")
      ->capture_default_str();
  parser.add_option("--broadphase", options.broadphases, "which of ours")
      ->delimiter(',')
      ->check(CLI::IsMember(choice_names<Broadphase>()))
      ->type_name("NAME,...")
      ->capture_default_str();
  try {
    parser.parse(count, arguments);
  } catch (const CLI::Success &asked) { /* --help */
    return parser.exit(asked);
  } catch (const CLI::ParseError &error) {
    throw InputError(error.what());
  }
  const auto bodies = static_cast<uint32_t>(whole_number("--n", options.bodies, 2, most_bodies));
  return compare(options.on, {bodies, static_cast<uint32_t>(whole_number("--frames", options.frames, 1, 100000)),
                              options.broadphases});
}

} // namespace
} // namespace tandem

int main(int count, char **arguments)
{
  try {
    return tandem::parse_and_compare(count, arguments);
  } catch (const tandem::InputError &error) {
    fmt::print(stderr, "tandem_bullet_bench: {}\n", error.what());
    return 2;
  } catch (const std::exception &error) {
    fmt::print(stderr, "tandem_bullet_bench: {}\n", error.what());
    return 1;
  }
}
