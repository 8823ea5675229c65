/* contact_curves.h - the contact problems of the report: residual against time for each solver. */
#pragma once

#include <vector>

#include "tools/report/collect.h"

namespace tandem {

/* Runs each solver on each file, on `backend`; nsgs always on the reference. Throws InputError for a file that is no
 * contact problem. */
std::vector<ContactCurve> contact_curves(const std::vector<std::string> &files, const std::string &backend, bool quick);

/* The default files: the project's own small problems and, unless `quick`, those of data/siconos, if they exist under
 * the working directory. */
std::vector<std::string> usual_contact_problems(bool quick);

} // namespace tandem
