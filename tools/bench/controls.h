/* controls.h - `tandem bench controls`: many worlds of a robot whose joints are driven at random, as a learner drives
 * them before it has learnt anything.
 *
 * Each step draws a new control for every actuator of the robot, within its range, gives all of them to the batch, and
 * steps it; both are timed apart. Of a scene without actuators, forces drive every axis that has damping. A quarter of
 * the worlds begins anew after every 50 steps, so each robot falls, lies and thrashes for 200 steps, and is in all of
 * these states in one quarter or another. The first 200 steps are not timed. With --error it also tells how far the
 * robots are from a run that has converged (controls_error.h). */
#pragma once

#include "tools/bench/options.h"

namespace tandem {

int execute_controls(const BenchOptions &options);

} // namespace tandem
