/* contact_curves.h - the contact problems of the report: residual against time for each solver. */
#pragma once

#include <vector>

#include "tools/report/collect.h"

namespace tandem {

/* Each solver on each file, on `backend`; nsgs always on the reference. InputError for a file that is no contact
 * problem. */
std::vector<ContactCurve> contact_curves(const std::vector<std::string> &files, const std::string &backend, bool quick);

/* Where the user names none: the project's own small problems and, not for a quick look, those of data/siconos, as far
 * as they lie under the working directory. */
std::vector<std::string> usual_contact_problems(bool quick);

} // namespace tandem
