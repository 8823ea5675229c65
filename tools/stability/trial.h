/* trial.h - defines a stability case and its run.
 *
 *   Case --build(length)--> Trial {scene, settings, steps, checks} --run_trial(solver, backend)--> Outcome
 *
 * A case states in figures what "stable" means: each check reads one figure from the moving bodies, in double
 * precision, and passes while it stays at or below its bound. A check compares with a closed form, a conserved
 * quantity, the start of the scene, or a bound on energy, and never with an earlier result of Tandem. A figure that is
 * not finite fails, and so does a body that stopped being finite unless the case made it so.
 */
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tandem/world.h>

namespace tandem::stability {

/* The state that a check may read, after a step (and once before the first, at time 0). */
class Moment {
public:
  Moment(World &world, uint64_t step);
  World &world;
  uint64_t step;                 /* steps done */
  double time;                   /* s */
  std::vector<BodyState> bodies; /* in the order of Scene::bodies */
  const Scene &scene() const { return world.scene(); }
  const Statistics &statistics() const; /* read once, at the first call */

private:
  mutable std::optional<Statistics> statistics_;
};

/* The limit of a figure: derived from physics, and at most ten times the figure of the default solver. If the figure is
 * 0 or the rounding of floats, such a limit would forbid rounding itself; the bound is then derived from rounding, and
 * states how. */
struct Bound {
  Bound(double value = 0) : value(value) {}
  static Bound from_rounding(double value, std::string derivation);
  static Bound promised(double value, std::string derivation);    /* for users, who notice nothing smaller */
  static Bound from_theory(double value, std::string derivation); /* of the method, such as an order of its error */
  double value;
  std::string derivation;          /* empty if none is needed */
  std::string source = "rounding"; /* in tables, if there is a derivation */

private:
  Bound(double value, std::string derivation) : value(value), derivation(std::move(derivation)) {}
};

/* One figure; smaller is better. */
struct Check {
  enum class Over { maximum, last }; /* which of the observed values counts */
  std::string what;                  /* "largest tilt of a box" */
  std::string unit;                  /* "rad"; empty for a ratio */
  Bound bound;
  std::function<double(const Moment &)> value; /* called in order of time; may keep state */
  Over over = Over::maximum;
  double from = 0; /* s: not evaluated before this time */
};

struct Trial {
  Scene scene;
  Settings settings;
  std::optional<Settings> documented; /* tried if the case fails with the default settings */
  std::string documented_solver;      /* or this solver with its own defaults, tried if the default solver fails */
  bool own_passes =
      false; /* the case is about substeps and iterations, so a solver's own defaults do not replace them */
  bool keeps_substeps = false; /* the case is about this number of substeps, so no world chooses another */
  uint64_t steps = 600;
  uint64_t every = 1;        /* steps between two observed moments; the last step is always observed */
  std::vector<Check> checks; /* the first is the case's figure */
  std::function<void(World &, uint64_t step)> disturb; /* called before each step, if set */
  uint64_t poisoned = 0; /* bodies that `disturb` makes non-finite; exactly as many must be quarantined */
};

/* brief: for tests and for comparing backends, which only need it to run with equal bits. */
enum class Length { full, quick, brief };

struct Case {
  std::string name; /* as given to --only */
  std::string group;
  std::string what;      /* one sentence: the scene, and why it is hard */
  std::string criterion; /* one sentence: what passing means, and the source of the bound */
  std::function<Trial(Length)> build;
  bool shorter = false;           /* quick is shorter or smaller than full, and the name then says so */
  std::string fails_because = ""; /* of a case that neither the defaults nor a setting passes: the cause */
  std::string elsewhere = "";     /* what is publicly known of other engines, with its source; empty if nothing is */
};

/* The name in reports, so that a shortened case is not taken for the full one. */
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
  double ratio() const { return bound.value / figure; } /* how much worse it could become unnoticed */
  bool loose() const;                                   /* more than ten, without a derivation */
};

/* How a case was passed; cases that need more than the defaults are counted separately. refused: the solver has no
 * joints, and the case is about some. */
enum class Pass { by_default, with_setting, with_solver, failed, refused };

struct Outcome {
  std::string name, solver;
  bool passed = false, refused = false;
  CheckResult headline; /* the first check that failed, else the first */
  std::vector<CheckResult> checks;
  std::string settings;                  /* settings_text() of the run */
  std::optional<CheckResult> by_default; /* if only a documented setting or solver passes: the check that failed without
                                            it */
  std::string documented_solver;         /* the one that passed, if the case's own solver did not */
  std::string note;                 /* why there is no figure, which body was lost, or what the default settings gave */
  double milliseconds_per_step = 0; /* of the run that `settings` names, without its figures */
  double milliseconds = 0;          /* of all runs of the case: making worlds, steps, figures */
  uint64_t steps = 0;               /* done */
  uint64_t body_hash = 0;
  std::vector<BodyState> end;
  Pass pass() const;
};

/* The trial's settings with this solver, and the solver's own substeps and iterations unless the case sets them. */
Settings settings_of(const Trial &trial, const std::string &solver);

/* Runs to the end, or until the first body is quarantined. What a device or solver throws, except for lack of memory,
 * becomes a failed outcome with the reason as its note. `after_step(done, of)` may be empty. */
Outcome run_trial(const std::string &name, const Trial &trial, const std::string &solver, const Placement &placement,
                  const std::function<void(uint64_t done, uint64_t of)> &after_step = {});

/* Whether the solver cannot run the case's scene, because it has joints. */
bool refuses(const std::string &solver, const Trial &trial);

/* Runs the case, unless the solver refuses it, and if it fails and documents settings that it needs, runs it again with
 * those; returns the run that passes, else the first. A solver that a case documents is tried only for the default
 * solver; other solvers are judged by themselves. */
Outcome run_case(const Case &which, Length length, const std::string &solver, const Placement &placement,
                 const std::function<void(uint64_t done, uint64_t of)> &after_step = {});

/* The settings that differ from the defaults, such as "dt 0.1, iterations 1000"; "default" if none do. */
std::string settings_text(const Settings &settings);

} // namespace tandem::stability
