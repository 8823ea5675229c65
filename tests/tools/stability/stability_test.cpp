/* stability_test.cpp - the cases of `tandem stability` can pass, and every figure can fail.
 *
 * A check that cannot fail is a defect: each figure is given a wrong motion, planted by hand, and must exceed its
 * bound. All cases run with the default solver, and all run at full length but those that have a shorter form, which
 * take minutes together.
 */
#ifdef TANDEM_COMMAND
#include <limits>
#include <map>
#include <set>

#include "host/catalog/catalog.h"
#include "host/catalog/structures.h"
#include "tests/catch.h"
#include "tests/tools/stability/planted.h"
#include "tools/stability/batch.h"
#include "tools/stability/cases.h"
#include "tools/stability/counts.h"
#include "tools/stability/flip.h"
#include "tools/stability/picture.h"
#include "tools/stability/results.h"
#include "tools/stability/table.h"

using namespace tandem;
using namespace tandem::stability;

TEST_CASE("stability: at least 30 cases, each with its name, sentence, criterion, figure and bound", "[stability]")
{
  std::set<std::string> names;
  for (const Case &each : all_cases()) {
    INFO(each.name);
    CHECK(names.insert(each.name).second);
    CHECK(each.what.size() > 10);
    CHECK(each.criterion.size() > 10);
    const Trial trial = each.build(Length::brief);
    CHECK(trial.steps <= 20);
    CHECK(trial.scene.bodies.size() < 700);
    REQUIRE_FALSE(trial.checks.empty());
    for (const Check &check : trial.checks) CHECK((check.bound.value >= 0 && !check.what.empty() && check.value));
  }
  CHECK(names.size() >= 30);
}

TEST_CASE("stability: a shortened case says so in its name", "[stability]")
{
  CHECK(reported_name(case_named("pyramid-80"), Length::full) == "pyramid-80");
  CHECK(reported_name(case_named("pyramid-80"), Length::quick) == "pyramid-80-short");
  CHECK(reported_name(case_named("flip"), Length::quick) == "flip");
  for (const Case &each : all_cases()) {
    const Trial full = each.build(Length::full), quick = each.build(Length::quick);
    INFO(each.name);
    CHECK(each.shorter == (quick.steps != full.steps || quick.scene.bodies.size() != full.scene.bodies.size()));
  }
}

namespace {

/* Minutes at full length, even for the default solver; all others take seconds together. */
bool is_long(const Case &which) { return which.shorter && which.name.find("column") == std::string::npos; }

std::vector<const Case *> cases_of(const std::string &group)
{
  std::vector<const Case *> cases;
  for (const Case &each : all_cases())
    if (each.group == group) cases.push_back(&each);
  REQUIRE_FALSE(cases.empty());
  return cases;
}

Results run_group(const std::string &group, bool long_ones)
{
  Batch batch;
  for (const Case *each : cases_of(group))
    if (is_long(*each) == long_ones) batch.cases.push_back(each);
  batch.solvers = {choice_names<Solver>().front()};
  batch.placement = {"tbb:threads=2", {}, false};
  batch.length = long_ones ? Length::quick : Length::full;
  batch.at_once = 2;
  return run_batch(batch, {});
}

void check_passed(const Results &results)
{
  for (const Result &result : results.results) {
    INFO(result.outcome.name << ": " << result.outcome.headline.what << " " << result.outcome.headline.figure << " "
                             << result.outcome.headline.unit << ", bound " << result.outcome.headline.bound.value
                             << "; " << result.outcome.note);
    CHECK(result.outcome.passed == result.which.fails_because.empty()); /* what passes again must say so */
  }
}

/* A case passes with the default solver, by default or as it documents, and could not get ten times worse unseen. */
void check_group(const std::string &group)
{
  const Results results = run_group(group, false);
  check_passed(results);
  INFO(bounds_text(results));
  CHECK(loose_bounds(results, results.solvers.front()) == 0);
}

} // namespace

