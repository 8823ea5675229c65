/* controls_error.cpp - see controls_error.h. */
#include "tools/bench/controls_error.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <tandem/worlds.h>

#include "host/base/random.h"
#include "tools/command/progress.h"

namespace tandem {
namespace {

constexpr double interval_of_controls = 0.05; /* s */
constexpr uint32_t compared_intervals[] = {2, 4, 8, 20};
constexpr uint32_t intervals_of_run = 20;
constexpr uint32_t refinements[] = {1, 2, 16, 32}; /* of the step; the last run has converged */

/* The centres of mass of the bodies that are compared, in m: [time][world * bodies + body]. */
using Centers = std::vector<std::vector<Point>>;

std::vector<uint32_t> compared_bodies(const Scene &scene)
{
  std::vector<uint32_t> bodies;
  for (uint32_t body = 0; body < scene.bodies.size(); ++body) {
    const Body &one = scene.bodies[body];
    const bool collides = one.filter_group != 0 || one.filter_mask != 0;
    if (one.type == BodyType::dynamic && collides) bodies.push_back(body);
  }
  if (bodies.empty())
    throw InputError(fmt::format("{}: no body that moves collides; --error has none to compare", scene.name));
  return bodies;
}

/* Gives every world the same controls in each run, whatever its step is. */
class RefinedRuns {
public:
  RefinedRuns(const Scene &scene, std::span<const Actuator> actuators, uint32_t worlds, const Settings &settings,
              const Placement &placement)
      : scene_(scene), actuators_(actuators), worlds_(worlds), settings_(settings), placement_(placement),
        bodies_(compared_bodies(scene)),
        steps_of_interval_(static_cast<uint64_t>(std::lround(interval_of_controls / double{settings.step}))),
        progress_(fmt::format("error of {} worlds", worlds), total_steps())
  {}

  Centers run(uint32_t refinement)
  {
    Settings settings = settings_;
    settings.step /= static_cast<float>(refinement);
    Worlds worlds(scene_, worlds_, settings, placement_);
    worlds.choose_controls(actuators_);
    Random random(1);
    Centers centers;
    for (uint32_t interval = 1; interval <= intervals_of_run; ++interval) {
      worlds.set_controls(drawn_controls(random));
      advance(worlds, steps_of_interval_ * refinement);
      const bool is_compared = std::find(std::begin(compared_intervals), std::end(compared_intervals), interval) !=
                               std::end(compared_intervals);
      if (is_compared) centers.push_back(centers_of(worlds));
    }
    check_finite(worlds);
    return centers;
  }
  size_t bodies() const { return bodies_.size(); }

private:
  uint64_t total_steps() const
  {
    uint64_t steps = 0;
    for (const uint32_t refinement : refinements) steps += intervals_of_run * steps_of_interval_ * refinement;
    return steps;
  }
  std::vector<float> drawn_controls(Random &random) const
  {
    std::vector<float> values;
    for (uint32_t world = 0; world < worlds_; ++world)
      for (const Actuator &actuator : actuators_)
        values.push_back(static_cast<float>(random.uniform(double{actuator.lower}, double{actuator.upper})));
    return values;
  }
  void advance(Worlds &worlds, uint64_t steps)
  {
    for (uint64_t step = 0; step < steps; ++step) {
      worlds.step();
      progress_.update(++done_);
    }
  }
  std::vector<Point> centers_of(Worlds &worlds) const
  {
    const std::vector<BodyState> states = worlds.bodies();
    std::vector<Point> centers;
    for (uint32_t world = 0; world < worlds_; ++world)
      for (const uint32_t body : bodies_)
        centers.push_back(states[size_t{world} * worlds.bodies_of_world() + body].position);
    return centers;
  }
  /* Bodies in quarantine stand still, which would count as a small error. */
  static void check_finite(Worlds &worlds)
  {
    const uint32_t bodies = worlds.statistics().nonfinite;
    if (bodies > 0)
      throw std::runtime_error(fmt::format("--error: {} bodies ceased to be finite with a step of {:g} ms", bodies,
                                           1e3 * worlds.settings().step));
  }

