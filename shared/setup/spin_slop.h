/* spin_slop.h - less depth is left in place under bodies that spin fast.
 *
 * Slop is what a contact may settle by. A body that turns at w falls by g / (2 w^2) while it turns by a radian; what
 * sinks deeper than that has not settled, but turns about another point than that which touches. A top of 10 cm at
 * 100 rad/s on 5 mm of slop would precess 7% too fast. At the default slop of 5 mm this begins at 31 rad/s.
 */
#ifndef TANDEM_SHARED_SETUP_SPIN_SLOP_H
#define TANDEM_SHARED_SETUP_SPIN_SLOP_H

#include "shared/setup/contact.h"

/* 1/s^2; 0 of what no impulse can change. */
SHARED real spin_squared(GLOBAL const float4 *solver_velocity, uint body)
{
  spatial_velocity m = load_velocity(solver_velocity, body);
  return m.inverse_mass > R(0.0) ? length_squared(m.angular) : R(0.0);
}

/* Without gravity nothing settles. A contact that counts as deep keeps counting so. */
SHARED void limit_slop_item(GLOBAL const Parameters *parameters, GLOBAL const float4 *solver_velocity,
                            GLOBAL const uint *constraint_a, GLOBAL const uint *constraint_b,
                            GLOBAL memory_real *constraint_slop, uint i)
{
  real squared =
      maximum(spin_squared(solver_velocity, constraint_a[i]), spin_squared(solver_velocity, constraint_b[i]));
  real fall = R(0.5) * parameters->gravity_length, slop = constraint_slop[i];
  if (fall > R(0.0) && slop * squared > fall) constraint_slop[i] = fall / squared;
}

#endif