/* There is one test for each group, so that each is an entry of its own and a failure names its group. */
TEST_CASE("stability: mass ratios pass within bounds that are not loose", "[stability]") { check_group("mass ratio"); }
TEST_CASE("stability: stacks pass within bounds that are not loose", "[stability]") { check_group("stacks"); }
TEST_CASE("stability: settings pass within bounds that are not loose", "[stability]") { check_group("settings"); }
TEST_CASE("stability: spins pass within bounds that are not loose", "[stability]") { check_group("spin"); }
TEST_CASE("stability: motions pass within bounds that are not loose", "[stability]") { check_group("motion"); }
TEST_CASE("stability: scales pass within bounds that are not loose", "[stability]") { check_group("scale"); }
TEST_CASE("stability: degenerate starts pass within bounds that are not loose", "[stability]")
{
  check_group("degenerate");
}
TEST_CASE("stability: chains pass within bounds that are not loose", "[stability]") { check_group("chains"); }
TEST_CASE("stability: machines pass within bounds that are not loose", "[stability]") { check_group("machines"); }
TEST_CASE("stability: conflicts pass within bounds that are not loose", "[stability]") { check_group("conflicts"); }
TEST_CASE("stability: long chains pass when shortened", "[stability]") { check_passed(run_group("chains", true)); }
TEST_CASE("stability: falling people pass when shortened", "[stability]")
{
  check_passed(run_group("conflicts", true));
}
TEST_CASE("stability: what misses goes on", "[stability]") { check_group("what misses goes on"); }
TEST_CASE("stability: what hits is stopped", "[stability]") { check_group("what hits is stopped"); }
TEST_CASE("stability: pyramids pass when shortened", "[stability]") { check_passed(run_group("stacks", true)); }
TEST_CASE("stability: crowds pass when shortened", "[stability]") { check_passed(run_group("degenerate", true)); }

TEST_CASE("stability: the groups are the ones that have a test", "[stability]")
{
  const std::set<std::string> tested{
      "mass ratio",           "stacks", "settings", "spin",     "motion", "scale", "degenerate", "what misses goes on",
      "what hits is stopped", "chains", "machines", "conflicts"};
  std::set<std::string> groups;
  for (const Case &each : all_cases()) groups.insert(each.group);
  CHECK(groups == tested);
}

/* Two cases of one scene and one set of settings would end in the same bits: settings that clamp made five cases
 * one. */
TEST_CASE("stability: no two cases are one", "[stability]")
{
  std::map<uint64_t, std::string> seen;
  for (const Case &each : all_cases()) {
    const Outcome outcome = run(each.name, Length::brief);
    INFO(each.name << " and " << seen[outcome.body_hash]);
    REQUIRE_FALSE(outcome.end.empty());
    CHECK(seen[outcome.body_hash].empty());
    seen[outcome.body_hash] = each.name;
  }
}

TEST_CASE("stability: a bound of more than ten times its figure is loose, unless it states a derivation", "[stability]")
{
  const auto result = [](double figure, Bound bound) {
    return CheckResult{"figure", "m", figure, std::move(bound), true, {}};
  };
  CHECK_FALSE(result(1, 10.0).loose());
  CHECK(result(1, 10.1).loose());
  CHECK(result(0, 1e-9).loose());
  CHECK_FALSE(result(0, 0.0).loose());
  CHECK_FALSE(result(0, Bound::from_rounding(1e-9, "spacing of floats")).loose());
  CHECK(result(0, Bound::from_rounding(1e-9, "")).loose());
}

