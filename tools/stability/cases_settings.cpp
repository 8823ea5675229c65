/* cases_settings.cpp - settings and forces far from the usual: soft and stiff contacts, coarse and fine steps. */
#include <algorithm>

#include <fmt/format.h>

#include "host/scene_catalog.h"
#include "tools/stability/cases.h"

namespace tandem::stability {
namespace {

std::vector<float> equal(int n) { return std::vector<float>(size_t(n), 1.0f); }

/* A column of five that stands, beside a ball that falls on the ground next to it from 2 m. */
Scene column_and_ball()
{
  Scene scene = column_of(equal(5));
  add_body(scene, Motion::dynamic, sphere_shape(0.25f), {3, 2.25f, 0});
  return scene;
}

/* `lifted`: how much energy pushing out of the overlap at the start may give. */
void watch_ball_and_column(Trial &trial, double depth, double lifted = 0.05)
{
  trial.checks.push_back(at_end(check("deepest contact at the end", "m", depth, penetration())));
  trial.checks.push_back(check("farthest sideways", "m", 0.05, sideways(trial.scene)));
  trial.checks.push_back(check("gain of energy", "J/kg", lifted, energy_gain()));
  trial.checks.push_back(at_end(check("fastest at the end", "m/s", 0.05, speed())));
}

/* Where springs of this frequency hold a column of cubes of 1 kg: beyond the slop by (load / effective mass) g / w^2, where the
 * lowest contact of two cubes (effective mass 1/2) carries `load` of them. */
double rest_depth(double hertz, double load)
{
  const double w = 2 * pi * hertz, effective_mass = 0.5, slop = 0.005;
  return slop + load / effective_mass * 10 / (w * w);
}

/* The lower of a column of five, and a tenth more; a cube of 1 m must not pass through another whatever the springs are. */
double depth_of_five(double hertz) { return std::min(0.9, 0.005 + 1.1 * (rest_depth(hertz, 4) - 0.005)); }

Case stiffness_case(double hertz)
{
  const double depth = std::max(0.02, depth_of_five(hertz));
  return {fmt::format("stiffness-{}", hertz), "settings", fmt::format("contacts of {} Hz: a column of five cubes that starts 2 cm in one another, and a ball that falls beside it", hertz),
          "nothing leaves sideways by 5 cm, energy grows by no more than pushing the cubes apart takes (0.6 J/kg), contacts after 5 s at most 2 cm deep, or where springs of that "
          "frequency hold the load, and slower than 0.05 m/s",
          [hertz, depth](Length length) {
            Trial trial = trial_of(column_and_ball(), steps_for(length, 300, 300));
            for (size_t i = 1; i <= 5; ++i) trial.scene.bodies[i].position[1] -= 0.02f * float(i);
            trial.settings.contact_hertz = float(hertz);
            watch_ball_and_column(trial, depth, 0.6);
            if (hertz < 1) trial.checks.back().bound = 0.5; /* it still sinks: slower than an overdamped spring lets it fall */
            return trial;
          }};
}

/* 5 s, or as many seconds as 3,000 steps are. At 1/10 s a ball of 25 cm moves by more than its radius in a step. */
Case step_case(int rate, uint64_t steps)
{
  return {fmt::format("dt-1/{}", rate), "settings", fmt::format("steps of 1/{} s: a column of five cubes, and a ball that falls beside it", rate),
          fmt::format("nothing leaves sideways by 5 cm, energy never grows, contacts at most 2 cm deep at the end{}", rate <= 1000 ? ", at rest then" : ""),
          [rate, steps](Length length) {
            Trial trial = trial_of(column_and_ball(), steps_for(length, steps, steps));
            trial.every = std::max<uint64_t>(1, steps / 300);
            trial.settings.step = float(1.0 / rate);
            trial.documented = trial.settings;
            trial.documented->substeps = 8;
            watch_ball_and_column(trial, 0.02);
            if (rate > 1000) trial.checks.pop_back(); /* the ball still falls */
            return trial;
          }};
}

Case passes_case(const std::string &name, const std::string &what, uint32_t substeps, uint32_t iterations, int height, uint64_t steps, double depth = 0.02)
{
  return {name, "settings", what, fmt::format("nothing leaves sideways by 5 cm or turns by 0.05 rad, contacts at most {:.3g} m deep, at rest at the end", depth),
          [=](Length length) {
            Trial trial = trial_of(column_of(equal(height)), steps_for(length, steps, steps));
            trial.own_passes = true;
            trial.settings.substeps = substeps;
            trial.settings.iterations = iterations;
            if (length == Length::brief) trial.settings.iterations = std::min(iterations, 5u);
            add_standing(trial, {0.05, 0.05, depth, 0.05});
            return trial;
          }};
}

Trial weightless_trial(Length length)
{
  Trial trial = trial_of(load_scene("box-stack:n=27,height=3,gap=0"), steps_for(length, 600, 600));
  trial.scene.gravity = {0, 0, 0};
  trial.checks.push_back(check("farthest from the start", "m", 1e-5, displacement(trial.scene)));
  trial.checks.push_back(check("largest tilt", "rad", 1e-5, tilt(trial.scene)));
  return trial;
}

Trial heavy_trial(Length length)
{
  Trial trial = trial_of(column_of(equal(5)), steps_for(length, 600, 600));
  trial.scene.gravity = {0, -1000, 0};
  trial.documented = with_substeps(16);
  add_standing(trial, {});
  return trial;
}

} // namespace

void add_setting_cases(std::vector<Case> &cases)
{
  for (double hertz : {0.6, 6.0, 60.0, 600.0, 6000.0, 60000.0, 600000.0}) cases.push_back(stiffness_case(hertz));
  cases.push_back(step_case(10, 50));
  cases.push_back(step_case(30, 150));
  cases.push_back(step_case(240, 1200));
  cases.push_back(step_case(1000, 5000));
  cases.push_back(step_case(10000, 10000));
  cases.push_back(passes_case("iterations-1", "one pass a substep: a column of ten cubes", 4, 1, 10, 600));
  cases.push_back(passes_case("iterations-1000", "1,000 passes a substep: a column of ten cubes, which a solver that adds energy would blow up", 4, 1000, 10, 30));
  /* A substep of 1/60 s allows springs of a fifth of its rate; overdamped, they reach their depth and no more. */
  cases.push_back(passes_case("substeps-1", "one substep of one pass: a column of ten cubes, held by the springs of 12 Hz that it allows: load / effective mass x g / w^2 = 3.2 cm",
                              1, 1, 10, 600, rest_depth(12, 9) + 1e-6)); /* floats of a height of 10 m are 1e-6 m apart */
  cases.push_back(passes_case("substeps-1000", "1,000 substeps: a column of ten cubes, 17 microseconds a substep", 1000, 1, 10, 30));
  cases.push_back({"gravity-0", "settings", "27 cubes that touch face to face, without gravity", "nothing moves by 10 micrometres or turns by 10 microradians in 10 s",
                   weightless_trial});
  cases.push_back({"gravity-1000", "settings", "a column of five cubes under 1,000 m/s^2",
                   "nothing leaves sideways by 5 cm or turns by 0.05 rad, contacts at most 2 cm deep, at rest at the end", heavy_trial});
}

} // namespace tandem::stability
