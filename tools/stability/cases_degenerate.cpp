/* cases_degenerate.cpp - the group of cases with invalid initial states, such as deep overlap and lost bodies, and with
 * ambiguous geometry. */
#include <algorithm>
#include <cmath>
#include <limits>

#include "host/catalog/catalog.h"
#include "tools/stability/cases.h"

namespace tandem::stability {
namespace {

/* Removing penetration may lift bodies. 20 J/kg is the energy of a heap 4 m high, which is lower than a heap of a
 * thousand cubes of 1 m without gaps. */
Trial one_place_trial(const Shape &shape, int n, Length length)
{
  Trial trial = trial_of(empty_scene(), steps_for(length, 300, 120));
  add_ground(trial.scene);
  const int used = length == Length::brief ? 12 : length == Length::quick ? n / 5 : n;
  for (int i = 0; i < used; ++i) add_body(trial.scene, BodyType::dynamic, shape, {0, 0.5f, 0});
  trial.every = 5;
  const double bound = length == Length::full ? 20 : 10; /* fewer bodies have less overlap to remove */
  trial.checks.push_back(check("gain of energy", "J/kg", bound, energy_gain()));
  trial.checks.push_back(check("fastest", "m/s", bound, speed()));
  return trial;
}

/* Boxes inside one another, inside the ground and inside a fixed block. */
Trial overlap_trial(Length length)
{
  Trial trial = trial_of(empty_scene(), steps_for(length, 600, 600));
  add_ground(trial.scene);
  const Shape cube = box_shape(0.5f, 0.5f, 0.5f);
  add_body(trial.scene, BodyType::dynamic, cube, {0, 0.5f, 0});
  add_body(trial.scene, BodyType::dynamic, cube, {0.1f, 0.5f, 0});
  add_body(trial.scene, BodyType::dynamic, cube, {5, -0.3f, 0});
  add_body(trial.scene, BodyType::dynamic, box_shape(1, 1, 1), {10, 1, 0});
  add_body(trial.scene, BodyType::dynamic, box_shape(0.2f, 0.2f, 0.2f), {10.2f, 1.1f, 0.1f});
  add_body(trial.scene, BodyType::fixed, box_shape(1, 1, 1), {15, 1, 0});
  add_body(trial.scene, BodyType::dynamic, sphere_shape(0.3f), {15.1f, 1.5f, 0.2f});
  add_body(trial.scene, BodyType::dynamic, sphere_shape(0.5f), {20, 0.5f, 0});
  add_body(trial.scene, BodyType::dynamic, sphere_shape(0.5f), {20, 0.5f, 0});
  trial.checks.push_back(check("fastest", "m/s", 6, speed()));
  trial.checks.push_back(at_end(check("deepest contact at the end", "m", 0.02, penetration())));
  return trial;
}

/* The boxes can slide forever, so the largest speed shows whether overlap was converted to speed. */
Trial overlap_weightless_trial(Length length)
{
  Trial trial = trial_of(empty_scene({0, 0, 0}), steps_for(length, 600, 600));
  for (int i = 0; i < 8; ++i)
    add_body(trial.scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f),
             {0.1f * float(i % 2), 0.1f * float(i / 2 % 2), 0.1f * float(i / 4)});
  trial.checks.push_back(check("fastest", "m/s", 1, speed()));
  trial.checks.push_back(at_end(check("deepest contact at the end", "m", depth_from_rounding(trial), penetration())));
  return trial;
}

Trial many_on_one_trial(Length length)
{
  const int side = length == Length::full ? 100 : length == Length::quick ? 40 : 12;
  Trial trial = trial_of(empty_scene(), steps_for(length, 120, 120));
  add_ground(trial.scene);
  const float half = 0.15f * float(side) / 2;
  add_body(trial.scene, BodyType::dynamic, box_shape(half, 0.5f, half), {0, 0.5f, 0}, float(side * side));
  trial.scene.shapes.push_back(box_shape(0.05f, 0.05f, 0.05f));
  for (int i = 0; i < side * side; ++i) {
    Body body;
    body.shape = uint32_t(trial.scene.shapes.size() - 1);
    body.position = {0.15f * (float(i % side) - 0.5f * float(side - 1)), 1.05f,
                     0.15f * (float(i / side) - 0.5f * float(side - 1))};
    trial.scene.bodies.push_back(body);
  }
  trial.every = 20;
  add_standing(trial, {8e-4, 2e-4, 1e-5, {}});
  return trial;
}

/* Two layers of slabs that touch on all sides and are coplanar with their neighbours. */
Trial coplanar_trial(Length length)
{
  const int side = 6;
  Trial trial = trial_of(empty_scene(), steps_for(length, 600, 600));
  add_ground(trial.scene);
  for (int layer = 0; layer < 2; ++layer)
    for (int i = 0; i < side * side; ++i)
      add_body(trial.scene, BodyType::dynamic, box_shape(0.5f, 0.125f, 0.5f),
               {float(i % side), 0.125f + 0.25f * float(layer), float(i / side)});
  add_standing(trial, {1e-3, {}, {}, {}});
  return trial;
}

/* A box slides over the seams of a fixed floor of tiles without friction; nothing may slow or lift it. */
Trial seams_trial(Length length)
{
  Trial trial = trial_of(empty_scene(), steps_for(length, 240, 240));
  trial.scene.materials[0].static_friction = trial.scene.materials[0].dynamic_friction = 0;
  for (int i = 0; i < 24; ++i) add_body(trial.scene, BodyType::fixed, box_shape(0.5f, 0.25f, 1), {float(i), -0.25f, 0});
  add_body(trial.scene, BodyType::dynamic, box_shape(0.3f, 0.3f, 0.3f), {0.25f, 0.3f, 0}).linear_velocity = {5, 0, 0};
  trial.checks.push_back(check("loss of speed", "m/s", 2e-3, [](const Moment &moment) {
    return std::abs(5 - double(moment.bodies[24].linear_velocity[0]));
  }));
  trial.checks.push_back(check("lifted by", "m", depth_from_rounding(trial),
                               [](const Moment &moment) { return double(moment.bodies[24].position[1]) - 0.3; }));
  return trial;
}

/* The boxes above the quarantined one fall by up to its size and come to rest. */
Trial poison_trial(Length length)
{
  Trial trial = trial_of(load_scene("box-grid:nx=4,ny=4,nz=4"), steps_for(length, 300, 300));
  const uint32_t poisoned = 30;
  const uint64_t when = std::min<uint64_t>(60, trial.steps / 2);
  trial.poisoned = 1;
  trial.disturb = [poisoned, when](World &world, uint64_t step) {
    if (step != when) return;
    BodyState state = world.bodies()[poisoned];
    state.linear_velocity[1] = std::numeric_limits<float>::quiet_NaN();
    world.set_body_unchecked(poisoned, state);
  };
  trial.checks.push_back(check("fastest", "m/s", 12, speed())); /* from the top of the pile to the ground */
  trial.checks.push_back(at_end(check("bodies under the ground by", "m", 0, below(0.5))));
  trial.checks.push_back(check("gain of energy", "J/kg", energy_from_rounding(trial), energy_gain()));
  return trial;
}

} // namespace

