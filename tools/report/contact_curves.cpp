/* contact_curves.cpp - see contact_curves.h. */
#include "tools/report/contact_curves.h"

namespace tandem {

/* Nothing yet: the solvers of `tandem contact-problem` put their (ms, residual) here, a curve for each problem and solver. */
std::vector<ContactCurve> contact_curves(bool) { return {}; }

} // namespace tandem