TEST_CASE("stability: the list of bounds says which are loose, and where a figure and its bound are both nothing",
          "[stability]")
{
  Results results;
  Result &row = results.results.emplace_back();
  row.outcome.name = "case";
  row.outcome.solver = "soft-step";
  const auto line_of = [&](double figure, double bound) {
    row.outcome.checks = {{"figure", "m", figure, bound, true, {}}};
    return bounds_text(results);
  };
  CHECK(line_of(0, 0).find("ratio exact") != std::string::npos);
  CHECK(line_of(2, 5).find("ratio 2.5 ") != std::string::npos);
  CHECK(line_of(2, 5).find("LOOSE") == std::string::npos);
  CHECK(line_of(1, 20).find("ratio 20        LOOSE") != std::string::npos);
  CHECK(line_of(0, 1).find("ratio inf       LOOSE") != std::string::npos);
}

/* Its substeps too: with those of the defaults the twin of a solver that has one substep was another motion. */
TEST_CASE("stability: the twin of a far scene moves as the settings of the trial say", "[stability]")
{
  for (const std::string &solver : choice_names<Solver>()) {
    const Outcome outcome =
        run_trial("far", case_named("far-20-km").build(Length::quick), solver, Placement{"serial", {}, false});
    INFO(solver << ": " << outcome.headline.figure << " m, bound " << outcome.headline.bound.value);
    CHECK_FALSE(failed(outcome, "difference from the origin"));
  }
}

TEST_CASE("stability: contacts just below the limit differ from those at it", "[stability]")
{
  Trial trial = case_named("stiffness-600000-clamped").build(Length::quick);
  trial.settings.contact_hertz = float(0.95 * stiffest(trial.settings));
  CHECK(failed(run("below the limit", std::move(trial)), "difference from contacts at the limit"));
}

/* A trial without collisions: a body that should hit passes, and this must be reported. */
TEST_CASE("stability: figures of movers notice one that is let through, slowed or driven", "[stability]")
{
  const auto unhindered = [](const char *name) {
    Trial trial = case_named(name).build(Length::full);
    for (Body &body : trial.scene.bodies) body.filter_mask = 0;
    return run(name, std::move(trial));
  };
  const auto scaled = [](float factor) { return [factor](BodyState &state) { state.linear_velocity[0] *= factor; }; };
  CHECK(failed(unhindered("hit-ball-wall"), "got beyond the wall by"));
  CHECK(failed(unhindered("hit-hull-sheet"), "got beyond the wall by"));
  CHECK(failed(unhindered("graze-ball-edge"), "share of the velocity that is as it was"));
  CHECK(failed(run_pushed("graze-ball-edge", 1, scaled(1.001f), 12, 1), "largest gain of kinetic energy"));
  CHECK_FALSE(failed(unhindered("miss-ball-edge"), "largest loss of kinetic energy"));
  Trial slowed = case_named("miss-ball-edge").build(Length::full);
  for (Body &body : slowed.scene.bodies) body.filter_mask = 0;
  slowed.disturb = [&](World &world, uint64_t step) {
    if (step != 5) return;
    BodyState state = world.bodies()[1];
    scaled(0.999f)(state);
    world.set_body_unchecked(1, state);
  };
  CHECK(failed(run("slowed", std::move(slowed)), "largest loss of kinetic energy"));
}

TEST_CASE("stability: what passes only as documented counts apart, and shows what failed by default", "[stability]")
{
  const std::string solver = choice_names<Solver>().front();
  Results results{"serial", {solver}, Length::quick, {}};
  for (const char *name : {"heavy-on-light-10", "heavy-on-light-1000", "doubling-up", "incline"}) {
    const Case &which = case_named(name);
    Outcome outcome = run_case(which, Length::quick, solver, {});
    if (std::string(name) == "incline") outcome.passed = false;
    results.add(which, which.build(Length::quick).scene, std::move(outcome), results.results.size());
  }
  const Counts counts = counts_of(results, solver);
  CHECK(counts.by_default == 1);
  CHECK(counts.with_setting == 1);
  CHECK(counts.with_solver == 1);
  CHECK(counts.failed == 1);
  const std::string said = "1 pass by default, 1 only with a documented setting, 1 with a documented solver, 1 fail";
  CHECK(text_of(counts) == said);
  const Json json = results_json(results);
  CHECK(json["counts"][solver]["with_setting"] == 1);
  CHECK(json["cases"][0]["by_default"].is_null());
  CHECK(json["cases"][1]["pass"] == "documented setting");
  CHECK(json["cases"][1]["by_default"]["figure"].get<double>() > 0.5);
  CHECK(json["cases"][2]["pass"] == "documented solver");
  CHECK(results_page(results, "tandem stability").find(said) != std::string::npos);
  const std::string table = markdown_of(results, "tandem stability");
  CHECK(table.find(said) != std::string::npos);
  CHECK(table.find("solver direct; by default FAIL 2.") != std::string::npos);
}

