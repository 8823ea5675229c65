/* cases_conflicts.cpp - the group of cases of joints that contradict contacts, one another, or their start: what cannot
 * all hold must give way quietly, and nothing may be thrown.
 */
#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "host/catalog/catalog.h"
#include "tools/stability/joints.h"

namespace tandem::stability {
namespace {

constexpr double one_degree = pi / 180;

/* m, under this load of the lighter of two bodies that a joint holds, in m/s^2. */
double joint_under(double load) { return load * JointSoftness({}).stretch; }

/* A motor presses a cube of 1 kg into the ground with a hundred times its weight. */
Trial pressed_trial(Length length)
{
  Trial trial = trial_of(column_of({1}), steps_for(length, 300, 300));
  Joint &joint = connect(trial.scene, JointType::slider, no_body, 1, {0, 0.5, 0}, -Vector::UnitY());
  joint.directions[0].motor = true;
  joint.directions[0].target_velocity = 1;
  joint.directions[0].max_force = 1000;
  add_standing(trial, {});
  return trial;
}

/* A ball joint wants the centre of a cube 10 cm lower than the ground lets it. */
Trial buried_trial(Length length)
{
  Trial trial = trial_of(column_of({1}), steps_for(length, 300, 300));
  connect(trial.scene, JointType::ball, no_body, 1, {0, 0.5, 0}).position_a[1] -= 0.1;
  add_standing(trial, {});
  trial.checks.push_back(check("joint open by", "m", 0.1 + 0x1p-23, joint_opening()));
  return trial;
}

/* A cube between two walls that are 2 cm too near, and a joint that wants it 5 cm within one of them. */
Trial wedged_trial(Length length)
{
  Scene scene = empty_scene();
  for (const double x : {-1.49, 1.49}) add_body(scene, BodyType::fixed, box_shape(1, 2, 2), {x, 0, 0});
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 0, 0});
  connect(scene, JointType::fixed, no_body, 2, Vector::Zero()).position_a[0] -= 0.05;
  Trial trial = trial_of(std::move(scene), steps_for(length, 300, 300));
  trial.checks.push_back(check("farthest from the start", "m", 0.05, displacement(trial.scene)));
  trial.checks.push_back(check("largest tilt", "rad", turn_from_rounding(trial), tilt(trial.scene)));
  trial.checks.push_back(at_end(check("fastest at the end", "m/s", speed_from_rounding(trial), speed())));
  return trial;
}

/* A square of bars, one of them held by the world, whose four hinges have axes that are not parallel: it cannot move.
 * Its hinges hold two axes more than it has. */
Trial locked_loop_trial(Length length)
{
  Scene scene = empty_scene();
  const Vector corners[] = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}};
  const Vector axes[] = {{1, 2, 3}, {-1, 1, 2}, {2, -1, 1}, {1, 1, -1}};
  for (int i = 0; i < 4; ++i) {
    const Vector along = corners[(i + 1) % 4] - corners[i];
    add_body(scene, i == 0 ? BodyType::fixed : BodyType::dynamic, box_shape(0.5f, 0.05f, 0.05f),
             point_of(corners[i] + 0.5 * along))
        .orientation = turn_about(Vector::UnitY(), -i * pi / 2);
  }
  let_pass(scene);
  for (uint32_t i = 0; i < 4; ++i) connect(scene, JointType::hinge, (i + 3) % 4, i, corners[i], axes[i]);
  Trial trial = trial_of(std::move(scene), steps_for(length, 600, 600));
  trial.documented = with_stiff_joints(8);
  trial.checks.push_back(check("farthest from the start", "m", 0.005, displacement(trial.scene)));
  trial.checks.push_back(at_end(check("fastest at the end", "m/s", speed_from_rounding(trial), speed())));
  return trial;
}

