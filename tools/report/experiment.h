/* experiment.h - one scene with one choice of settings on one backend: how long a step takes, and how wrong it is. */
#pragma once

#include <array>
#include <string>

#include "tools/report/truth.h"

namespace tandem {

struct Run {
  std::string solver, backend;
  Settings settings;
  uint64_t steps = 0;
  /* Median over the timed steps: the first quarter of a run is warm-up, and clocks are read with the devices
   * finished. */
  double step_milliseconds = 0;
  double position_max = 0, rotation_max = 0;             /* m, rad: beside the RMS in `errors` */
  std::array<double, 8> errors{};                        /* by Metric; NaN where it is not defined */
  double mean_height_error = 0;                          /* m, at the end, against the truth */
  double momentum_drift = 0, angular_momentum_drift = 0; /* relative; NaN unless nothing outside but gravity acts */
  uint32_t quarantined = 0;
  uint64_t hash = 0;       /* of all bodies at the end */
  std::string failure;     /* what a backend that broke down said, or that it is unequal; the errors are then NaN */
  bool unequal = false;    /* does not end in the bits of the backend on which the errors were computed: a defect */
  std::string observed_on; /* the backend on which the errors were computed */
  bool front = false;

  double error(Metric metric) const { return errors[static_cast<size_t>(metric)]; }
  /* Settings with other time steps compared fairly: for 1/60 s of simulated time. */
  double cost() const { return step_milliseconds * double{base_step} / double{settings.step}; }
};

/* `solver` and `backend` of the settings and placement; never throws for a simulation that goes wrong. InputError for
 * bad names. */
Run run_experiment(const Scene &scene, double duration, const Truth &truth, const Settings &settings,
                   const std::string &backend);

/* The same simulation on another backend for its time alone: results have equal bits, so the errors are those of
 * `observed` if the bodies end with its hash, and NaN, with a failure that says so, if not. The reference, which
 * computes in double, is observed by itself. */
Run time_experiment(const Scene &scene, double duration, const Truth &truth, const Run &observed,
                    const std::string &backend);

} // namespace tandem