TEST_CASE("stability: 'it stands' notices a box that is knocked out, tilted, or pressed into another", "[stability]")
{
  const auto pyramid = [](uint32_t body, const std::function<void(BodyState &)> &push) {
    Trial trial = trial_of(load_scene("pyramid:rows=5"), 60);
    add_standing(trial, {0.05, 0.1, 0.25, 0.1});
    trial.disturb = [=](World &world, uint64_t step) {
      if (step != 20) return;
      BodyState state = world.bodies()[body];
      push(state);
      world.set_body(body, state);
    };
    return run("pyramid", std::move(trial));
  };
  CHECK(pyramid(8, [](BodyState &) {}).passed);
  const Outcome knocked = pyramid(8, [](BodyState &state) { state.position[2] += 3; });
  CHECK_FALSE(knocked.passed);
  CHECK(failed(knocked, "farthest sideways"));
  CHECK(failed(pyramid(15, [](BodyState &state) { state.orientation = turn_about({0, 0, 1}, 0.5); }), "largest tilt"));
  CHECK(failed(pyramid(15, [](BodyState &state) { state.position[1] -= 0.2f; }), "deepest contact"));
  Trial restless = trial_of(load_scene("pyramid:rows=2"), 30);
  add_standing(restless, {});
  restless.disturb = [](World &world, uint64_t step) {
    BodyState state = world.bodies()[3];
    state.linear_velocity = {0, 0, step % 2 ? 0.5f : -0.5f};
    world.set_body(3, state);
  };
  CHECK(failed(run("restless", std::move(restless)), "fastest at the end"));
}

TEST_CASE("stability: figures of conservation and of closed forms notice what is planted", "[stability]")
{
  const auto faster = [](BodyState &state) {
    for (float &v : state.linear_velocity) v *= 1.1f;
    for (float &w : state.angular_velocity) w *= 1.1f;
  };
  const auto moved = [](BodyState &state) { state.position[0] += 0.05f; };
  CHECK(failed(run_pushed("flip", 0, faster), "drift of angular momentum"));
  CHECK(failed(run_pushed("flip", 0, faster), "drift of energy"));
  CHECK(failed(run_pushed(
                   "flip", 0,
                   [](BodyState &state) {
                     state.angular_velocity = {0, 4, 0};
                   },
                   300),
               "error of the time between flips"));
  CHECK(failed(run_pushed("flight", 0, moved), "distance from the parabola"));
  CHECK(failed(run_pushed(
                   "closed-system", 5, [](BodyState &state) { state.linear_velocity[1] += 3; }, 30),
               "drift of momentum"));
  CHECK(failed(run_pushed(
                   "closed-system", 5, [](BodyState &state) { state.angular_velocity[1] += 9; }, 30),
               "drift of angular momentum"));
  CHECK(failed(run_pushed(
                   "closed-system", 5, [](BodyState &state) { state.linear_velocity[1] += 3; }, 30),
               "gain of energy"));
  CHECK(failed(run_pushed(
                   "restitution", 7, [](BodyState &state) { state.linear_velocity[1] -= 0.3f; }, 90),
               "largest error of the height"));
  CHECK(failed(run_pushed("elastic", 1, faster, 60, 30), "drift of energy"));
  CHECK(failed(run_pushed("sliding-stop", 3, faster, 300, 2), "largest error of the way to rest"));
  CHECK(failed(run_pushed("rolling-ball", 1, faster, 300, 2), "error of the rolling speed"));
  CHECK(failed(run_pushed(
                   "rolling-ball", 1, [](BodyState &state) { state.angular_velocity[2] += 1; }, 120, 119),
               "slip of the contact"));
  CHECK(failed(run_pushed("incline", 5, faster, 120, 60), "largest error of the way down"));
  CHECK(failed(run_pushed(
                   "top", 1,
                   [](BodyState &state) {
                     state.orientation = turn_about({1, 0, 0}, 2);
                   },
                   120),
               "change of the lean"));
  CHECK(failed(run_pushed(
                   "top", 1, [](BodyState &state) { state.linear_velocity[1] += 5; }, 12),
               "gain of energy"));
}

