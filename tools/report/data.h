/* data.h - a report as CSV and JSON: the same runs, one row or object each. */
#pragma once

#include "tools/command/output.h"
#include "tools/report/collect.h"

namespace tandem {

std::string report_csv(const Report &report);
Json report_json(const Report &report);

} // namespace tandem
