/* pass.h - the kinds of passes over the constraints of a substep, for the kernels and the host's solvers. */
#ifndef TANDEM_SHARED_SOLVE_PASS_H
#define TANDEM_SHARED_SOLVE_PASS_H

enum {
  PASS_BIASED,        /* penetration is pushed out */
  PASS_RELAXING,      /* without bias; gathers the warm start of the next substep */
  PASS_LAST,          /* without bias; no substep follows, or it is warm-started otherwise */
  PASS_BOUNCING,      /* with the target velocities of restitution; host/pipeline/solvers/islands.h and links alone */
  PASS_WARM_STARTING, /* the impulses of the last step alone; of links (articulations/contact.h) */
  PASS_FURTHER        /* as PASS_BIASED; of a batch, worlds with overflow constraints and links alone take it */
};

#endif
