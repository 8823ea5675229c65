/* table.h - the table of docs/stability.md, written by a run and by nothing else. */
#pragma once

#include "tools/stability/results.h"

namespace tandem::stability {

/* Markdown: counts, then case by case the checks of the first solver with figure, bound and ratio, and the verdict of
 * every solver. */
std::string markdown_of(const Results &results, const std::string &command);

/* `page` with what stands between its two marks replaced by `table`; InputError if it has no such marks. */
std::string with_table(const std::string &page, const std::string &table, const std::string &where);

} // namespace tandem::stability