TEST_CASE("stability: figures of passage, of falling and of scale notice what is planted", "[stability]")
{
  CHECK(failed(run_pushed(
                   "bullet-thin-wall", 1, [](BodyState &state) { state.position[0] = 0.5f; }, 20),
               "got beyond the wall by"));
  CHECK(failed(run_pushed(
                   "bullet-against-stack", 6, [](BodyState &state) { state.position[0] = 1; }, 12),
               "bullet past the box it hit by"));
  CHECK(failed(run_pushed(
                   "dominoes", 30, [](BodyState &state) { state.position[0] += 20; }, 240),
               "dominoes left upright"));
  CHECK(failed(run_pushed(
                   "wall-hit", 3, [](BodyState &state) { state.position[1] = -2; }, 12),
               "farthest under the ground"));
  CHECK(failed(run_pushed(
                   "far-1-km", 6, [](BodyState &state) { state.position[2] += 0.1f; }, 12),
               "difference from the origin"));
  CHECK(failed(run_pushed(
                   "seams", 24, [](BodyState &state) { state.linear_velocity[0] = 4; }, 12, 2),
               "loss of speed"));
  CHECK(failed(run_pushed(
                   "gravity-0", 5, [](BodyState &state) { state.linear_velocity[0] = 0.01f; }, 12, 2),
               "farthest from the start"));
  CHECK(failed(
      run_pushed(
          "boxes-in-one-place", 3, [](BodyState &state) { state.linear_velocity[1] = 500; }, 5, 1, Length::brief),
      "gain of energy"));
  CHECK(failed(
      run_pushed(
          "boxes-in-one-place", 3, [](BodyState &state) { state.linear_velocity[1] = 500; }, 5, 1, Length::brief),
      "fastest"));
}

/* Else the decades of stiffness would all be one case: contacts no deeper than the slop have none. */
TEST_CASE("stability: contact stiffness shows in its cases", "[stability]")
{
  const auto left = [](const char *name) {
    Trial trial = case_named(name).build(Length::quick);
    trial.steps = 60;
    return run(name, std::move(trial)).checks.front().figure;
  };
  CHECK(left("stiffness-0.6") > 1.2 * left("stiffness-6"));
  CHECK(left("stiffness-6") > 1.2 * left("stiffness-24"));
  CHECK(left("stiffness-24") > 1.2 * left("stiffness-600"));
}

/* One ramp of each coefficient a degree too steep, or all boxes stuck, must move the angle of slip. */
TEST_CASE("stability: the friction cone's figure notices another coefficient", "[stability]")
{
  Trial trial = case_named("friction-cone").build(Length::quick);
  for (Material &material : trial.scene.materials)
    if (material.static_friction == 0.5f) material.static_friction = material.dynamic_friction = 0.55f;
  const Outcome outcome = run("friction-cone", std::move(trial));
  CHECK(failed(outcome, "largest error of the angle of slip"));
  CHECK(outcome.headline.figure == Approx(std::atan(0.55) * 180 / pi - std::atan(0.5) * 180 / pi).margin(0.3));
}

