/* cases_structures.cpp - the group of cases of structures that must stand, and of two that must fall in the right
 * way. */
#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "host/catalog/catalog.h"
#include "tools/stability/cases.h"

namespace tandem::stability {
namespace {

Trial standing_trial(const std::string &spec, uint64_t steps, const Standing &bounds)
{
  Trial trial = trial_of(load_scene(spec), steps);
  trial.every = std::max<uint64_t>(1, trial.scene.bodies.size() / 200);
  trial.documented = with_substeps(16);
  add_standing(trial, bounds);
  return trial;
}

/* A pyramid of 1 m cubes. Each contact may be as deep as the slop, so the top may sink by at most rows x slop. */
Case pyramid_case(int rows, const Standing &bounds)
{
  return {fmt::format("pyramid-{}", rows),
          "stacks",
          fmt::format("a wall of cubes, each resting on two, {} rows, 2,000 steps", rows),
          fmt::format(
              "no cube turns by {} rad or leaves by {} m, contacts at most {} m deep, slower than {} m/s at the end",
              *bounds.tilt, *bounds.sideways, *bounds.depth, *bounds.speed),
          [rows, bounds](Length length) {
            const int used = length == Length::brief ? rows / 10 : rows;
            return standing_trial(fmt::format("pyramid:rows={}", used), steps_for(length, 2000, 150), bounds);
          },
          true};
}

Case column_case(int height, const Standing &bounds)
{
  return {
      fmt::format("column-{}", height),
      "stacks",
      fmt::format("a column of {} cubes of 1 m", height),
      fmt::format("stands 20 s: contacts at most {} m deep, turned, moved and, at the end, at rest but for rounding",
                  *bounds.depth),
      [height, bounds](Length length) {
        const int used = length == Length::brief ? 6 + height / 10 : height;
        return standing_trial(fmt::format("box-stack:n={},height={}", used, used), steps_for(length, 1200, 600),
                              bounds);
      },
      true};
}

Case built_case(const std::string &name, const std::string &what, const std::string &spec, const Standing &bounds)
{
  return {name, "stacks", what,
          fmt::format(
              "stands 10 s: nothing turns by {} rad or leaves by {} m, contacts at most {} m deep, at rest at the end",
              *bounds.tilt, *bounds.sideways, *bounds.depth),
          [spec, bounds](Length length) { return standing_trial(spec, steps_for(length, 600, 600), bounds); }};
}

/* The number of bodies from `first` on that have not rotated by 45 degrees. */
Figure still_upright(const Scene &scene, size_t first)
{
  std::vector<Quat> start;
  for (const Body &body : scene.bodies) start.push_back(body.orientation);
  return [start, first](const Moment &moment) {
    int upright = 0;
    for (size_t i = first; i < moment.bodies.size(); ++i) {
      const double cosine = (axes_of(moment.bodies[i].orientation) * axes_of(start[i]).transpose()).trace();
      upright += !((cosine - 1) / 2 < std::sqrt(0.5)); /* a NaN counts as upright */
    }
    return double(upright);
  };
}

Trial dominoes_trial(Length length)
{
  Trial trial =
      trial_of(load_scene(length == Length::brief ? "dominoes:n=5" : "dominoes:n=30"), steps_for(length, 600, 600));
  trial.checks.push_back(at_end(check("dominoes left upright", "", 0, still_upright(trial.scene, 1))));
  trial.checks.push_back(check("gain of energy", "J/kg", energy_from_rounding(trial), energy_gain()));
  trial.checks.push_back(check("deepest contact", "m", 0.05, penetration()));
  return trial;
}

/* The ball is omitted, because nothing stops it from rolling. */
Figure fastest_brick()
{
  return [](const Moment &moment) {
    double worst = 0;
    for (size_t i = 1; i + 1 < moment.bodies.size(); ++i) {
      const double speed = vector_of(moment.bodies[i].linear_velocity).norm();
      if (std::isnan(speed) || speed > worst) worst = speed;
    }
    return worst;
  };
}

Trial wall_trial(Length length)
{
  Trial trial = trial_of(load_scene(length == Length::brief ? "wall:rows=4,length=3,distance=1" : "wall"),
                         steps_for(length, 600, 600));
  trial.checks.push_back(check("gain of energy", "J/kg", energy_from_rounding(trial), energy_gain()));
  trial.checks.push_back(at_end(check("fastest brick at the end", "m/s", speed_from_rounding(trial), fastest_brick())));
  trial.checks.push_back(
      check("farthest under the ground", "m", 0, below(0.15))); /* a brick on its edge has its centre at 0.2 */
  trial.checks.push_back(check("deepest contact", "m", 0.2, penetration()));
  return trial;
}

} // namespace

void add_structure_cases(std::vector<Case> &cases)
{
  cases.push_back(pyramid_case(80, {0.035, 0.04, 0.5, 0.5}));
  cases.push_back(pyramid_case(100, {0.03, 0.05, 0.5, 0.5}));
  cases.push_back(column_case(20, {0.02, {}, {}, {}}));
  cases.push_back(column_case(50, {0.02, {}, {}, {}}));
  cases.push_back(column_case(100, {0.015, {}, {}, {}}));
  cases.push_back(built_case("card-house", "ten leaning pairs of cards in four storeys, flat cards between them",
                             "card-house", {0.015, 0.03, 0.03, 0.015}));
  cases.push_back(
      built_case("arch", "a corbelled arch of six courses a side, closed by a lintel", "arch", {0.01, 0.01, 0.01, {}}));
  cases.push_back(built_case("tower", "54 planks in 18 levels, each level across the one below", "tower",
                             {0.0015, 0.001, 0.001, {}}));
  cases.push_back({"dominoes", "stacks", "a row of 30 dominoes, the first pushed over",
                   "all 30 fall; energy never grows; contacts at most 5 cm deep", dominoes_trial});
  cases.push_back({"wall-hit", "stacks", "a wall of 95 bricks of 1 kg, hit by a ball of 20 kg at 20 m/s",
                   "energy never grows, nothing sinks into the ground, contacts at most 20 cm deep (half a brick), all "
                   "bricks at rest but for rounding after 10 s",
                   wall_trial});
}

} // namespace tandem::stability
