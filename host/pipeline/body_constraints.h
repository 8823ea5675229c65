/* body_constraints.h - the launches that list the constraints of each body (CSR), which `avbd` and mass splitting need;
 * see shared/batching/body_constraints.h. */
#pragma once

#include "host/pipeline/step.h"

namespace tandem {

/* Fills body_constraint_start, body_constraint and body_constraint_key with the constraints from first_color on: 0 for
 * all, COLOR_OVERFLOW for those without a colour of their own. */
void list_body_constraints(Launcher &launcher, const StepPlan &plan, uint32_t first_color);

/* The entry of counts that holds the number of list entries, including those of bodies that do not move. */
uint32_t body_constraint_count(uint32_t first_color);

} // namespace tandem