void add_degenerate_cases(std::vector<Case> &cases)
{
  const char *group = "degenerate";
  cases.push_back({"boxes-in-one-place", group, "1,000 cubes of 1 m in the same place",
                   "energy grows by less than 20 J/kg, nothing is faster than 20 m/s, all stay finite",
                   [](Length length) { return one_place_trial(box_shape(0.5f, 0.5f, 0.5f), 1000, length); }, true});
  cases.push_back({"balls-in-one-place", group, "500 balls of 1 m in the same place",
                   "energy grows by less than 20 J/kg, nothing is faster than 20 m/s, all stay finite",
                   [](Length length) { return one_place_trial(sphere_shape(0.5f), 500, length); }, true});
  cases.push_back({"deep-overlap", group, "boxes and balls inside one another, in the ground and in a fixed block",
                   "nothing is faster than 6 m/s (twice the push speed), all are apart to 2 cm after 10 s",
                   overlap_trial});
  cases.push_back({"deep-overlap-weightless", group, "eight cubes, almost in one place, without gravity",
                   "nothing is faster than 1 m/s (three axes, each parted at a tenth of the push speed and a half "
                   "more), all are apart after 10 s",
                   overlap_weightless_trial});
  cases.push_back(
      {"many-on-one", group,
       "10,000 cubes of 10 cm on one plate that rests on the ground: 10,000 contacts share a body",
       "nothing leaves by 10 micrometres or turns by 0.2 mrad, contacts at most 0.8 mm deep, at rest after 2 s",
       many_on_one_trial, true});
  cases.push_back({"coplanar", group, "72 slabs in two layers, face to face with all their neighbours",
                   "contacts at most 1 mm deep, nothing leaves or turns in 10 s but for rounding", coplanar_trial});
  cases.push_back({"seams", group, "a box without friction slides at 5 m/s over a floor of 24 tiles",
                   "it loses less than 2 mm/s and is not lifted", seams_trial});
  cases.push_back({"poisoned", group, "a NaN put into one body of a pile of 64",
                   "that body alone is quarantined; the others fall into its place, none through the ground",
                   poison_trial});
}

} // namespace tandem::stability
