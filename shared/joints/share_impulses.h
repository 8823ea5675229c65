/* share_impulses.h - makes impulses of joints and couplings whose bodies take many substeps those of one of these, or
 * back those of one of the few; see substep_classes.h. */
#ifndef TANDEM_SHARED_JOINTS_SHARE_IMPULSES_H
#define TANDEM_SHARED_JOINTS_SHARE_IMPULSES_H

#include "shared/joints/couplings.h"

SHARED void share_joint_impulses_item(GLOBAL const Parameters *parameters, GLOBAL const uint *joint_a,
                                      GLOBAL const uint *joint_b, read_turning_bodies bodies,
                                      write_joint_impulses impulses, uint back, item_index i)
{
  mask of_many = is_of_many(class_of_joint(bodies, load_uint(joint_a, i), load_uint(joint_b, i)));
  if (!any_of(of_many)) return;
  real share = impulse_share(parameters, back);
  share_row_if(of_many, impulses.linear, share, i);
  if (HAS_FEATURE(parameters, JOINT_FRAMES)) share_row_if(of_many, impulses.angular, share, i);
  if (!HAS_FEATURE(parameters, JOINT_AXES)) return;
  for (uint k = 0; k < parameters->joint_axes; ++k)
    share_row_if(of_many, impulses.axis, share, joint_plane(parameters, k) + i);
}

SHARED void share_coupling_impulses_item(GLOBAL const Parameters *parameters, GLOBAL const uint *coupling_a,
                                         GLOBAL const uint *coupling_b, GLOBAL const uint *joint_a,
                                         GLOBAL const uint *joint_b, read_turning_bodies bodies,
                                         GLOBAL memory_real *impulse, uint back, item_index i)
{
  uint_lanes a = load_uint(coupling_a, i), b = load_uint(coupling_b, i);
  mask awake = are_awake(a, b);
  a = choose(awake, a, (uint_lanes)0u);
  b = choose(awake, b, (uint_lanes)0u);
  mask of_many = awake & is_of_many(class_of_coupling(joint_a, joint_b, bodies, a, b));
  real old = load_real(impulse, i);
  store_real(impulse, i, choose(of_many, impulse_share(parameters, back) * old, old));
}

#endif
