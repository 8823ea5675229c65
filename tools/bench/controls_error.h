/* controls_error.h - how far driven robots are from a run that has converged, for `tandem bench controls --error`.
 *
 * Steps a second tell little by themselves, since any engine is faster with a longer step. So the robots run once more
 * from their start, with controls that are drawn at random for every interval of 50 ms and held for it: the forces do
 * not depend on the step, and a shorter step only solves the same problem more closely.
 *
 *   controls       |----- held -----|----- held -----| ...      of each world its own, the same in all runs
 *   step           |  .  .  .  .  . |  .  .  .  .  . |          the bench's
 *   step / 2       |................|................|          whether the error falls with the step
 *   step / 16      |::::::::::::::::|::::::::::::::::|          the floor: how far the last run may be trusted
 *   step / 32      |################|################|          has converged; the others are compared with it
 *
 * The distance of two runs at a time is, in each world, the root mean square over the bodies of the distance of their
 * centres of mass; of the worlds the median and the 90th percentile are told. Bodies that can collide with nothing are
 * left out: where a link has several hinges, reduced coordinates have copies of it between them. A world has left the
 * range if a body of it is not finite, or it is off by more than the size of the scene, as robots that explode are: how
 * far says nothing then, so these worlds are counted and left out.
 *
 * A robot that falls is chaotic: from its first contacts on, runs part by themselves, and after some tenths of a second
 * their distance tells that more than the error of the step. So the early times count, and a time at which the floor is
 * not far below tells nothing of the step. */
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <tandem/actuators.h>
#include <tandem/backend.h>
#include <tandem/scene.h>
#include <tandem/settings.h>

#include "tools/command/output.h"

namespace tandem {

constexpr uint32_t most_worlds_of_error = 64;

/* Over the worlds that have not left the range, in mm; each is the distance of one of the worlds. NaN if all have. */
struct DistanceOfWorlds {
  double median = 0, ninetieth = 0;
  uint32_t left = 0; /* worlds */
};

/* Of a run with one step, at each of the times of ControlsError. */
struct ErrorOfStep {
  double step = 0; /* s */
  std::vector<DistanceOfWorlds> distances;
};

struct ControlsError {
  uint32_t worlds = 0;
  size_t bodies = 0;              /* of a world that are compared */
  double size = 0;                /* m: of a world; one that is farther off has left the range */
  double converged_step = 0;      /* s */
  std::vector<double> times;      /* s */
  std::vector<ErrorOfStep> steps; /* the bench's first, the floor last */
};

/* Throws InputError if no body that moves can collide. */
void check_comparable(const Scene &scene);

/* Of so many worlds, with the step of the settings, which must divide 50 ms. Throws as check_comparable does. */
ControlsError controls_error(const Scene &scene, std::span<const Actuator> actuators, uint32_t worlds,
                             const Settings &settings, const Placement &placement);

std::string text_of(const ControlsError &error);
Json json_of(const ControlsError &error);

} // namespace tandem
