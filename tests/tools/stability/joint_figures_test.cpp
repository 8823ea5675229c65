/* joint_figures_test.cpp - the figures of cases of joints notice a wrong motion that is planted by hand, and what their
 * bounds are computed from agrees with theory that does not use their code.
 */
#ifdef TANDEM_COMMAND
#include "tests/catch.h"
#include "tests/tools/stability/planted.h"
#include "tools/stability/counts.h"
#include "tools/stability/joints.h"
#include "tools/stability/results.h"
#include "tools/stability/table.h"

using namespace tandem;
using namespace tandem::stability;

namespace {

using Push = std::function<void(BodyState &)>;

Push move_by(double x, double y, double z = 0)
{
  return [=](BodyState &state) {
    state.position[0] += x;
    state.position[1] += y;
    state.position[2] += z;
  };
}

Push turn_by(const Vector &axis, double angle)
{
  return [=](BodyState &state) {
    const Eigen::Quaterniond q = eigen_of(turn_about(axis, angle)) * eigen_of(state.orientation);
    state.orientation = {float(q.x()), float(q.y()), float(q.z()), float(q.w())};
  };
}

Push speed_up(float factor)
{
  return [=](BodyState &state) {
    for (float &v : state.linear_velocity) v *= factor;
    for (float &w : state.angular_velocity) w *= factor;
  };
}

Push throw_up(float speed)
{
  return [=](BodyState &state) { state.linear_velocity[1] += speed; };
}

/* The documented settings, if there are any: with those the figure passes unless something is planted. */
Outcome run_documented(const std::string &name, uint32_t body, const Push &push, uint64_t steps, uint64_t when)
{
  Trial trial = case_named(name).build(Length::brief);
  trial.own_passes = true;
  if (trial.documented) trial.settings = *trial.documented;
  trial.steps = steps;
  if (push)
    trial.disturb = [=, before = trial.disturb](World &world, uint64_t step) {
      if (before) before(world, step);
      if (step != when) return;
      BodyState state = world.bodies()[body];
      push(state);
      world.set_body_unchecked(body, state);
    };
  return run(name, std::move(trial));
}

/* The figure passes these steps without the push, and fails with it; the push comes before the last of them. */
void check_notices(const std::string &name, const std::string &figure, uint32_t body, const Push &push,
                   uint64_t steps = 20)
{
  INFO(name << ": " << figure);
  CHECK_FALSE(failed(run_documented(name, body, {}, steps, steps - 1), figure));
  CHECK(failed(run_documented(name, body, push, steps, steps - 1), figure));
}

} // namespace

TEST_CASE("stability: figures of chains notice what is planted", "[stability]")
{
  check_notices("rope-1800", "stretch of the rope", 20, move_by(0.5, -0.5));
  check_notices("rope-1800", "gain of energy", 20, speed_up(1.1f));
  check_notices("chain-100", "stretch of the chain", 9, move_by(0, -1));
  check_notices("chain-100", "farthest sideways", 5, move_by(0.5, 0));
  check_notices("bridge-200", "load from where it balances", 20, move_by(0, 3));
  check_notices("links-1-mm", "farthest open joint", 9, move_by(1, 0)); /* more than closes within a step */
  check_notices("links-1-mm", "gain of energy", 9, throw_up(3));
  check_notices("ring-spinning", "growth of the radius", 7, move_by(0.5, 0.5));
  check_notices("ring-spinning", "drift of angular momentum", 0, speed_up(1.1f));
  check_notices("ring-spinning", "drift of energy", 0, speed_up(2));
  check_notices("wrecking-ball-100", "stretch of the chain", 13, move_by(-1, 0));
  CHECK(
      failed(run_documented("springs-1e3-1e9", 9, {}, 20, 19), "largest error of a spring's length")); /* not at rest */
}

TEST_CASE("stability: figures of machines notice what is planted", "[stability]")
{
  check_notices("motor-1e3-against-limit", "beyond the limit at the end", 0, turn_by(Vector::UnitZ(), 1));
  check_notices("motor-against-friction", "error of the speed of the stronger", 0, speed_up(1.5f));
  check_notices("motor-against-friction", "speed of the weaker", 1,
                [](BodyState &state) { state.angular_velocity[2] = 2; });
  check_notices("gear-train-50", "turn that the last wheel lost", 49, turn_by(Vector::UnitZ(), 0.05), 1800);
  check_notices("gear-train-50", "farthest out of mesh", 10, turn_by(Vector::UnitZ(), 0.1));
  check_notices("gear-reduction-1000", "load from where the motor brings it", 4, move_by(0, -0.1));
  check_notices("pulley-1000", "error of the speed", 0, throw_up(1));
  check_notices("pulley-1000", "rope longer by", 1, move_by(0, -0.1));
  check_notices("locked-spin-100", "joint open by", 0, move_by(2, 0));
  check_notices("locked-spin-100", "joint turned by", 0, turn_by(Vector::UnitX(), 0.3));
  check_notices("locked-spin-100", "drift of angular momentum", 0, speed_up(1.01f));
  check_notices("rod-spin-100", "error of the rod's length", 0, move_by(2, 2));
  check_notices("rod-spin-100", "drift of energy", 0, speed_up(1.1f));
  check_notices("vehicle-100", "farthest off the line", 1, move_by(0, 0, 0.5));
  check_notices("vehicle-100", "loss of speed", 1, speed_up(0.9f));
  check_notices("vehicle-100", "chassis up or down by", 1, move_by(0, 0.1));
  check_notices("vehicle-100", "farthest open joint", 3, move_by(0.2, 0));
  check_notices("loop-of-four", "tilt of the bar", 2, turn_by(Vector::UnitZ(), 0.2));
  check_notices("loop-of-four", "gain of energy", 2, throw_up(40));
  check_notices("loop-in-line", "farthest open joint", 2, move_by(0, 0.2));
  check_notices("loop-in-line", "drift of energy", 2, speed_up(1.2f));
  check_notices("pose-1e6", "farthest from the pose", 4, turn_by(Vector::UnitX(), 1));
}

