/* experiment.h - runs one scene with one choice of settings on one backend, and measures the time of a step and the
 * errors. */
#pragma once

#include <array>
#include <string>

#include "tools/report/truth.h"

namespace tandem {

struct Run {
  std::string solver, backend;
  Settings settings;
  uint64_t steps = 0;
  /* Median over the timed steps. The first quarter of a run is warm-up, and clocks are read with the devices
   * finished. */
  double step_milliseconds = 0;
  double position_max = 0, rotation_max = 0;             /* m, rad: beside the RMS in `errors` */
  std::array<double, 8> errors{};                        /* by Metric; NaN where it is not defined */
  double mean_height_error = 0;                          /* m, at the end, against the truth */
  double momentum_drift = 0, angular_momentum_drift = 0; /* relative; NaN unless gravity is the only external force */
  uint32_t quarantined = 0;
  uint64_t hash = 0;       /* of all bodies at the end */
  std::string failure;     /* the message of a backend that failed, or that its bits differ; the errors are then NaN */
  bool unequal = false;    /* the final bits differ from those of the backend on which the errors were computed, which
                              is a defect */
  std::string observed_on; /* the backend on which the errors were computed */
  bool front = false;

  double error(Metric metric) const { return errors[static_cast<size_t>(metric)]; }
  /* The time for 1/60 s of simulated time, so that settings with different time steps can be compared. */
  double cost() const { return step_milliseconds * double{base_step} / double{settings.step}; }
};

/* Never throws for a simulation that fails. Throws InputError for invalid names of solver or backend. */
Run run_experiment(const Scene &scene, double duration, const Truth &truth, const Settings &settings,
                   const std::string &backend);

/* Runs the same simulation on another backend only for its time. Results have equal bits, so the errors are those of
 * `observed` if the bodies end with its hash; otherwise they are NaN, with a failure that says so. The reference, which
 * computes in double, gets errors of its own. */
Run time_experiment(const Scene &scene, double duration, const Truth &truth, const Run &observed,
                    const std::string &backend);

} // namespace tandem
