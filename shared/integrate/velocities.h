/* velocities.h - gravity, damping and the warm start over one substep: the forces of the pipeline. */
#ifndef TANDEM_SHARED_INTEGRATE_VELOCITIES_H
#define TANDEM_SHARED_INTEGRATE_VELOCITIES_H

#include "shared/records.h"

/* solver_push: what the constraints of the last substep pushed the body by, 0 in the first; taken here, and cleared.
 * solver_unpushed: by it integrate_positions sees whether constraints push. */
SHARED void integrate_velocities_item(GLOBAL const Parameters *parameters, GLOBAL const row *body_mass,
                                      GLOBAL const row *solver_inertia, GLOBAL row *solver_velocity,
                                      GLOBAL row *solver_push, GLOBAL memory_real *solver_unpushed, item_index i)
{
  motion m = load_motion(solver_velocity, i);
  real h = parameters->substep;
  mask moves = m.inverse_mass > R(0.0);
  real pull = choose(moves, load_row(body_mass, i * 2u).w * h, (real)R(0.0));
  m.linear = add_scaled(m.linear, gravity_of(parameters), pull);
  if (HAS_FEATURE(parameters, DAMPING)) {
    vec4 damping = load_row(body_mass, i * 2u + 1u);
    m.linear = scale(m.linear, R(1.0) / (R(1.0) + h * damping.x));
    m.angular = scale(m.angular, R(1.0) / (R(1.0) + h * damping.y));
  }
  real unpushed = inner(gravity_of(parameters), m.linear);
  m.linear = add_scaled(m.linear, xyz(load_row(solver_push, i * 2u)), m.inverse_mass);
  m.angular = add(m.angular, symmetric_times(load_inertia(solver_inertia, i), xyz(load_row(solver_push, i * 2u + 1u))));
  store_motion_if(moves, solver_velocity, i, m);
  vec4 zero = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
  store_row(solver_push, i * 2u, zero);
  store_row(solver_push, i * 2u + 1u, zero);
  store_real(solver_unpushed, i, unpushed);
}

#endif
