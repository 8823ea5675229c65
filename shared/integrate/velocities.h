/* velocities.h - gravity and damping over one substep: the forces of the pipeline. */
#ifndef TANDEM_SHARED_INTEGRATE_VELOCITIES_H
#define TANDEM_SHARED_INTEGRATE_VELOCITIES_H

#include "shared/records.h"

SHARED void integrate_velocities_item(GLOBAL const Parameters *parameters, GLOBAL const row *body_mass, GLOBAL row *solver_velocity, item_index i)
{
  motion m = load_motion(solver_velocity, i);
  real h = parameters->substep;
  mask moves = m.inverse_mass > R(0.0);
  real pull = choose(moves, load_row(body_mass, i * 2u).w * h, (real)R(0.0));
  m.linear = add_scaled(m.linear, make_vec3(parameters->gravity_x, parameters->gravity_y, parameters->gravity_z), pull);
  if (HAS_FEATURE(parameters, FEATURE_DAMPING)) {
    vec4 damping = load_row(body_mass, i * 2u + 1u);
    m.linear = scale(m.linear, R(1.0) / (R(1.0) + h * damping.x));
    m.angular = scale(m.angular, R(1.0) / (R(1.0) + h * damping.y));
  }
  store_motion_if(moves, solver_velocity, i, m);
}

#endif
