/* trial.cpp - runs a trial, evaluates its checks and repeats it with documented settings; see trial.h. */
#include "tools/stability/trial.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <new>

#include <fmt/format.h>

#include "host/base/out_of_memory.h"

namespace tandem::stability {
namespace {

constexpr double nothing_seen = -std::numeric_limits<double>::infinity();

/* The value of one check so far, and its history. */
struct Record {
  const Check *check;
  double figure = nothing_seen;
  std::vector<Sample> series;

  void note(const Moment &moment)
  {
    if (moment.time + 1e-9 < check->from) return;
    const double value = check->value(moment);
    series.push_back({moment.time, value});
    const bool lost = std::isnan(figure); /* once NaN, the check has failed for good */
    if (!lost) figure = check->over == Check::Over::last || std::isnan(value) ? value : std::max(figure, value);
  }
  CheckResult result() const
  {
    return {check->what, check->unit, figure, check->bound, std::isfinite(figure) && figure <= check->bound.value,
            series};
  }
};

void note(std::vector<Record> &records, World &world, uint64_t step)
{
  const Moment moment(world, step);
  for (Record &record : records) record.note(moment);
}

std::string names_of(const std::vector<Quarantine> &lost)
{
  std::string text;
  for (size_t i = 0; i < std::min<size_t>(lost.size(), 3); ++i)
    text += fmt::format("{}body {} in step {} ({})", i ? ", " : "", lost[i].body, lost[i].step, lost[i].stage);
  return text + (lost.size() > 3 ? ", ..." : "");
}

void conclude(Outcome &outcome, const std::vector<Record> &records, World &world, uint64_t poisoned)
{
  const uint64_t lost = world.quarantined().size();
  bool passed = lost == poisoned;
  size_t headline = 0;
  for (size_t i = 0; i < records.size(); ++i) {
    outcome.checks.push_back(records[i].result());
    if (!outcome.checks.back().passed && outcome.checks[headline].passed) headline = i;
    passed = passed && outcome.checks.back().passed;
  }
  outcome.passed = passed;
  outcome.headline = outcome.checks.at(headline);
  if (lost != poisoned)
    outcome.note =
        fmt::format("{} bodies stopped being finite, {} expected: {}", lost, poisoned, names_of(world.quarantined()));
  outcome.end = world.bodies();
  outcome.body_hash = world.body_hash();
}

void simulate(Outcome &outcome, std::vector<Record> &records, World &world, const Trial &trial,
              const std::function<void(uint64_t, uint64_t)> &after_step)
{
  using Clock = std::chrono::steady_clock;
  Clock::duration spent{};
  note(records, world, 0);
  for (uint64_t step = 0; step < trial.steps; ++step) {
    if (trial.disturb) trial.disturb(world, step);
    const Clock::time_point start = Clock::now();
    world.step();
    spent += Clock::now() - start;
    outcome.steps = step + 1;
    if (outcome.steps % trial.every == 0 || outcome.steps == trial.steps) note(records, world, outcome.steps);
    if (after_step) after_step(outcome.steps, trial.steps);
    if (world.quarantined().size() > trial.poisoned) break;
  }
  outcome.milliseconds_per_step = std::chrono::duration<double, std::milli>(spent).count() /
                                  static_cast<double>(std::max<uint64_t>(outcome.steps, 1));
}

/* The figure of a failed run is NaN, because no number must pass for it. */
void fail(Outcome &outcome, const Trial &trial, const std::string &why)
{
  const Check &first = trial.checks.front();
  outcome.headline = {first.what, first.unit, std::numeric_limits<double>::quiet_NaN(), first.bound, false, {}};
  outcome.checks = {outcome.headline};
  outcome.passed = false;
  outcome.note = why;
}

} // namespace

Bound Bound::from_rounding(double value, std::string derivation) { return {value, std::move(derivation)}; }
Bound Bound::promised(double value, std::string derivation) { return {value, std::move(derivation)}; }
Bound Bound::from_theory(double value, std::string derivation)
{
  Bound bound{value, std::move(derivation)};
  bound.source = "theory";
  return bound;
}

bool CheckResult::loose() const { return bound.derivation.empty() && bound.value > 10 * figure; }

Pass Outcome::pass() const
{
  if (refused) return Pass::refused;
  if (!passed) return Pass::failed;
  if (!by_default) return Pass::by_default;
  return documented_solver.empty() ? Pass::with_setting : Pass::with_solver;
}

Moment::Moment(World &world, uint64_t step)
    : world(world), step(step), time(static_cast<double>(step) * static_cast<double>(world.settings().step)),
      bodies(world.bodies())
{}

const Statistics &Moment::statistics() const
{
  if (!statistics_) statistics_ = world.statistics();
  return *statistics_;
}

std::string reported_name(const Case &which, Length length)
{
  if (length == Length::brief) return which.name + "-brief";
  return length == Length::quick && which.shorter ? which.name + "-short" : which.name;
}

Settings settings_of(const Trial &trial, const std::string &solver)
{
  const Settings own = settings_for(parse_setting<Solver>(solver));
  Settings settings = trial.settings;
  settings.solver = own.solver;
  if (trial.own_passes) return settings;
  settings.substeps = own.substeps;
  settings.iterations = own.iterations;
  return settings;
}

Outcome run_trial(const std::string &name, const Trial &trial, const std::string &solver, const Placement &placement,
                  const std::function<void(uint64_t done, uint64_t of)> &after_step)
{
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  Outcome outcome;
  outcome.name = name;
  outcome.solver = solver;
  const Settings settings = settings_of(trial, solver);
  outcome.settings = settings_text(settings);
  std::vector<Record> records;
  for (const Check &check : trial.checks) records.push_back({&check, nothing_seen, {}});
  try {
    World world(trial.scene, settings, placement);
    simulate(outcome, records, world, trial, after_step);
    conclude(outcome, records, world, trial.poisoned);
  } catch (const std::bad_alloc &) {
    throw; /* says nothing about the case */
  } catch (const OutOfMemory &) {
    throw;
  } catch (const std::exception &error) {
    fail(outcome, trial, error.what());
  }
  outcome.milliseconds = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  return outcome;
}

namespace {

/* The trial with the settings that the case documents for this solver; nothing if it documents none. Its figures are
 * new and have observed nothing. */
std::optional<Trial> documented_trial(const Case &which, Length length, const std::string &solver)
{
  Trial trial = which.build(length);
  if (!trial.documented_solver.empty() && solver == name_of(Settings{}.solver)) {
    /* Only the default solver chooses its substeps. */
    if (trial.settings.substeps == automatic_substeps) trial.settings.substeps = Settings{}.substeps;
    return trial;
  }
  if (!trial.documented) return std::nullopt;
  const Settings own = settings_for(parse_setting<Solver>(solver));
  trial.settings = *trial.documented;
  trial.settings.substeps = std::max(trial.settings.substeps, own.substeps);
  trial.settings.iterations = std::max(trial.settings.iterations, own.iterations);
  trial.own_passes = true;
  trial.documented_solver.clear();
  return trial;
}

/* For example "solver direct" or "substeps 16, contact_hertz 192". */
std::string documented_text(const Trial &trial, const Outcome &outcome)
{
  if (trial.documented_solver.empty()) return outcome.settings;
  return "solver " + trial.documented_solver + (outcome.settings == "default" ? "" : ", " + outcome.settings);
}

Outcome run_as_documented(const Case &which, Length length, const Placement &placement, Outcome first,
                          const std::function<void(uint64_t done, uint64_t of)> &after_step)
{
  const std::optional<Trial> trial = documented_trial(which, length, first.solver);
  if (!trial) return first;
  Outcome second =
      run_trial(first.name, *trial, trial->documented_solver.empty() ? first.solver : trial->documented_solver,
                placement, after_step);
  second.settings = documented_text(*trial, second);
  second.milliseconds += first.milliseconds;
  if (!second.passed) {
    first.note += fmt::format("{}fails with {} too", first.note.empty() ? "" : "; ", second.settings);
    first.milliseconds = second.milliseconds;
    return first;
  }
  second.documented_solver = trial->documented_solver;
  second.solver = first.solver;
  second.by_default = first.headline;
  second.note = fmt::format("with {}; by default {:.3g} {} ({})", second.settings, first.headline.figure,
                            first.headline.unit, first.headline.what);
  return second;
}

} // namespace

bool refuses(const std::string &solver, const Trial &trial)
{
  return !trial.scene.couplings.empty() && !solves_couplings(settings_of(trial, solver).solver);
}

namespace {

Outcome refused_outcome(const std::string &name, const Trial &trial, const std::string &solver)
{
  Outcome outcome;
  outcome.name = name;
  outcome.solver = solver;
  outcome.settings = settings_text(settings_of(trial, solver));
  fail(outcome, trial, "has no couplings");
  outcome.refused = true;
  return outcome;
}

} // namespace

Outcome run_case(const Case &which, Length length, const std::string &solver, const Placement &placement,
                 const std::function<void(uint64_t done, uint64_t of)> &after_step)
{
  Trial trial = which.build(length);
  if (refuses(solver, trial)) return refused_outcome(reported_name(which, length), trial, solver);
  Outcome first = run_trial(reported_name(which, length), trial, solver, placement, after_step);
  if (first.passed || length == Length::brief) return first;
  return run_as_documented(which, length, placement, std::move(first), after_step);
}

std::string settings_text(const Settings &settings)
{
  const Settings defaults = settings_for(settings.solver);
  std::string text;
  const auto add = [&](const char *name, auto value, auto standard) {
    if (value != standard)
      text += fmt::format("{}{} {:.6g}", text.empty() ? "" : ", ", name, static_cast<double>(value));
  };
  add("dt", settings.step, defaults.step);
  if (settings.substeps == automatic_substeps) text += text.empty() ? "substeps auto" : ", substeps auto";
  else add("substeps", settings.substeps, defaults.substeps);
  add("iterations", settings.iterations, defaults.iterations);
  add("contact_hertz", settings.contact_hertz, defaults.contact_hertz);
  add("contact_damping_ratio", settings.contact_damping_ratio, defaults.contact_damping_ratio);
  add("joint_hertz", settings.joint_hertz, defaults.joint_hertz);
  add("joint_damping_ratio", settings.joint_damping_ratio, defaults.joint_damping_ratio);
  add("push_speed", settings.push_speed, defaults.push_speed);
  add("slop", settings.slop, defaults.slop);
  add("slop_share", settings.slop_share, defaults.slop_share);
  add("restitution_speed", settings.restitution_speed, defaults.restitution_speed);
  return text.empty() ? "default" : text;
}

} // namespace tandem::stability
