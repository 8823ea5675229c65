/* cases_chains.cpp - the group of cases of many bodies in a row: ropes, chains, bridges, springs, rings. A row is hard
 * because a pass hands an impulse on by a joint or two, and because each link bears all that hangs below it.
 *
 * The links of a real chain are rigid. What a wire rope gives at its working load, half a percent, is what users know,
 * and so it is the bound of all stretches here.
 */
#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "host/catalog/catalog.h"
#include "tools/stability/joints.h"

namespace tandem::stability {
namespace {

constexpr double rope_stretch = 0.005;

/* What is publicly known of other engines. */
constexpr const char *of_box2d =
    "Box2D, manual of 2.2: chains that bear heavier bodies stretch, less stable from 10:1 on";
constexpr const char *of_vortex =
    "Andrews, Teichmann and Kry (2017), with an adaptive damping: stable to 1,000,000:1 at steps of 0.1 s";

/* A pendulum's energy by Euler's method swings by half of w h. */
Bound swing_of_energy(double length, const Settings &settings)
{
  const double rate = std::sqrt(standard_gravity / length), substep = double(settings.step) / settings.substeps;
  return Bound::from_theory(0.5 * rate * substep,
                            fmt::format("w h / 2 of a pendulum of {:.3g} m, substeps of {:.3g} s", length, substep));
}

/* --- ropes: links of half a metre and of 1 kg, a ball at the end, let go at 45 degrees from the vertical -------- */

struct Rope {
  static constexpr int links = 20;
  static constexpr double link = 0.5, radius = 0.4, angle = pi / 4, length = links * link + radius;
};

Scene rope_scene(float mass)
{
  Scene scene = empty_scene();
  const Vector down(std::sin(Rope::angle), -std::cos(Rope::angle), 0);
  const Quat turn = turn_about(Vector::UnitZ(), Rope::angle);
  for (int i = 0; i < Rope::links; ++i) {
    add_body(scene, BodyType::dynamic, capsule_shape(0.05f, 0.2f), point_of((i + 0.5) * Rope::link * down));
    scene.bodies.back().orientation = turn;
  }
  add_body(scene, BodyType::dynamic, sphere_shape(float(Rope::radius)), point_of(Rope::length * down), mass);
  scene.bodies.back().orientation = turn;
  let_pass(scene);
  for (uint32_t i = 0; i <= uint32_t(Rope::links); ++i)
    connect(scene, JointType::ball, i == 0 ? no_body : i - 1, i, i * Rope::link * down);
  return scene;
}

Trial rope_trial(float mass, uint32_t substeps, Length length)
{
  Trial trial = trial_of(rope_scene(mass), steps_for(length, 600, 300));
  trial.documented = with_stiff_joints(substeps);
  trial.checks.push_back(
      check("stretch of the rope", "", rope_stretch, stretch_to(Rope::links, Vector::Zero(), Rope::length)));
  const double fall = Rope::length * (1 - std::cos(Rope::angle));
  trial.checks.push_back(check("gain of energy", "", swing_of_energy(Rope::length, *trial.documented),
                               relative_energy_gain(trial.scene, double(mass) * standard_gravity * fall)));
  return trial;
}

Case rope_case(float ratio, uint32_t substeps, const char *elsewhere)
{
  return {fmt::format("rope-{:.0f}", ratio),
          "chains",
          fmt::format("a ball of {:.0f} kg swings on 20 links of 1 kg, let go at 45 degrees", ratio),
          "the rope gets longer by half a percent at most, as wire rope does; energy grows by no more than Euler's "
          "method of a pendulum has it, w h / 2 of the swing",
          [=](Length length) { return rope_trial(ratio, substeps, length); },
          true,
          "",
          elsewhere};
}

/* --- chains that hang: each joint bears what is below it -------------------------------------------------------- */

Scene hanging_chain(int links)
{
  Scene scene = empty_scene();
  for (int i = 0; i < links; ++i) add_body(scene, BodyType::dynamic, capsule_shape(0.1f, 0.4f), {0, -(i + 0.5), 0});
  let_pass(scene);
  for (uint32_t i = 0; i < uint32_t(links); ++i)
    connect(scene, JointType::ball, i == 0 ? no_body : i - 1, i, {0, -double(i), 0});
  return scene;
}

Case hanging_case(int links, uint32_t substeps)
{
  return {fmt::format("chain-{}", links),
          "chains",
          fmt::format("a chain of {} links of 1 m hangs by its end, which bears all of them", links),
          "it gets longer by half a percent at most, as wire rope does, and hangs straight",
          [=](Length length) {
            const int used = length == Length::brief ? links / 10 : links;
            Trial trial = trial_of(hanging_chain(used), steps_for(length, 600, 120));
            trial.every = 4;
            trial.documented = with_stiff_joints(substeps);
            trial.checks.push_back(
                check("stretch of the chain", "", rope_stretch, stretch_to(used - 1, Vector::Zero(), used - 0.5)));
            trial.checks.push_back(
                check("farthest sideways", "m", distance_from_rounding(trial), sideways(trial.scene)));
            return trial;
          },
          true};
}

/* --- a bridge: planks on hinges in the shape in which they and a load in the middle balance --------------------- */

class Bridge {
public:
  static constexpr double plank = 0.5, thick = 0.05, share_of_span = 0.97, load = 1000, reach = 0.4; /* m, kg */
  static constexpr double mass = 25; /* kg, of a plank */

