/* failed_bodies.h - which bodies of a batch of worlds stopped being finite, and after which stage.
 *
 * A world alone quarantines the first of them and runs its step again, as counts say. Of a batch each world must
 * quarantine its own first one, so the host asks for all of them after such a step. */
#ifndef TANDEM_SHARED_INTEGRATE_FAILED_BODIES_H
#define TANDEM_SHARED_INTEGRATE_FAILED_BODIES_H

#include "shared/integrate/commit.h"

SHARED uint_lanes failed_after(mask finite, uint stage, uint_lanes later)
{
  return choose(finite, later, (uint_lanes)(stage + 1u));
}

SHARED void find_failed_bodies_item(read_bodies bodies, GLOBAL const float4 *solver_velocity,
                                    GLOBAL const float4 *solver_delta_pose, GLOBAL const float4 *solver_orientation,
                                    GLOBAL uint *body_failed, item_index i)
{
  uint_lanes failed = failed_after(moved_pose_is_finite(bodies.position, solver_delta_pose, solver_orientation, i),
                                   NONFINITE_IN_INTEGRATE, (uint_lanes)0u);
  failed = failed_after(velocity_is_finite(load_velocity(solver_velocity, i)), NONFINITE_IN_SOLVE, failed);
  failed = failed_after(state_is_finite(bodies, i), NONFINITE_AT_START, failed);
  store_uint(body_failed, i, failed);
}

#endif