TEST_CASE("stability: a lost body fails a case, unless the case poisoned it", "[stability]")
{
  const auto poison = [](BodyState &state) { state.linear_velocity[0] = std::numeric_limits<float>::quiet_NaN(); };
  const Outcome lost = run_pushed("heavy-on-light-10", 1, poison, 30);
  CHECK_FALSE(lost.passed);
  CHECK(lost.note.find("body 1 in step 10") != std::string::npos);
  CHECK(lost.steps < 30);
  Trial unharmed = case_named("poisoned").build(Length::brief);
  CHECK(run("poisoned", case_named("poisoned").build(Length::brief)).passed);
  unharmed.disturb = nullptr;
  CHECK_FALSE(run("poisoned", std::move(unharmed)).passed); /* the quarantine it expects did not happen */
}

TEST_CASE("stability: a figure that is not a number passes no bound, then or later", "[stability]")
{
  Trial trial = trial_of(column_of({1}), 5);
  trial.checks.push_back(
      check("number", "", 10, [](const Moment &moment) { return moment.step == 2 ? std::nan("") : 1.0; }));
  CHECK_FALSE(run("nan", trial).passed);
  trial.checks.front().value = [](const Moment &) { return 1.0; };
  CHECK(run("number", trial).passed);
  trial.checks.front().value = [](const Moment &moment) { return moment.step == 3 ? 11.0 : 1.0; };
  CHECK_FALSE(run("peak", trial).passed);
  trial.checks.front().over = Check::Over::last;
  CHECK(run("peak past", trial).passed);
}

TEST_CASE("stability: what a solver or device throws is a failed outcome that says why", "[stability]")
{
  Trial trial = trial_of(column_of({1}), 5);
  add_standing(trial, {});
  trial.disturb = [](World &, uint64_t) { throw std::runtime_error("out of luck"); };
  const Outcome outcome = run("thrown", std::move(trial));
  CHECK_FALSE(outcome.passed);
  CHECK(outcome.note == "out of luck");
  CHECK(std::isnan(outcome.headline.figure));
}

TEST_CASE("stability: documented settings are tried only where the default ones fail, and are named", "[stability]")
{
  const auto with_bound = [](double bound, bool documented) {
    Case made{"bounded", "test", "a cube", "at rest", {}};
    made.build = [=](Length) {
      Trial trial = trial_of(column_of({1}), 5);
      trial.checks.push_back(check("one over the substeps", "", bound,
                                   [](const Moment &moment) { return 1.0 / moment.world.settings().substeps; }));
      if (documented) {
        trial.documented = trial.settings;
        trial.documented->substeps = 50;
      }
      return trial;
    };
    return run_case(made, Length::quick, choice_names<Solver>().front(), Placement{"serial", {}, false});
  };
  CHECK(with_bound(1, true).pass() == Pass::by_default);
  CHECK(with_bound(1, true).settings == "default");
  CHECK_FALSE(with_bound(0.03, false).passed);
  const Outcome helped = with_bound(0.03, true);
  CHECK(helped.passed);
  CHECK(helped.by_default);
  CHECK(helped.settings == "substeps 50");
  CHECK(helped.note.find("by default 0.2") != std::string::npos);
  const Outcome beyond = with_bound(0.001, true);
  CHECK_FALSE(beyond.passed);
  CHECK(beyond.settings == "default");
  CHECK(beyond.note.find("fails with substeps 50 too") != std::string::npos);
}

