/* trial.h - what a stability case is, and how one is run.
 *
 *   Case --build(length)--> Trial {scene, settings, steps, checks} --run_trial(solver, backend)--> Outcome
 *
 * A case states in figures what "stable" means: each check reads one figure from the moving bodies, in
 * double precision, and passes while that stays at or below its bound. What a check compares with is a closed
 * form, a conserved quantity, the start of the scene, or a bound on energy; never an earlier result of ours.
 * A figure that is not finite fails, and so does a body that stopped being finite where none was poisoned.
 */
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tandem/world.h>

namespace tandem::stability {

/* What a check may look at, after a step (and once before the first, at time 0). */
class Moment {
public:
  Moment(World &world, uint64_t step);
  World &world;
  uint64_t step;                 /* steps done */
  double time;                   /* s */
  std::vector<BodyState> bodies; /* in the order of Scene::bodies */
  const Scene &scene() const { return world.scene(); }
  const Statistics &statistics() const; /* read once, when first asked for */

private:
  mutable std::optional<Statistics> statistics_;
};

/* What a figure may reach: by physics, and at most ten times what the default solver shows. A figure that is 0, or the
 * rounding of floats, would forbid rounding itself: its bound is derived from that, and says how. */
struct Bound {
  Bound(double value = 0) : value(value) {}
  static Bound from_rounding(double value, std::string derivation);
  static Bound promised(double value, std::string derivation); /* to users, who care for no less than this */
  double value;
  std::string derivation; /* empty: none is needed */

private:
  Bound(double value, std::string derivation) : value(value), derivation(std::move(derivation)) {}
};

/* One figure; smaller is better. */
struct Check {
  enum class Over { maximum, last }; /* of the values seen, which one counts */
  std::string what;                  /* "largest tilt of a box" */
  std::string unit;                  /* "rad"; empty for a ratio */
  Bound bound;
  std::function<double(const Moment &)> value; /* called in order of time; may keep state of its own */
  Over over = Over::maximum;
  double from = 0; /* s: not asked before */
};

struct Trial {
  Scene scene;
  Settings settings;
  std::optional<Settings> documented; /* tried if the case fails: what it needs, where the default settings do not do */
  std::string documented_solver;      /* or this solver with its own defaults, tried where the default solver fails */
  bool own_passes =
      false; /* substeps and iterations are the case's point: a solver's own defaults do not replace them */
  uint64_t steps = 600;
  uint64_t every = 1;        /* steps between two moments that are looked at; the last step always is */
  std::vector<Check> checks; /* the first is the case's figure */
  std::function<void(World &, uint64_t step)> disturb; /* called before each step, if set */
  uint64_t poisoned = 0; /* bodies that `disturb` makes non-finite: as many quarantined are right */
};

/* brief: for tests and for comparing backends, where only that it runs and its bits matter. */
enum class Length { full, quick, brief };

struct Case {
  std::string name; /* as given to --only */
  std::string group;
  std::string what;      /* one sentence: the scene, and why it is hard */
  std::string criterion; /* one sentence: what passing means, and where the bound is from */
  std::function<Trial(Length)> build;
  bool shorter = false; /* quick is shorter or smaller than full: the name then says so */
};

/* Name in reports: a shortened case must not be taken for the whole one. */
std::string reported_name(const Case &which, Length length);

struct Sample {
  double time, value;
};

struct CheckResult {
  std::string what, unit;
  double figure;
  Bound bound;
  bool passed;
  std::vector<Sample> series;
  double ratio() const { return bound.value / figure; } /* how much worse it could become unseen */
  bool loose() const;                                   /* more than ten times, and no derivation says why */
};

/* How a case was passed: what needs more than the defaults counts apart. */
enum class Pass { by_default, with_setting, with_solver, failed };

struct Outcome {
  std::string name, solver;
  bool passed = false;
  CheckResult headline; /* the first check that failed, else the first */
  std::vector<CheckResult> checks;
  std::string settings;                  /* settings_text() of the run */
  std::optional<CheckResult> by_default; /* where only a documented setting or solver passes: what failed without it */
  std::string documented_solver;         /* that which passed, if the case's own solver did not */
  std::string note;                 /* why there is no figure, which body was lost, or what the default settings gave */
  double milliseconds_per_step = 0; /* of the run that `settings` names, without its figures */
  double milliseconds = 0;          /* of all runs of the case: worlds made, steps, figures */
  uint64_t steps = 0;               /* done */
  uint64_t body_hash = 0;
  std::vector<BodyState> end;
  Pass pass() const;
};

/* The trial's settings with this solver, and its own substeps and iterations where the case leaves them open. */
Settings settings_of(const Trial &trial, const std::string &solver);

/* Runs to the end, or until the first body is lost; what a device or solver throws, but for want of memory, becomes a
 * failed outcome, with the reason as its note. `after_step(done, of)` may be empty. */
Outcome run_trial(const std::string &name, const Trial &trial, const std::string &solver, const Placement &placement,
                  const std::function<void(uint64_t done, uint64_t of)> &after_step = {});

/* The case, and if it fails and documents settings that it needs, the case with those; what passes, else the first, is
 * returned. A solver that a case documents is tried for the default solver alone: the others are judged by
 * themselves. */
Outcome run_case(const Case &which, Length length, const std::string &solver, const Placement &placement,
                 const std::function<void(uint64_t done, uint64_t of)> &after_step = {});

/* What differs from the defaults: "dt 0.1, iterations 1000"; "default" if nothing does. */
std::string settings_text(const Settings &settings);

} // namespace tandem::stability
