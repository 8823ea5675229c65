/* lanes_kernels.h - the LANES kernel of the module `probe`. */
#ifndef TESTS_MODULE_LANES_KERNELS_H
#define TESTS_MODULE_LANES_KERNELS_H

#include "shared/records.h"

SHARED void probe_push_item(GLOBAL const float4 *probe_force, GLOBAL float4 *solver_velocity, uint times, item_index i)
{
  spatial_velocity m = load_velocity(solver_velocity, i);
  float4 force = probe_force[0];
  m.linear = add(m.linear, scale(make_vec3(force.x, force.y, force.z), (real)(memory_real)times));
  store_velocity_if(m.inverse_mass > R(0.0), solver_velocity, i, m);
}

#endif
