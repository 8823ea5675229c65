/* contact_curves.h - the contact problems of the report: residual against time for each solver. */
#pragma once

#include <vector>

#include "tools/report/collect.h"

namespace tandem {

/* Curves of the project's own small problems, and of those under data/siconos if they are there. */
std::vector<ContactCurve> contact_curves(bool quick);

} // namespace tandem
