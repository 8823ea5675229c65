/* marked_table.h - a table that a run writes into a Markdown page, between two marks, so that no figure is typed. */
#pragma once

#include <string>

#include "tools/command/distinct_files.h"

namespace tandem {

/* The value of the option --table-in: a page, or empty for none. */
class MarkedTable {
public:
  std::string path;
  std::string name; /* of the table, for a page of several; the marks hold it */

  /* Throws InputError unless the page can be written and has the marks, so that no run is lost for want of them. */
  void check(DistinctFiles &files) const;
  /* The page is read again, because it may have been edited during the run. */
  void write(const std::string &table) const;

private:
  std::string page_with(const std::string &table) const;
};

/* The page with the text between its marks `<!-- table: begin -->` and `<!-- table: end -->` replaced by `table`; a
 * table with a name has it in its marks, `<!-- table NAME: begin -->`. Throws InputError, which begins with `where`, if
 * the page has no such marks. */
std::string with_table(const std::string &page, const std::string &name, const std::string &table,
                       const std::string &where);

} // namespace tandem