/* A plate of 20 kg whose four legs are fixed to it and to the floor. */
Trial table_trial(Length length)
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_body(scene, BodyType::dynamic, box_shape(1, 0.05f, 0.6f), {0, 1.05, 0}, 20);
  for (const double x : {-0.9, 0.9})
    for (const double z : {-0.5, 0.5}) {
      add_body(scene, BodyType::dynamic, box_shape(0.05f, 0.5f, 0.05f), {x, 0.5, z});
      const auto leg = uint32_t(scene.bodies.size() - 1);
      connect(scene, JointType::fixed, 1, leg, {x, 1, z});
      connect(scene, JointType::fixed, 0, leg, {x, 0, z});
    }
  Trial trial = trial_of(std::move(scene), steps_for(length, 600, 600));
  /* Each leg bears a quarter of the plate, and the plate's corner gives with its mass and its moments. */
  const double corner = 1.0 / 20 + 0.5 * 0.5 / (20 * 0.36 / 3) + 0.9 * 0.9 / (20 * 1.0 / 3);
  const double open = joint_under((20.0 / 4 + 1) * standard_gravity * (1 + corner));
  trial.checks.push_back(check("farthest open joint", "m", open, joint_opening()));
  trial.checks.push_back(check("farthest from the start", "m", 2 * open, displacement(trial.scene)));
  trial.checks.push_back(at_end(check("fastest at the end", "m/s", speed_from_rounding(trial), speed())));
  return trial;
}

/* A hinge whose limits are both 0 holds a bar of 1 kg, level, with 100 kg fixed to its end. */
Trial no_range_trial(Length length)
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.05f, 0.05f), {0.5, 0, 0});
  add_body(scene, BodyType::dynamic, sphere_shape(0.2f), {1.2, 0, 0}, 100);
  JointAxis &axis = connect(scene, JointType::hinge, no_body, 0, Vector::Zero(), Vector::UnitZ()).rotations[0];
  axis.lower = axis.upper = 0;
  connect(scene, JointType::fixed, 0, 1, {1, 0, 0});
  Trial trial = trial_of(std::move(scene), steps_for(length, 600, 600));
  trial.documented = with_stiff_joints(16);
  trial.checks.push_back(check("largest tilt", "rad", one_degree, tilt(trial.scene)));
  trial.checks.push_back(check("farthest open joint", "m", 0.01, joint_opening()));
  trial.checks.push_back(at_end(check("fastest at the end", "m/s", speed_from_rounding(trial), speed())));
  return trial;
}

/* Pairs of bodies in empty space, a joint of each type between them, whose frames begin ten metres and three radians
 * apart. */
Trial apart_trial(Length length)
{
  Scene scene = empty_scene({0, 0, 0});
  const JointType types[] = {JointType::ball,  JointType::fixed,     JointType::hinge,      JointType::slider,
                             JointType::plane, JointType::universal, JointType::cone_twist, JointType::cylindrical};
  for (const JointType type : types) {
    const auto first = uint32_t(scene.bodies.size());
    const double z = 20.0 * first;
    for (int side = 0; side < 2; ++side) add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.3f, 0.4f), {0, 0, z});
    connect(scene, type, first, first + 1, {0.5, 0.2, z + 0.1}, {1, 1, 1});
    scene.bodies.back().position = {6, -7, z + 4};
    scene.bodies.back().orientation = turn_about({1, -2, 2}, 3);
  }
  let_pass(scene);
  Trial trial = trial_of(std::move(scene), steps_for(length, 600, 600));
  trial.documented = with_stiff_joints(16);
  trial.checks.push_back(check("fastest", "m/s", 10, speed()));
  trial.checks.push_back(at_end(check("farthest open joint at the end", "m", 0.001, joint_opening())));
  trial.checks.push_back(at_end(check("farthest turned joint at the end", "rad", 0.1 * one_degree, joint_angle())));
  return trial;
}

