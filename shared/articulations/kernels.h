/* kernels.h - articulations: links in reduced coordinates, their contacts, and joints from outside.
 *
 * cl/articulations.cl and the widths of MiniCL (shared/kernels.h) include the kernels of this stage from here alone. */
#ifndef TANDEM_SHARED_ARTICULATIONS_KERNELS_H
#define TANDEM_SHARED_ARTICULATIONS_KERNELS_H

#include "shared/articulations/contact.h"
#include "shared/articulations/couplings.h"
#include "shared/articulations/joint.h"
#include "shared/articulations/joint_forces.h"
#include "shared/articulations/solve_tree_contacts.h"
#include "shared/articulations/step.h"
#include "shared/articulations/tree_contacts.h"
#ifndef TANDEM_LANES /* ITEM kernels take one item at a time */
#include "shared/articulations/colors.h"
#include "shared/articulations/driven.h"
#endif

#endif
