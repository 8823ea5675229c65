/* controls_error.cpp - see controls_error.h. */
#include "tools/bench/controls_error.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tandem/worlds.h>

#include "host/base/random.h"
#include "host/scene/shape_bounds.h"
#include "tools/command/progress.h"

namespace tandem {
namespace {

constexpr double interval_of_controls = 0.05; /* s */
constexpr uint32_t compared_intervals[] = {2, 4, 8, 20};
constexpr uint32_t intervals_of_run = 20;
constexpr uint32_t refinements[] = {1, 2, 16, 32}; /* of the step; the last run has converged */

/* Of a run at one time. */
struct Moment {
  std::vector<Point> centers;  /* of mass of the bodies that are compared, in m: [world * bodies + body] */
  std::vector<bool> is_finite; /* by world: bodies in quarantine stand still, which would count as a small error */
};

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

/* The diagonal of a box around the bodies that are compared, with their shapes, in m. */
double size_of(const Scene &scene, std::span<const uint32_t> bodies)
{
  Point lower, upper;
  lower.fill(INFINITY), upper.fill(-INFINITY);
  for (const uint32_t body : bodies)
    for (size_t k = 0; k < 3; ++k) {
      const double radius = double{bounding_radius(scene, scene.bodies[body])};
      lower[k] = std::min(lower[k], scene.bodies[body].position[k] - radius);
      upper[k] = std::max(upper[k], scene.bodies[body].position[k] + radius);
    }
  return std::hypot(upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]);
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

  std::vector<Moment> run(uint32_t refinement)
  {
    Settings settings = settings_;
    settings.step /= static_cast<float>(refinement);
    Worlds worlds(scene_, worlds_, settings, placement_);
    worlds.choose_controls(actuators_);
    Random random(1);
    std::vector<Moment> moments;
    for (uint32_t interval = 1; interval <= intervals_of_run; ++interval) {
      worlds.set_controls(drawn_controls(random));
      advance(worlds, steps_of_interval_ * refinement);
      const bool is_compared = std::find(std::begin(compared_intervals), std::end(compared_intervals), interval) !=
                               std::end(compared_intervals);
      if (is_compared) moments.push_back(moment_of(worlds));
    }
    return moments;
  }
  size_t bodies() const { return bodies_.size(); }
  double size() const { return size_of(scene_, bodies_); }

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
  Moment moment_of(Worlds &worlds) const
  {
    const std::vector<BodyState> states = worlds.bodies();
    Moment moment;
    for (uint32_t world = 0; world < worlds_; ++world) {
      moment.is_finite.push_back(worlds.quarantined(world).empty());
      for (const uint32_t body : bodies_)
        moment.centers.push_back(states[size_t{world} * worlds.bodies_of_world() + body].position);
    }
    return moment;
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

DistanceOfWorlds distance_of_worlds(const Moment &one, const Moment &other, size_t bodies, double size)
{
  std::vector<double> distances;
  DistanceOfWorlds result{NAN, NAN, 0};
  for (size_t world = 0; world < one.is_finite.size(); ++world) {
    const auto centers_in = [&](const Moment &moment) {
      return std::span(moment.centers).subspan(world * bodies, bodies);
    };
    const double distance = root_mean_square_distance(centers_in(one), centers_in(other));
    if (one.is_finite[world] && other.is_finite[world] && distance <= size) distances.push_back(1e3 * distance);
    else ++result.left;
  }
  if (distances.empty()) return result;
  std::sort(distances.begin(), distances.end());
  result.median = percentile_of(distances, 0.5);
  result.ninetieth = percentile_of(distances, 0.9);
  return result;
}

std::string cell_of(const DistanceOfWorlds &distance)
{
  const std::string left = distance.left > 0 ? fmt::format("{} left", distance.left) : "";
  if (std::isnan(distance.median)) return left;
  const std::string rest = fmt::format("{:.3f} ({:.3f})", distance.median, distance.ninetieth);
  return left.empty() ? rest : fmt::format("{}, {}", rest, left);
}

std::vector<std::string> cells_of(const ErrorOfStep &step)
{
  std::vector<std::string> cells = {fmt::format("{:g}", 1e3 * step.step)};
  for (const DistanceOfWorlds &distance : step.distances) cells.push_back(cell_of(distance));
  return cells;
}

Json json_of_distances(const ErrorOfStep &step, const std::vector<double> &times)
{
  Json list = Json::array();
  for (size_t k = 0; k < times.size(); ++k) {
    const auto &[median, ninetieth, left] = step.distances[k];
    const auto number = [](double x) { return std::isnan(x) ? Json() : Json(x); };
    list.push_back(
        {{"seconds", times[k]}, {"median", number(median)}, {"ninetieth", number(ninetieth)}, {"left", left}});
  }
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
  error.size = runs.size();
  std::vector<std::vector<Moment>> moments;
  for (const uint32_t refinement : refinements) moments.push_back(runs.run(refinement));
  for (size_t run = 0; run + 1 < moments.size(); ++run) {
    ErrorOfStep &step = error.steps.emplace_back();
    step.step = double{settings.step} / refinements[run];
    for (size_t k = 0; k < error.times.size(); ++k)
      step.distances.push_back(distance_of_worlds(moments[run][k], moments.back()[k], error.bodies, error.size));
  }
  error.converged_step = double{settings.step} / *std::rbegin(refinements);
  return error;
}

namespace {

/* What the table does not say of worlds that left the range. */
std::string note_of_those_left(const ControlsError &error)
{
  const auto has_left = [](const DistanceOfWorlds &distance) { return distance.left > 0; };
  const bool any = std::any_of(error.steps.begin(), error.steps.end(), [&](const ErrorOfStep &step) {
    return std::any_of(step.distances.begin(), step.distances.end(), has_left);
  });
  if (!any) return "";
  return fmt::format("  Worlds left the range, because a body was not finite or they were apart by more than the "
                     "size of the scene,\n"
                     "  {:.3g} m; the table counts them and has the median of the rest.\n",
                     error.size);
}

} // namespace

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
      "step.\n{}",
      1e3 * error.converged_step, error.bodies, error.worlds, 1e3 * interval_of_controls, table.text("    "),
      note_of_those_left(error));
}

Json json_of(const ControlsError &error)
{
  Json steps = Json::array();
  for (const ErrorOfStep &step : error.steps)
    steps.push_back({{"step_ms", 1e3 * step.step}, {"distance_mm", json_of_distances(step, error.times)}});
  return {{"worlds", error.worlds},
          {"bodies", error.bodies},
          {"controls_held_ms", 1e3 * interval_of_controls},
          {"size_m", error.size},
          {"converged_step_ms", 1e3 * error.converged_step},
          {"steps", steps}};
}

} // namespace tandem