TEST_CASE("stability: a documented solver is tried where the default solver fails, and nowhere else", "[stability]")
{
  const std::string standard = choice_names<Solver>().front();
  const auto depth = [](const std::string &solver, const std::string &documented) {
    Case made{"doubled", "test", "a column that doubles", "carried", {}};
    made.build = [=](Length length) {
      Trial trial = case_named("doubling-up").build(length);
      trial.steps = 60;
      trial.documented_solver = documented;
      return trial;
    };
    return run_case(made, Length::quick, solver, Placement{"serial", {}, false});
  };
  const Outcome alone = depth(standard, ""), helped = depth(standard, "direct"), other = depth("pgs", "direct"),
                wrong = depth(standard, "pgs");
  CHECK_FALSE(alone.passed);
  CHECK(helped.passed);
  CHECK(helped.by_default);
  CHECK(helped.solver == standard);
  CHECK(helped.settings == "solver direct");
  CHECK(helped.body_hash == depth("direct", "").body_hash);
  CHECK(helped.note.find("with solver direct; by default") != std::string::npos);
  CHECK(helped.milliseconds > 60 * helped.milliseconds_per_step);
  CHECK_FALSE(other.passed);
  CHECK(other.note.find("direct") == std::string::npos);
  CHECK_FALSE(wrong.passed);
  CHECK(wrong.settings == "default");
  CHECK(wrong.note.find("fails with solver pgs too") != std::string::npos);
  CHECK(case_named("doubling-up").build(Length::full).documented_solver == "direct");
}

TEST_CASE("stability: cases side by side give what they give one at a time, in the same order", "[stability]")
{
  Batch batch;
  for (const char *name : {"dominoes", "flip", "heavy-on-light-1000", "boxes-in-one-place", "far-1-km", "rolling-ball"})
    batch.cases.push_back(&case_named(name));
  batch.solvers = {"soft-step", "direct", "jacobi"};
  batch.length = Length::brief;
  std::vector<size_t> sizes;
  const auto json_of = [&](size_t at_once, const char *backend) {
    batch.at_once = at_once;
    batch.placement.on = backend;
    sizes.clear();
    Json json = results_json(run_batch(batch, [&](const Results &so_far) {
      sizes.push_back(so_far.results.size());
      CHECK(so_far.complete() == (so_far.results.size() == 18));
      CHECK(results_json(so_far)["complete"] == so_far.complete());
      CHECK(std::is_sorted(so_far.results.begin(), so_far.results.end(),
                           [](const Result &a, const Result &b) { return a.place < b.place; }));
    }));
    CHECK(json["ms"].get<double>() > 0);
    json.erase("ms");
    json.erase("backend");
    for (Json &each : json["cases"])
      for (const char *time : {"ms", "ms_per_step"}) each.erase(time);
    REQUIRE(sizes.size() == 18);
    for (size_t k = 0; k < sizes.size(); ++k) CHECK(sizes[k] == k + 1);
    return json;
  };
  const Json one_by_one = json_of(1, "serial");
  CHECK(one_by_one["cases"][1]["name"] == "dominoes-brief");
  CHECK(one_by_one["cases"][1]["solver"] == "direct");
  CHECK(json_of(4, "serial") == one_by_one);
  CHECK(json_of(4, "tbb") == one_by_one);
}

/* Theory against theory: the small-amplitude limit of steady precession, m g d / (I W), and the integral's known
 * value. */
TEST_CASE("stability: theory of the top and of the flip", "[stability]")
{
  const double half = 0.1, spin = 1000, lean = 0.3;
  CHECK(steady_precession(half, spin, lean, 10) ==
        Approx(10 * half * std::sqrt(3.0) / (2.0 / 3 * half * half * spin)).epsilon(2e-3));
  CHECK(std::isnan(steady_precession(half, 1, lean, 10)));
  const Vector moments(1, 2, 3);
  CHECK(flip_interval(moments, {1e-3, 1, 0}) >
        2 * flip_interval(moments, {0.2, 1, 0})); /* the slower the nearer to the unstable axis */
}

