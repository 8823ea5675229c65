/* friction_rows.h - the friction impulses of contacts, for which a scene without friction has no rows.
 *
 * There they read as zeros. In any other scene a contact of two surfaces without friction starts each step from
 * positive zeros (kept_friction in setup/contact.h). No solver changes them but avbd, which changes their signs and
 * reads nothing of them for such a contact, so bodies move to the same bits with and without rows. The zeros come from
 * memory: a compiler that knew them would decide the signs of the zeros that they are added to. */
#ifndef TANDEM_SHARED_FRICTION_ROWS_H
#define TANDEM_SHARED_FRICTION_ROWS_H

#include "shared/features.h"
#include "shared/math.h"
#include "shared/parameters.h"

/* Along the two tangents and about the normal; then the radius of the patch. */
SHARED vec4 load_friction(GLOBAL const Parameters *parameters, GLOBAL const float4 *friction_impulse, any_index i)
{
  real zero = (real)parameters->zero;
  return HAS_FEATURE(parameters, FRICTION) ? load_float4(friction_impulse, i) : make_vec4(zero, zero, zero, zero);
}

SHARED void store_friction(GLOBAL const Parameters *parameters, GLOBAL float4 *friction_impulse, item_index i,
                           vec4 friction)
{
  if (HAS_FEATURE(parameters, FRICTION)) store_float4(friction_impulse, i, friction);
}

#endif
