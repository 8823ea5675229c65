/* lanes_kernels.h - the LANES kernel of the module `probe`. */
#ifndef TESTS_MODULE_LANES_KERNELS_H
#define TESTS_MODULE_LANES_KERNELS_H

#include "shared/records.h"

SHARED void probe_push_item(GLOBAL const row *probe_force, GLOBAL row *solver_velocity, uint times, item_index i)
{
  motion m = load_motion(solver_velocity, i);
  row force = probe_force[0];
  m.linear = add(m.linear, scale(make_vec3(force.x, force.y, force.z), (real)(memory_real)times));
  store_motion_if(m.inverse_mass > R(0.0), solver_velocity, i, m);
}

#endif