TEST_CASE("stability: the page and the JSON hold every case", "[stability]")
{
  Results results{"serial", {choice_names<Solver>().front()}, Length::brief, {}};
  for (const char *name : {"heavy-on-light-10", "boxes-in-one-place", "far-1000-km"}) {
    results.add(case_named(name), case_named(name).build(Length::brief).scene,
                run_case(case_named(name), Length::brief, results.solvers.front(), {}), results.results.size());
  }
  const Json json = results_json(results);
  REQUIRE(json["cases"].size() == 3);
  for (const Json &each : json["cases"])
    for (const char *key : {"name", "solver", "passed", "figure", "bound", "unit", "ms"}) CHECK(each.contains(key));
  const std::string page = results_page(results, "tandem stability");
  for (const char *said : {"heavy-on-light-10", "far-1000-km", "<polygon", "bound", "tandem stability"})
    CHECK(page.find(said) != std::string::npos);
  CHECK(page.find("nan") == std::string::npos);
  CHECK(page.find("http") == page.find("http://www.w3.org")); /* opens offline: a name space at most */
  CHECK(series_csv(results).find("heavy-on-light-10-brief") != std::string::npos);
}

TEST_CASE("stability: pictures show a box as a hexagon and a ball as a circle, and skip what is not finite",
          "[stability]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 0.5f, 0});
  add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {2, 0.5f, 0});
  std::vector<BodyState> states = states_of(scene.bodies);
  const Window window = window_of(scene.shapes, scene.bodies, states);
  const std::string svg = svg_of(scene.shapes, scene.bodies, states, window, "start");
  const size_t polygon = svg.find("points=\"");
  REQUIRE(polygon != std::string::npos);
  const std::string points = svg.substr(polygon, svg.find('"', polygon + 8) - polygon);
  CHECK(std::count(points.begin(), points.end(), ',') == 6);
  CHECK(svg.find("<circle") != std::string::npos);
  CHECK(svg.find("class=\"ground\"") != std::string::npos);
  states[1].position[0] = std::numeric_limits<float>::quiet_NaN();
  CHECK(svg_of(scene.shapes, scene.bodies, states, window, "end").find("<polygon") == std::string::npos);
}

TEST_CASE("stability: pictures show cylinders and hulls by their outline, where the body has its shape", "[stability]")
{
  Scene scene = empty_scene();
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 0.5f}};
  add_body(scene, BodyType::dynamic, hull_shape(points, "wedge"), {0, 0, 0});
  const Window window = window_of(scene.shapes, scene.bodies, states_of(scene.bodies));
  const std::string svg = svg_of(scene.shapes, scene.bodies, states_of(scene.bodies), window, "hull");
  const size_t polygon = svg.find("points=\"");
  REQUIRE(polygon != std::string::npos);
  const std::string drawn = svg.substr(polygon, svg.find('"', polygon + 8) - polygon);
  CHECK(std::count(drawn.begin(), drawn.end(), ',') == 4); /* the tip, in front, hides a corner of the base */
  scene.bodies[0].shape_position = {100, 0, 0};
  CHECK(svg_of(scene.shapes, scene.bodies, states_of(scene.bodies), window, "moved").find("<polygon") ==
        std::string::npos);
  const Window after = window_of(scene.shapes, scene.bodies, states_of(scene.bodies));
  CHECK(after.left > 90);
  CHECK(svg_of(scene.shapes, scene.bodies, states_of(scene.bodies), after, "seen").find("<polygon") !=
        std::string::npos);
}

/* Parity holds in every case, also where a solver fails it: here the first case of each group with every solver, all
 * with the default one. `tandem stability --between` compares all of them, and OpenCL devices. */
TEST_CASE("stability: every case ends in the same bits on serial and tbb", "[stability][parity]")
{
  std::set<std::string> groups;
  for (const Case &each : all_cases()) {
    const bool first = groups.insert(each.group).second;
    for (const std::string &solver : choice_names<Solver>()) {
      if (!first && solver != choice_names<Solver>().front()) continue;
      INFO(each.name << " " << solver);
      const Outcome serial = run_trial(each.name, each.build(Length::brief), solver, Placement{"serial", {}, false});
      const Outcome lanes = run_trial(each.name, each.build(Length::brief), solver, Placement{"tbb", {}, false});
      CHECK(serial.body_hash == lanes.body_hash);
      CHECK(serial.note == lanes.note);
      CHECK(serial.steps == lanes.steps);
    }
  }
}
#endif