/* A load on a joint that breaks at 1,000 N grows by 5 N a step: when it breaks, it must have reached that. */
Trial breaking_trial(Length length)
{
  const double limit = 1000, mass = 10, more = 5;
  Scene scene = empty_scene();
  add_body(scene, BodyType::dynamic, sphere_shape(0.2f), {0, -1, 0}, float(mass));
  connect(scene, JointType::ball, no_body, 0, Vector::Zero()).break_force = float(limit);
  Trial trial = trial_of(std::move(scene), steps_for(length, 300, 300));
  trial.disturb = [=](World &world, uint64_t step) {
    world.add_force(world.id_of(0), {.force = {0, float(-more * double(step)), 0}});
  };
  auto broke_at = std::make_shared<uint64_t>(0);
  trial.checks.push_back(
      at_end(check("error of the load that broke it", "", 2 * more / limit, [=](const Moment &moment) {
        if (*broke_at == 0 && !moment.world.joint_breaks().empty()) *broke_at = moment.step;
        const double load = mass * standard_gravity + more * (double(*broke_at) - 1);
        return *broke_at == 0 ? 1.0 : std::abs(load / limit - 1);
      })));
  return trial;
}

/* Eight people above one another, the lowest of whom falls from 20 m. */
Trial people_trial(Length length)
{
  Trial trial = trial_of(load_scene("ragdolls:n=8,storeys=8,height=20"), steps_for(length, 600, 300));
  trial.documented = with_stiff_joints(16);
  trial.checks.push_back(check("farthest open joint", "m", 0.05, joint_opening()));
  trial.checks.push_back(at_end(check("mean of open joints at the end", "m", 5e-4, mean_joint_opening())));
  trial.checks.push_back(check("farthest under the ground", "m", 0, below(0)));
  trial.checks.push_back(check("gain of energy", "J/kg", energy_from_rounding(trial), energy_gain()));
  return trial;
}

} // namespace

void add_conflict_cases(std::vector<Case> &cases)
{
  const char *group = "conflicts";
  cases.push_back({"pressed-into-ground", group,
                   "a motor on a slider presses a cube into the ground with a hundred times its weight",
                   "it is not pressed in, moved sideways or turned, and rests, but for rounding", pressed_trial});
  cases.push_back(
      {"joint-below-ground", group, "a joint holds the centre of a cube 10 cm lower than the ground lets it be",
       "the ground wins: the joint is open by these 10 cm, and the cube rests but for rounding", buried_trial});
  cases.push_back(
      {"wedged", group,
       "a cube between walls that are 2 cm too near, and a joint that wants it 5 cm within one of them",
       "it gets no farther than the joint wants it, and neither turns nor moves at the end but for rounding",
       wedged_trial});
  cases.push_back({"locked-loop", group, "four bars in a square on hinges that are not parallel, so that none can move",
                   "nothing moves by half a percent of a bar; at rest at the end but for rounding", locked_loop_trial});
  cases.push_back({"table-of-fixed-joints", group, "a plate on four legs that are fixed to it and to the floor",
                   "joints open by no more than their softness has it under the plate, which sinks by two of them; it "
                   "rests but for rounding",
                   table_trial});
  cases.push_back(
      {"limits-equal", group, "a hinge with limits of 0 and 0 holds a bar of 1 kg with 100 kg at its end",
       "the bar leans by a degree at most and opens its joints by 1 cm; at rest at the end but for rounding",
       no_range_trial});
  cases.push_back({"frames-10-m-apart", group, "eight joints whose frames begin 10 m and 3 rad apart",
                   "no body is faster than the 10 m/s with which gaps close; joints are closed at the end within a "
                   "millimetre and a tenth of a degree",
                   apart_trial});
  cases.push_back({"breaking-1000", group, "a joint that breaks at 1,000 N under a load that grows by 5 N a step",
                   "it breaks when the load is 1,000 N, within two steps", breaking_trial});
  cases.push_back({"ragdolls-from-20-m", group, "eight people of 14 parts fall from 20 to 34 m on one another",
                   "joints open by 5 cm at most, the radius of a limb, and by half a millimetre on average at the end; "
                   "no part gets under the ground; energy never grows",
                   people_trial, true});
}

} // namespace tandem::stability
