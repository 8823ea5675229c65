/* incidence.h - the launches that list the constraints of each body; see shared/batching/incidence.h. */
#pragma once

#include "host/pipeline/step.h"

namespace tandem {

/* Fills incidence_start, incidence and incidence_body with the constraints from first_color on: 0 for all, COLOR_TAIL
 * for those without a colour of their own. */
void list_incidences(Launcher &launcher, const StepPlan &plan, uint32_t first_color);

/* The entry of counts that says how many entries there are, those of bodies that do not move among them. */
uint32_t incidence_count(uint32_t first_color);

} // namespace tandem
