/* stop_motion.h - cuts a body's motion to the share that narrowphase/limit_motion.h found free of walls. */
#ifndef TANDEM_SHARED_INTEGRATE_STOP_MOTION_H
#define TANDEM_SHARED_INTEGRATE_STOP_MOTION_H

#include "shared/records.h"
#include "shared/trigonometry.h"

/* body_share: of the motion, in 1 / 2^24. */
SHARED void stop_motion_item(GLOBAL const row *body_orientation, GLOBAL const uint *body_share,
                             GLOBAL row *solver_delta, GLOBAL row *solver_orientation, item_index i)
{
  real share = to_real(load_natural(body_share, i)) * R(5.9604644775390625e-8);
  mask cut = share < R(1.0);
  if (!any_of(cut)) return;
  vec3 translation = scale(xyz(load_row(solver_delta, i * 2u)), share),
       rotation = scale(xyz(load_row(solver_delta, i * 2u + 1u)), share);
  store_row_if(cut, solver_delta, i * 2u, extend(translation, R(0.0)));
  store_row_if(cut, solver_delta, i * 2u + 1u, extend(rotation, R(0.0)));
  store_row_if(cut, solver_orientation, i, quat_to_row(turned(quat_from(load_row(body_orientation, i)), rotation)));
}

#endif
