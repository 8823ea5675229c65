/* take_parameters.h - the numbers and the bodies of the passes over islands of one class; see substep_classes.h. */
#ifndef TANDEM_SHARED_INTEGRATE_TAKE_PARAMETERS_H
#define TANDEM_SHARED_INTEGRATE_TAKE_PARAMETERS_H

#include "shared/records.h"
#include "shared/substep_classes.h"

/* substep_class: EVERY_CLASS takes back what the host has told. */
SHARED void take_parameters_item(GLOBAL const Parameters *told, GLOBAL const Parameters *of_few,
                                 GLOBAL const Parameters *of_many, GLOBAL Parameters *parameters, uint substep_class,
                                 uint i)
{
  (void)i;
  *parameters = substep_class == FEW_SUBSTEPS ? *of_few : substep_class == MANY_SUBSTEPS ? *of_many : *told;
}

/* Kinematic bodies are where the step began, and so are those that do not move. */
SHARED void rewind_kinematics_item(GLOBAL const uint *body_class, GLOBAL const float4 *body_orientation,
                                   GLOBAL float4 *solver_delta_pose, GLOBAL float4 *solver_orientation, item_index i)
{
  mask rewound = load_uint(body_class, i) == (uint_lanes)NO_CLASS;
  if (!any_of(rewound)) return;
  vec4 zero = make_vec4(R(0.0), R(0.0), R(0.0), R(0.0));
  store_float4_if(rewound, solver_delta_pose, i * 2u, zero);
  store_float4_if(rewound, solver_delta_pose, i * 2u + 1u, zero);
  store_float4_if(rewound, solver_orientation, i, load_float4(body_orientation, i));
}

#endif
