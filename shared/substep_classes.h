/* substep_classes.h - islands of few substeps and islands of many, in one step of a world that chooses its substeps.
 *
 *   wishes of bodies ---> islands ---> body_class ---> the solver: passes of the many, then passes of the few
 *   (load_rate.h)         (sleeping/wishes.h)
 *
 * Islands of two classes share no body that moves, so the solver runs twice, each time over the bodies, contacts and
 * joints of one class and with its Parameters (host/pipeline/solvers/soft_step.cpp). Bodies that no contact moves have
 * no class and take part in both; they begin anew in between. Outside of the solver, impulses are those of a substep of
 * the few, whoever took them.
 */
#ifndef TANDEM_SHARED_SUBSTEP_CLASSES_H
#define TANDEM_SHARED_SUBSTEP_CLASSES_H

#include "shared/body_codes.h"
#include "shared/parameters.h"
#include "shared/records.h"

/* Whether the pass moves the bodies of one class alone. */
SHARED uint moves_one_class(GLOBAL const Parameters *parameters)
{
  return parameters->substep_class != EVERY_CLASS ? 1u : 0u;
}

/* Of a pass over one class. */
SHARED mask is_moved(GLOBAL const Parameters *parameters, GLOBAL const uint *body_class, item_index i)
{
  uint_lanes own = load_uint(body_class, i);
  return (own == (uint_lanes)NO_CLASS) | (own == (uint_lanes)parameters->substep_class);
}

/* Whether the pass moves none of the bodies of all lanes. */
SHARED uint leaves_bodies(GLOBAL const Parameters *parameters, GLOBAL const uint *body_class, item_index i)
{
  return moves_one_class(parameters) && !any_of(is_moved(parameters, body_class, i)) ? 1u : 0u;
}

/* Those of the bodies that the pass moves. */
SHARED mask moved_among(GLOBAL const Parameters *parameters, GLOBAL const uint *body_class, mask bodies, item_index i)
{
  return moves_one_class(parameters) ? bodies & is_moved(parameters, body_class, i) : bodies;
}

SHARED uint_lanes larger_class(uint_lanes a, uint_lanes b) { return choose(a < b, b, a); }

/* Of a joint or contact: that of a body of it that moves. What connects none of them is with the few. */
SHARED mask is_of_many(uint_lanes own) { return own == (uint_lanes)MANY_SUBSTEPS; }

SHARED mask is_of_pass(GLOBAL const Parameters *parameters, uint_lanes own)
{
  mask of_many = is_of_many(own);
  return parameters->substep_class == MANY_SUBSTEPS ? of_many : !of_many;
}

/* What makes impulses of a substep of the few those of one of the many, a power of two, or back. */
SHARED real impulse_share(GLOBAL const Parameters *parameters, uint back)
{
  real share = parameters->few_share;
  return back != 0u ? R(1.0) / share : share;
}
/* What stands in w is no impulse. */
SHARED void share_row_if(mask m, GLOBAL float4 *impulse, real share, item_index i)
{
  vec4 old = load_float4(impulse, i);
  store_float4_if(m, impulse, i, extend(scale(xyz(old), share), old.w));
}

#endif
