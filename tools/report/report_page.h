/* report_page.h - a report as one HTML page. */
#pragma once

#include <string>

#include "tools/report/collect.h"

namespace tandem {

std::string report_page(const Report &report);

} // namespace tandem
