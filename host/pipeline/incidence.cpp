/* incidence.cpp - see incidence.h. */
#include "host/pipeline/incidence.h"

#include <bit>
#include <stdexcept>

#include "host/pipeline/primitives.h"

namespace tandem {

uint32_t incidence_count(uint32_t first_color)
{
  if (first_color != 0 && first_color != COLOR_TAIL)
    throw std::logic_error("incidences are counted from the first colour or from the tail");
  return first_color == 0 ? COUNT_INCIDENCES : COUNT_TAIL_INCIDENCES;
}

void list_incidences(Launcher &launcher, const StepPlan &plan, uint32_t first_color)
{
  const uint32_t first = COLOR_START + first_color, last = COUNT_CONSTRAINTS, length = incidence_count(first_color);
  launcher.launch({Kernel::incidence_keys, {}, {first_color}, first, last, plan.known[last] - plan.known[first]});
  sort_pairs(launcher, Buffer::incidence_body, Buffer::incidence, Buffer::incidence_body_other, Buffer::incidence_other,
             Buffer::sort_histogram, Buffer::scan_sums, length, 2 * plan.capacity_pairs, 0,
             std::bit_width(plan.bodies));
  launcher.launch({Kernel::incidence_starts, {}, {length}, COUNT_ZERO, COUNT_BODIES_PLUS_ONE, plan.bodies + 1});
}

} // namespace tandem
