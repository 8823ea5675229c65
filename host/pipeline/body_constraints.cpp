/* body_constraints.cpp - the body-to-constraint list: keys, a sort and the starts of the bodies; see
 * body_constraints.h. */
#include "host/pipeline/body_constraints.h"

#include <bit>
#include <stdexcept>

#include "host/pipeline/primitives.h"

namespace tandem {

uint32_t body_constraint_count(uint32_t first_color)
{
  if (first_color != 0 && first_color != COLOR_OVERFLOW)
    throw std::logic_error("entries are counted from the first colour or from the overflow constraints");
  return first_color == 0 ? COUNT_BODY_CONSTRAINTS : COUNT_OVERFLOW_BODY_CONSTRAINTS;
}

void list_body_constraints(Launcher &launcher, const StepPlan &plan, uint32_t first_color)
{
  const uint32_t first = COLOR_START + first_color, last = COUNT_CONSTRAINTS,
                 length = body_constraint_count(first_color);
  launcher.launch({Kernel::body_constraint_keys, {}, {first_color}, first, last, plan.known[last] - plan.known[first]});
  sort_pairs(launcher, Buffer::body_constraint_key, Buffer::body_constraint, Buffer::body_constraint_key_other,
             Buffer::body_constraint_other, Buffer::sort_histogram, Buffer::scan_sums, length, 2 * plan.capacity_pairs,
             0, std::bit_width(plan.bodies));
  launcher.launch({Kernel::body_constraint_starts, {}, {length}, COUNT_ZERO, COUNT_BODIES_PLUS_ONE, plan.bodies + 1});
}

} // namespace tandem