TEST_CASE("stability: figures of conflicts notice what is planted", "[stability]")
{
  check_notices("locked-loop", "farthest from the start", 2, move_by(0, 0.1));
  check_notices("table-of-fixed-joints", "farthest open joint", 3, move_by(0.1, 0));
  check_notices("limits-equal", "largest tilt", 0, turn_by(Vector::UnitZ(), -0.5));
  check_notices("frames-10-m-apart", "fastest", 3, throw_up(50));
  check_notices("ragdolls-from-20-m", "farthest under the ground", 5, move_by(0, -60));
  check_notices("wedged", "farthest from the start", 2, move_by(0, 0.5));
  const auto error_of_break = [](float limit) {
    Trial trial = case_named("breaking-1000").build(Length::quick);
    trial.scene.joints[0].break_force = limit;
    return run("breaking", std::move(trial)).checks.front().figure;
  };
  CHECK(error_of_break(900) == Approx(0.1).margin(0.02));
  CHECK(error_of_break(JointAxis::unlimited) == 1);
}

/* Turns are counted beyond half a turn. */
TEST_CASE("stability: turns about an axis are counted with their whole turns", "[stability]")
{
  Trial trial = trial_of(empty_scene({0, 0, 0}), 120);
  add_body(trial.scene, BodyType::dynamic, sphere_shape(0.5f), {0, 0, 0}).angular_velocity = {0, -20, 0};
  trial.checks.push_back(at_end(check("turned", "rad", 100, turns_about(0, Vector::UnitY()))));
  CHECK(run("turns", trial).checks.front().figure == Approx(-40).epsilon(1e-4));
}

TEST_CASE("stability: a load opens a joint as its softness says", "[stability]")
{
  for (const uint32_t substeps : {4u, 16u}) {
    Trial trial = trial_of(empty_scene(), 300);
    if (substeps != 4) trial.settings = with_stiff_joints(substeps);
    trial.own_passes = true;
    add_body(trial.scene, BodyType::dynamic, sphere_shape(0.1f), {0, 0, 0});
    connect(trial.scene, JointType::ball, no_body, 0, Vector::Zero());
    trial.checks.push_back(at_end(check("open", "m", 1, joint_opening())));
    CHECK(run("softness", trial).checks.front().figure ==
          Approx(standard_gravity * JointSoftness(trial.settings).stretch).epsilon(0.01));
  }
}

/* Solvers without couplings are not run, do not count as failing, and say so; what is known elsewhere has a column. */
TEST_CASE("stability: solvers without couplings refuse the cases that have some", "[stability]")
{
  Results results{"serial", {"soft-step", "avbd"}, Length::brief, {}};
  const Case &which = case_named("pulley-1000");
  for (const std::string &solver : results.solvers)
    results.add(which, which.build(Length::brief).scene, run_case(which, Length::brief, solver, {}),
                results.results.size());
  CHECK(results.results[0].outcome.pass() != Pass::refused);
  CHECK(results.results[1].outcome.pass() == Pass::refused);
  CHECK_FALSE(results.results[1].outcome.passed);
  CHECK(counts_of(results, "avbd").refused == 1);
  CHECK(counts_of(results, "avbd").failed == 0);
  CHECK(text_of(counts_of(results, "avbd")).find(", 1 are refused") != std::string::npos);
  CHECK(results_json(results)["cases"][1]["pass"] == "refused");
  const std::string table = markdown_of(results, "tandem stability");
  CHECK(table.find("| refused |") != std::string::npos);
  results.results.clear();
  const Case &rope = case_named("rope-1800");
  results.add(rope, rope.build(Length::brief).scene, run_case(rope, Length::brief, "soft-step", {}), 0);
  const std::string known = markdown_of(results, "tandem stability");
  CHECK(known.find(" | elsewhere |\n|---|---|---|---|---|---|\n") != std::string::npos);
  CHECK(known.find("| " + rope.elsewhere + " |") != std::string::npos);
  results.results.clear();
  const Case &other = case_named("flip");
  results.add(other, other.build(Length::brief).scene, run_case(other, Length::brief, "avbd", {}), 0);
  CHECK(markdown_of(results, "tandem stability").find("elsewhere") == std::string::npos);
}
#endif
