/* event_settings.h - the settings of worlds that tell their contact events, for the tests of events and of triggers. */
#pragma once

#include <tandem/settings.h>

namespace tandem::physics_tests {

inline Settings with_events(Solver solver = Solver::soft_step)
{
  Settings settings = settings_for(solver);
  settings.events = true;
  return settings;
}

} // namespace tandem::physics_tests
