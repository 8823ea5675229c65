/* cases_settings.cpp - the group of cases with unusual settings and forces: soft and stiff contacts, coarse and fine
 * steps. */
#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "host/catalog/catalog.h"
#include "tools/stability/cases.h"

namespace tandem::stability {
namespace {

std::vector<float> equal(int n) { return std::vector<float>(size_t(n), 1.0f); }

/* A standing column of five, beside a ball that falls on the ground from 2 m. */
Scene column_and_ball()
{
  Scene scene = column_of(equal(5));
  add_body(scene, BodyType::dynamic, sphere_shape(0.25f), {3, 2.25f, 0});
  return scene;
}

struct AtEnd {
  std::optional<double> depth, gain, speed; /* m, J/kg, m/s; derived from rounding if not given */
};

void watch_ball_and_column(Trial &trial, const AtEnd &bounds)
{
  const auto bound = [&](const std::optional<double> &given, auto from_rounding) {
    return given ? Bound(*given) : from_rounding(trial);
  };
  trial.checks.push_back(
      at_end(check("deepest contact at the end", "m", bound(bounds.depth, depth_from_rounding), penetration())));
  trial.checks.push_back(check("farthest sideways", "m", distance_from_rounding(trial), sideways(trial.scene)));
  trial.checks.push_back(check("gain of energy", "J/kg", bound(bounds.gain, energy_from_rounding), energy_gain()));
  trial.checks.push_back(at_end(check("fastest at the end", "m/s", bound(bounds.speed, speed_from_rounding), speed())));
}

/* The depth, slop included, at which springs of this frequency hold a column of cubes of 1 kg; the lowest contact of
 * two cubes (effective mass 1/2) carries `load` of them. */
double rest_depth(double hertz, double load)
{
  const double effective_mass = 0.5, slop = 0.005;
  return slop + sink_under(load / effective_mass, hertz);
}

/* The depth of the lowest contact in a column of five plus a tenth; whatever the springs, a cube of 1 m must not pass
 * through another. */
double depth_of_five(double hertz) { return std::min(0.9, 0.005 + 1.1 * (rest_depth(hertz, 4) - 0.005)); }

/* A column of five whose cubes initially overlap by 2 cm. */
Trial pressed_trial(double hertz, uint32_t substeps, Length length)
{
  Trial trial = trial_of(column_and_ball(), steps_for(length, 300, 300));
  for (size_t i = 1; i <= 5; ++i) trial.scene.bodies[i].position[1] -= 0.02f * float(i);
  trial.own_passes = substeps != trial.settings.substeps;
  trial.settings.substeps = substeps;
  trial.settings.contact_hertz = float(hertz);
  return trial;
}

struct Stiffness {
  double hertz;
  uint32_t substeps; /* enough that a fifth of their rate, the stiffest contact they allow, is not less */
  AtEnd bounds;
};

Case stiffness_case(const Stiffness &stiffness)
{
  return {fmt::format("stiffness-{}", stiffness.hertz), "settings",
          fmt::format("contacts of {} Hz, {} substeps: a column of five cubes that starts 2 cm in one another, and a "
                      "ball that falls beside it",
                      stiffness.hertz, stiffness.substeps),
          "nothing leaves sideways, energy grows by no more than pushing the cubes apart takes (0.6 J/kg), contacts "
          "after 5 s no deeper than where springs of that "
          "frequency hold the load and a tenth more, at rest",
          [stiffness](Length length) {
            Trial trial =
                pressed_trial(stiffness.hertz,
                              length == Length::brief ? std::min(stiffness.substeps, 60u) : stiffness.substeps, length);
            watch_ball_and_column(trial, stiffness.bounds);
            if (stiffness.hertz >
                100) { /* they part each pair at 2.7 m/s and more, and one pass takes that out again only in part */
              trial.documented = trial.settings;
              trial.documented->push_speed = 0.2f;
            }
            return trial;
          }};
}

/* The largest distance between a body and the corresponding one in a world with other contact stiffness. */
Figure difference_with(const Scene &scene, float hertz)
{
  auto twin = std::make_shared<std::unique_ptr<World>>();
  auto done = std::make_shared<uint64_t>(0);
  return [=](const Moment &moment) {
    if (!*twin) {
      Settings other = moment.world.settings();
      other.contact_hertz = hertz;
      *twin = std::make_unique<World>(scene, other, Placement{});
    }
    for (; *done < moment.step; ++*done) (*twin)->step();
    const std::vector<BodyState> like = (*twin)->bodies();
    double worst = 0;
    for (size_t i = 0; i < like.size(); ++i) {
      const double displacement = (vector_of(moment.bodies[i].position) - vector_of(like[i].position)).norm();
      if (std::isnan(displacement) || displacement > worst) worst = displacement;
    }
    return worst;
  };
}

/* Contacts are never stiffer than a fifth of the substep rate, which is the solver's own limit. */
Case clamped_case(double hertz)
{
  return {fmt::format("stiffness-{}-clamped", hertz), "settings",
          fmt::format("contacts of {} Hz with the default substeps, which allow 48 Hz: the column of five cubes that "
                      "starts 2 cm in one another",
                      hertz),
          "each body where contacts of 48 Hz, a fifth of the substep rate, bring it, to the last bit; and as at rest "
          "as there",
          [hertz](Length length) {
            Trial trial = pressed_trial(hertz, Settings{}.substeps, length);
            trial.keeps_substeps = true;
            const double limit = stiffest(trial.settings);
            const float just_above = std::nextafter(float(limit), HUGE_VALF);
            trial.checks.push_back(
                check("difference from contacts at the limit", "m", 0, difference_with(trial.scene, just_above)));
            watch_ball_and_column(trial, {depth_of_five(limit), 0.6, {}});
            return trial;
          }};
}

/* The case lasts 5 s, or 3,000 steps if these are shorter. At 1/10 s a ball of 25 cm moves by more than its radius in a
 * step. */
/* depth: left out where contacts at the end are as deep as floats are apart. */
Case step_case(int rate, uint64_t steps, const AtEnd &bounds)
{
  return {fmt::format("dt-1/{}", rate), "settings",
          fmt::format("steps of 1/{} s: a column of five cubes, and a ball that falls beside it", rate),
          fmt::format("nothing leaves sideways, energy never grows, contacts at most {} deep at the end{}",
                      bounds.depth ? fmt::format("{} m", *bounds.depth) : "rounding",
                      rate <= 1000 ? ", at rest then" : ""),
          [rate, steps, bounds](Length length) {
            Trial trial = trial_of(column_and_ball(), steps_for(length, steps, steps));
            trial.every = std::max<uint64_t>(1, steps / 300);
            trial.settings.step = float(1.0 / rate);
            if (rate < 30) {
              trial.documented = trial.settings;
              trial.documented->substeps = 8;
            }
            watch_ball_and_column(trial, bounds);
            if (rate > 1000) trial.checks.pop_back(); /* the ball is still falling */
            return trial;
          }};
}

Case passes_case(const std::string &name, const std::string &what, uint32_t substeps, uint32_t iterations, int height,
                 uint64_t steps, std::optional<double> depth = std::nullopt)
{
  return {name, "settings", what,
          fmt::format("nothing leaves sideways or turns, contacts at most {} deep, at rest at the end",
                      depth ? fmt::format("{:.3g} m", *depth) : "rounding"),
          [=](Length length) {
            Trial trial = trial_of(column_of(equal(height)), steps_for(length, steps, steps));
            trial.own_passes = trial.keeps_substeps = true;
            trial.settings.substeps = substeps;
            trial.settings.iterations = iterations;
            if (length == Length::brief) trial.settings.iterations = std::min(iterations, 5u);
            add_standing(trial, {depth, {}, {}, {}});
            return trial;
          }};
}

Trial weightless_trial(Length length)
{
  Trial trial = trial_of(load_scene("box-stack:n=27,height=3,gap=0"), steps_for(length, 600, 600));
  trial.scene.gravity = {0, 0, 0};
  trial.checks.push_back(check("farthest from the start", "m", depth_from_rounding(trial), displacement(trial.scene)));
  trial.checks.push_back(
      check("largest tilt", "rad", Bound::from_rounding(0x1p-23, "spacing of floats of 1"), tilt(trial.scene)));
  return trial;
}

Trial heavy_trial(Length length)
{
  Trial trial = trial_of(column_of(equal(5)), steps_for(length, 600, 600));
  trial.scene.gravity = {0, -1000, 0};
  trial.documented = with_substeps(16);
  add_standing(trial, {0.02, {}, {}, {}});
  return trial;
}

} // namespace

void add_setting_cases(std::vector<Case> &cases)
{
  /* At 0.6 Hz the column is still sinking, because an overdamped spring is slow. */
  cases.push_back(stiffness_case({0.6, 4, {depth_of_five(0.6), {}, 0.5}}));
  cases.push_back(stiffness_case({6, 4, {depth_of_five(6), {}, 0.005}}));
  cases.push_back(stiffness_case({24, 4, {depth_of_five(24), 0.6, {}}}));
  cases.push_back(stiffness_case({600, 50, {depth_of_five(600), 0.6, {}}}));
  cases.push_back(stiffness_case({6000, 500, {depth_of_five(6000), 0.6, {}}}));
  cases.push_back(clamped_case(600000));
  cases.push_back(step_case(10, 50, {0.02, {}, {}}));
  cases.push_back(step_case(30, 150, {0.02, {}, {}}));
  cases.push_back(step_case(240, 1200, {3e-4, {}, {}}));
  cases.push_back(step_case(1000, 5000, {2e-5, 5e-4, {}}));
  cases.push_back(step_case(10000, 10000, {{}, 3e-3, {}}));
  cases.push_back(passes_case("iterations-1", "one pass a substep: a column of ten cubes", 4, 1, 10, 600, 0.015));
  cases.push_back(passes_case(
      "iterations-1000", "1,000 passes a substep: a column of ten cubes, which a solver that adds energy would blow up",
      4, 1000, 10, 30));
  /* A substep of 1/60 s allows springs of a fifth of its rate; overdamped, they reach their rest depth without
   * overshoot. */
  cases.push_back(passes_case("substeps-1",
                              "one substep of one pass: a column of ten cubes, held by the springs of 12 Hz that it "
                              "allows: load / effective mass x g / w^2 = 3.2 cm",
                              1, 1, 10, 600,
                              rest_depth(12, 9) + 1e-6)); /* floats at a height of 10 m are 1e-6 m apart */
  cases.push_back(passes_case("substeps-1000", "1,000 substeps: a column of ten cubes, 17 microseconds a substep", 1000,
                              1, 10, 30));
  cases.push_back({"gravity-0", "settings", "27 cubes that touch face to face, without gravity",
                   "nothing moves or turns in 10 s but for rounding", weightless_trial});
  cases.push_back({"gravity-1000", "settings", "a column of five cubes under 1,000 m/s^2",
                   "nothing leaves sideways or turns, contacts at most 2 cm deep, at rest at the end", heavy_trial});
}

} // namespace tandem::stability