  explicit Bridge(int planks, double longer = 0) : half_(planks / 2), length_(plank * (1 + longer))
  {
    double low = 1, high = 1e9; /* N, of the horizontal pull: more of it makes the bridge flatter and so longer */
    for (int k = 0; k < 200; ++k) {
      pull_ = std::sqrt(low * high);
      (span() < half_ * plank * share_of_span ? low : high) = pull_;
    }
  }
  /* From the middle. The load rests on the two innermost planks, `reach` from the middle. */
  double slope(int k) const
  {
    const double inner = k == 0 ? 0.5 * load * (1 - reach / plank) : 0.5 * load + k * mass;
    return std::atan((inner + 0.5 * mass) * standard_gravity / pull_);
  }
  double span() const
  {
    return sum([&](int k) { return std::cos(slope(k)); });
  }
  double sag() const
  {
    return sum([&](int k) { return std::sin(slope(k)); });
  }
  int half() const { return half_; }

private:
  template <typename Of> double sum(Of of) const
  {
    double total = 0;
    for (int k = 0; k < half_; ++k) total += length_ * of(k);
    return total;
  }
  int half_;
  double length_, pull_ = 0;
};

/* Planks from the left bank to the right one; the last body is the load. */
Scene bridge_scene(const Bridge &bridge)
{
  Scene scene = empty_scene();
  Vector at(-bridge.span(), 0, 0);
  const Vector across = Vector::UnitZ();
  for (int i = 0; i < 2 * bridge.half(); ++i) {
    const double angle = i < bridge.half() ? -bridge.slope(bridge.half() - 1 - i) : bridge.slope(i - bridge.half());
    const Vector half = 0.5 * Bridge::plank * Vector(std::cos(angle), std::sin(angle), 0);
    add_body(scene, BodyType::dynamic, box_shape(0.25f, float(Bridge::thick), 1), point_of(at + half),
             float(Bridge::mass))
        .orientation = turn_about(across, angle);
    const auto plank = uint32_t(i);
    connect(scene, JointType::hinge, i == 0 ? no_body : plank - 1, plank, at, across);
    scene.bodies.back().filter_group = 2; /* planks do not collide with one another */
    scene.bodies.back().filter_mask = 1;
    at += 2 * half;
  }
  connect(scene, JointType::hinge, uint32_t(2 * bridge.half() - 1), no_body, at, across);
  const double top =
      -bridge.sag() + Bridge::thick / std::cos(bridge.slope(0)) + Bridge::reach * std::tan(bridge.slope(0));
  add_body(scene, BodyType::dynamic, box_shape(float(Bridge::reach), 0.4f, 0.8f), {0, top + 0.4, 0},
           float(Bridge::load));
  return scene;
}

Trial bridge_trial(int planks, Length length)
{
  const int used = length == Length::brief ? planks / 10 : planks;
  const Bridge bridge(used), longer(used, rope_stretch);
  Trial trial = trial_of(bridge_scene(bridge), steps_for(length, 600, 120));
  trial.every = 4;
  trial.documented = with_stiff_joints(32);
  const double start = trial.scene.bodies.back().position[1], sinks = longer.sag() - bridge.sag();
  trial.checks.push_back(check("load from where it balances", "m", sinks, [start](const Moment &moment) {
    return std::abs(double(moment.bodies.back().position[1]) - start);
  }));
  return trial;
}

/* --- springs in a row ------------------------------------------------------------------------------------------- */

constexpr double soft_spring = 1e3, hard_spring = 1e9; /* N/m */

Scene springs_scene(int springs)
{
  Scene scene = empty_scene();
  for (int i = 0; i < springs; ++i) {
    add_body(scene, BodyType::dynamic, sphere_shape(0.1f), {0, -(i + 1.0), 0});
    Joint joint;
    joint.type = JointType::distance;
    joint.body_a = i == 0 ? no_body : uint32_t(i - 1);
    joint.body_b = uint32_t(i);
    const double stiffness = i % 2 == 0 ? soft_spring : hard_spring;
    joint.directions[0] = {.target_position = 1, .stiffness = float(stiffness), .damping = float(0.02 * stiffness)};
    scene.joints.push_back(joint);
  }
  let_pass(scene);
  return scene;
}

/* The largest difference of a spring's length from 1 m and load / stiffness. */
Figure error_of_springs(int springs)
{
  return [springs](const Moment &moment) {
    const std::vector<PreciseBodyState> states = moment.world.precise_bodies();
    double worst = 0, above = 0;
    for (int i = 0; i < springs; ++i) {
      const double at = -states[size_t(i)].position[1];
      const double expected = 1 + (springs - i) * standard_gravity / (i % 2 == 0 ? soft_spring : hard_spring);
      const double error = std::abs(at - above - expected);
      if (error > worst || std::isnan(error)) worst = error;
      above = at;
    }
    return worst;
  };
}

Trial springs_trial(Length length)
{
  const int springs = 10;
  Trial trial = trial_of(springs_scene(springs), steps_for(length, 1200, 1200));
  trial.every = 10;
  /* What a good scale tells: a ten-thousandth of the way that the upmost spring gives. */
  trial.checks.push_back(at_end(check("largest error of a spring's length", "m",
                                      1e-4 * springs * standard_gravity / soft_spring, error_of_springs(springs))));
  return trial;
}

/* --- others ----------------------------------------------------------------------------------------------------- */

Trial wrecking_trial(Length length)
{
  const int links = 12;
  const double mass = 500, radius = 0.8, chain = 0.5 * links + radius, height = chain + 1;
  Trial trial = trial_of(load_scene(fmt::format("wrecking-ball:mass={}", mass)), steps_for(length, 600, 300));
  trial.documented = with_stiff_joints(32);
  trial.checks.push_back(check("stretch of the chain", "", rope_stretch, stretch_to(1 + links, {0, height, 0}, chain)));
  trial.checks.push_back(check("gain of energy", "", swing_of_energy(chain, *trial.documented),
                               relative_energy_gain(trial.scene, mass * standard_gravity * chain)));
  return trial;
}

/* Links of a millimetre on hinges, let go from the horizontal. */
Trial tiny_trial(Length length)
{
  const int links = 10;
  const double link = 1e-3, half = 0.5 * link, mass = 1e-7;
  Scene scene = empty_scene();
  for (int i = 0; i < links; ++i) {
    add_body(scene, BodyType::dynamic, box_shape(float(half), float(0.2 * half), float(0.5 * half)),
             {half * (1 + 2 * i), 0, 0}, float(mass));
    const auto body = uint32_t(i);
    connect(scene, JointType::hinge, i == 0 ? no_body : body - 1, body, {i * link, 0, 0}, Vector::UnitZ());
  }
  let_pass(scene);
  Trial trial = trial_of(std::move(scene), steps_for(length, 300, 300));
  trial.documented = with_stiff_joints(128);
  trial.checks.push_back(check("farthest open joint", "m", 0.01 * link, joint_opening()));
  trial.checks.push_back(
      check("gain of energy", "", swing_of_energy(links * link, *trial.documented),
            relative_energy_gain(trial.scene, 0.5 * links * links * mass * standard_gravity * link)));
  return trial;
}

/* A ring of links that turns about its axis: what circles pulls at each of them. */
Trial ring_trial(Length length)
{
  const int links = 60;
  const double link = 0.2, spin = 5, half_angle = pi / links, radius = 0.5 * link / std::tan(half_angle);
  Scene scene = empty_scene({0, 0, 0});
  for (int i = 0; i < links; ++i) {
    const double angle = 2 * half_angle * i;
    const Vector out(std::cos(angle), std::sin(angle), 0), along(-out.y(), out.x(), 0);
    Body &body = add_body(scene, BodyType::dynamic, box_shape(0.1f, 0.03f, 0.03f), point_of(radius * out));
    body.orientation = turn_about(Vector::UnitZ(), angle + pi / 2);
    body.linear_velocity = vec3_of(spin * radius * along);
    body.angular_velocity = {0, 0, float(spin)};
  }
  let_pass(scene);
  for (int i = 0; i < links; ++i) {
    const double angle = 2 * half_angle * (i + 0.5), corner = 0.5 * link / std::sin(half_angle);
    connect(scene, JointType::ball, uint32_t(i), uint32_t((i + 1) % links),
            {corner * std::cos(angle), corner * std::sin(angle), 0});
  }
  Trial trial = trial_of(std::move(scene), steps_for(length, 600, 300));
  trial.documented = with_stiff_joints(16);
  trial.checks.push_back(check("growth of the radius", "", rope_stretch, [=](const Moment &moment) {
    double worst = 0;
    for (const PreciseBodyState &state : moment.world.precise_bodies()) {
      const double growth = Vector(state.position.data()).norm() / radius - 1;
      if (growth > worst || std::isnan(growth)) worst = growth;
    }
    return worst;
  }));
  trial.checks.push_back(check("drift of angular momentum", "", 4e-6, angular_momentum_drift()));
  trial.checks.push_back(check("drift of energy", "", 0.01, kinetic_energy_drift()));
  return trial;
}

} // namespace

void add_chain_cases(std::vector<Case> &cases)
{
  const char *group = "chains";
  cases.push_back(rope_case(1800, 64, of_box2d));
  cases.push_back(rope_case(10000, 192, of_vortex));
  cases.push_back(hanging_case(100, 8));
  cases.push_back(hanging_case(1000, 24));
  cases.push_back({"bridge-200", group, "200 planks of 25 kg on hinges between two banks, with 1 t in the middle",
                   "the load stays where it balances, lower by no more than if the planks gave half a percent, as wire "
                   "rope does",
                   [](Length length) { return bridge_trial(200, length); }, true});
  cases.push_back({"springs-1e3-1e9", group, "ten balls hang in a row on springs of 1,000 and 1e9 N/m in turn",
                   "each spring is longer by load / stiffness, within a ten-thousandth of what the upmost one gives",
                   springs_trial});
  cases.push_back({"wrecking-ball-100", group, "a ball of 500 kg on 12 links of 5 kg swings into a wall of bricks",
                   "the chain gets longer by half a percent at most, as wire rope does; energy grows by no more than "
                   "Euler's method of a pendulum has it",
                   wrecking_trial, true});
  cases.back().elsewhere = of_box2d;
  cases.push_back({"links-1-mm", group, "ten links of 1 mm on hinges, let go from the horizontal",
                   "joints open by a hundredth of a link at most; energy grows by no more than Euler's method of a "
                   "pendulum has it",
                   tiny_trial});
  cases.push_back({"ring-spinning", group, "a closed loop of 60 links turns at 5 rad/s in empty space",
                   "its radius grows by half a percent at most, as wire rope does; angular momentum is conserved, and "
                   "energy within a hundredth",
                   ring_trial, true});
}

} // namespace tandem::stability