  const Scene &scene_;
  const std::span<const Actuator> actuators_;
  const uint32_t worlds_;
  const Settings settings_;
  const Placement placement_;
  const std::vector<uint32_t> bodies_;
  const uint64_t steps_of_interval_;
  uint64_t done_ = 0;
  Progress progress_;
};

/* In m, over the bodies of one world. */
double root_mean_square_distance(std::span<const Point> one, std::span<const Point> other)
{
  double sum = 0;
  for (size_t body = 0; body < one.size(); ++body)
    for (size_t k = 0; k < 3; ++k) {
      const double apart = one[body][k] - other[body][k];
      sum += apart * apart;
    }
  return std::sqrt(sum / static_cast<double>(one.size()));
}

/* The smallest of the sorted values that this share of them does not exceed. */
double percentile_of(const std::vector<double> &sorted, double share)
{
  const double rank = std::ceil(share * static_cast<double>(sorted.size()) - 1e-9);
  return sorted[static_cast<size_t>(std::max(rank, 1.0)) - 1];
}

DistanceOfWorlds distance_of_worlds(std::span<const Point> one, std::span<const Point> other, size_t bodies)
{
  std::vector<double> distances;
  for (size_t first = 0; first < one.size(); first += bodies)
    distances.push_back(1e3 * root_mean_square_distance(one.subspan(first, bodies), other.subspan(first, bodies)));
  std::sort(distances.begin(), distances.end());
  return {percentile_of(distances, 0.5), percentile_of(distances, 0.9)};
}

std::vector<std::string> cells_of(const ErrorOfStep &step)
{
  std::vector<std::string> cells = {fmt::format("{:g}", 1e3 * step.step)};
  for (const DistanceOfWorlds &distance : step.distances)
    cells.push_back(fmt::format("{:.3f} ({:.3f})", distance.median, distance.ninetieth));
  return cells;
}

Json json_of_distances(const ErrorOfStep &step, const std::vector<double> &times)
{
  Json list = Json::array();
  for (size_t k = 0; k < times.size(); ++k)
    list.push_back(
        {{"seconds", times[k]}, {"median", step.distances[k].median}, {"ninetieth", step.distances[k].ninetieth}});
  return list;
}

} // namespace

void check_comparable(const Scene &scene) { compared_bodies(scene); }

ControlsError controls_error(const Scene &scene, std::span<const Actuator> actuators, uint32_t worlds,
                             const Settings &settings, const Placement &placement)
{
  RefinedRuns runs(scene, actuators, worlds, settings, placement);
  ControlsError error;
  error.worlds = worlds;
  error.bodies = runs.bodies();
  for (const uint32_t interval : compared_intervals) error.times.push_back(interval_of_controls * interval);
  std::vector<Centers> centers;
  for (const uint32_t refinement : refinements) centers.push_back(runs.run(refinement));
  for (size_t run = 0; run + 1 < centers.size(); ++run) {
    ErrorOfStep &step = error.steps.emplace_back();
    step.step = double{settings.step} / refinements[run];
    for (size_t k = 0; k < error.times.size(); ++k)
      step.distances.push_back(distance_of_worlds(centers[run][k], centers.back()[k], error.bodies));
  }
  error.converged_step = double{settings.step} / *std::rbegin(refinements);
  return error;
}

std::string text_of(const ControlsError &error)
{
  std::vector<std::string> header = {"step, ms"};
  for (const double time : error.times) header.push_back(fmt::format("after {:g} s", time));
  Table table(header);
  for (const ErrorOfStep &step : error.steps) table.add(cells_of(step));
  return fmt::format(
      "  distance from a run with a step of {:g} ms, in mm: the root mean square over the {} bodies of a "
      "world that collide;\n"
      "  median of {} worlds (90th percentile), with controls held for {:g} ms\n{}"
      "  The last step is the floor: it tells how far the run compared with has converged. Falling "
      "robots are chaotic,\n"
      "  so late distances tell that runs part by themselves; only the early ones tell the error of the "
      "step.\n",
      1e3 * error.converged_step, error.bodies, error.worlds, 1e3 * interval_of_controls, table.text("    "));
}

Json json_of(const ControlsError &error)
{
  Json steps = Json::array();
  for (const ErrorOfStep &step : error.steps)
    steps.push_back({{"step_ms", 1e3 * step.step}, {"distance_mm", json_of_distances(step, error.times)}});
  return {{"worlds", error.worlds},
          {"bodies", error.bodies},
          {"controls_held_ms", 1e3 * interval_of_controls},
          {"converged_step_ms", 1e3 * error.converged_step},
          {"steps", steps}};
}

} // namespace tandem
