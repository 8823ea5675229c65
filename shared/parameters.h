/* parameters.h - the numbers of a step that are the same for every item.
 *
 * host/scene/parameters.cpp derives them from the settings of a run. The reals come first, whose width differs in the
 * reference backend, then whole numbers. There are an even number of reals and of words, so that every compiler lays
 * the struct out alike, with 64 bits at a multiple of their own size and without gaps. */
#ifndef TANDEM_SHARED_PARAMETERS_H
#define TANDEM_SHARED_PARAMETERS_H

#include "shared/platform.h"

#if defined(__OPENCL_C_VERSION__) || defined(__OPENCL_VERSION__)
#define PARAMETER_REAL float
#else
#define PARAMETER_REAL memory_real
#endif

#ifndef TANDEM_PARAMETERS_TYPE
#define TANDEM_PARAMETERS_TYPE
typedef struct {
  PARAMETER_REAL step;                            /* s, whole step */
  PARAMETER_REAL substep;                         /* s */
  PARAMETER_REAL inverse_substep;                 /* 1/s */
  PARAMETER_REAL gravity_x, gravity_y, gravity_z; /* m/s^2 */
  PARAMETER_REAL bias_rate;                       /* 1/s, soft contact: penetration is removed at this rate */
  PARAMETER_REAL mass_scale;                      /* soft contact: share of the impulse of a rigid one */
  PARAMETER_REAL impulse_scale;                   /* soft contact: leak of the accumulated impulse */
  PARAMETER_REAL static_bias_rate;                /* the same three against bodies that cannot move */
  PARAMETER_REAL static_mass_scale;
  PARAMETER_REAL static_impulse_scale;
  PARAMETER_REAL push_speed;           /* m/s, penetration is never removed faster */
  PARAMETER_REAL speculative_distance; /* m, contacts are made this far ahead of touching */
  PARAMETER_REAL bounds_margin;        /* m, added to every bound */
  PARAMETER_REAL slop;                 /* m, penetration left in place */
  PARAMETER_REAL slop_share;           /* of the smallest half extent of a pair: no more than this is left in place */
  PARAMETER_REAL restitution_speed;    /* m/s, slower impacts do not bounce */
  PARAMETER_REAL hybrid_cell;          /* m, cell of the hybrid broadphase: what is larger is not in its grid */
  PARAMETER_REAL inverse_batch_cell;   /* 1/m, cells of two-stage batching */
  PARAMETER_REAL warm_start_scale;     /* of the impulses of the last step, if its substeps were longer or shorter */
  PARAMETER_REAL gravity_length;       /* m/s^2 */
  PARAMETER_REAL sleep_speed;          /* m/s, bodies of a metre and more rest below it */
  PARAMETER_REAL zero;                 /* 0, of which no compiler knows: docs/exactness.md, rusticl */
  PARAMETER_REAL joint_bias_rate;      /* 1/s, soft joint: gaps are closed at this rate; the three as for contacts */
  PARAMETER_REAL joint_mass_scale;
  PARAMETER_REAL joint_impulse_scale;
  PARAMETER_REAL crowd_bias_rate; /* the same of joints that share a body, whose mass scale is 1 less the leak */
  PARAMETER_REAL crowd_impulse_scale;
  PARAMETER_REAL spin_fall; /* m/s^2, half of gravity if spin limits what is left in place, else 0 */
  PARAMETER_REAL few_rate;  /* 1/s^2, COUNT_LOAD_RATE that the fewest substeps bear: load_rate.h */
  PARAMETER_REAL few_share; /* the fewest substeps as a share of the many that some islands take, else 1 */
  uint sleep_steps;        /* of rest, before a body may fall asleep; the first whole number */
  uint joined_pairs_first; /* the first entry of body_filter that holds pairs of bodies that do not collide */
  uint joined_pairs_mask;  /* their number, a power of two, minus 1: broadphase/joined_pairs.h */
  uint joints;             /* the stride of planes of axes */
  uint joint_axes;         /* planes: the most axes of a joint */
  uint substep_class;      /* of the bodies that a pass moves: substep_classes.h */
  ulong features;          /* a bit for each row of features.def */
} Parameters;
#endif

#endif
