/* softness.h - how soft the held rows of a joint are.
 *
 * A pass closes what is open at the rate of `joint_hertz`, and lets a share of the impulse leak away. Where many or
 * heavy bodies hang on a light one, a pass takes only a small share k of their errors. Gaps then close by impulses that
 * arrive late, as an integral controller closes them: a gap C, its speed v and the force F of the joint follow
 *
 *       C' = v,    v' = F,    F' = -k (2 v + b C) - g F       (in substeps: k of two passes, b the bias, g the leak)
 *
 * and stay bounded only if b is less than about twice g, whatever k is. Stiff joints, whose bias is large and whose
 * leak is small, are beyond that bound, so joints of a body that many share (host/scene/joint_sharing.h) are softer.
 */
#ifndef TANDEM_SHARED_JOINTS_SOFTNESS_H
#define TANDEM_SHARED_JOINTS_SOFTNESS_H

#include "shared/joints/joint.h"

typedef struct {
  real bias_rate, mass_scale, impulse_scale;
} joint_softness;

SHARED joint_softness plain_softness(GLOBAL const Parameters *parameters)
{
  joint_softness s = {(real)parameters->joint_bias_rate, (real)parameters->joint_mass_scale,
                      (real)parameters->joint_impulse_scale};
  return s;
}

/* Of rows of bodies that are no crowd. */
SHARED mask never_crowded(void) { return (real)R(0.0) > R(1.0); }

SHARED mask is_crowded(const joint *j) { return (j->a.sharing > R(1.0)) | (j->b.sharing > R(1.0)); }

SHARED joint_softness joint_softness_of(GLOBAL const Parameters *parameters, mask crowded)
{
  joint_softness plain = plain_softness(parameters);
  real leak = parameters->crowd_impulse_scale;
  joint_softness s = {choose(crowded, (real)parameters->crowd_bias_rate, plain.bias_rate),
                      choose(crowded, R(1.0) - leak, plain.mass_scale), choose(crowded, leak, plain.impulse_scale)};
  return s;
}

#endif
