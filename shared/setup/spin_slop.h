/* spin_slop.h - less depth is left in place under bodies that spin fast.
 *
 * Slop is what a contact may settle by. A body that turns at w falls by g / (2 w^2) while it turns by a radian; what
 * sinks deeper than that has not settled, but turns about another point than that which touches. A top of 10 cm at
 * 100 rad/s on 5 mm of slop would precess 7% too fast. At the default slop of 5 mm this begins at 31 rad/s.
 */
#ifndef TANDEM_SHARED_SETUP_SPIN_SLOP_H
#define TANDEM_SHARED_SETUP_SPIN_SLOP_H

#include "shared/records.h"

/* 1/s^2; 0 of what no impulse can change. */
SHARED real spin_squared(spatial_velocity m)
{
  return choose(m.inverse_mass > R(0.0), length_squared(m.angular), (real)R(0.0));
}

/* Without gravity nothing settles. A contact that counts as deep keeps counting so. */
SHARED real limited_by_spin(GLOBAL const Parameters *parameters, spatial_velocity a, spatial_velocity b,
                            real slop_or_deep)
{
  real fall = parameters->spin_fall;
  if (!(parameters->spin_fall > R(0.0))) return slop_or_deep;
  real squared = maximum(spin_squared(a), spin_squared(b));
  return choose(slop_or_deep * squared > fall, fall / squared, slop_or_deep);
}

#endif
