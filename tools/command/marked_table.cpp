/* marked_table.cpp - writes tables into pages; see marked_table.h. */
#include "tools/command/marked_table.h"

#include <fmt/format.h>

#include <tandem/error.h>

#include "host/io/input_file.h"
#include "tools/command/output.h"

namespace tandem {

void MarkedTable::check(DistinctFiles &files) const
{
  if (path.empty()) return;
  page_with("");
  files.writes("--table-in", path);
}

void MarkedTable::write(const std::string &table) const
{
  if (!path.empty()) write_file("--table-in", path, page_with(table));
}

std::string MarkedTable::page_with(const std::string &table) const
{
  return with_table(read_file(path), name, table, "--table-in " + path);
}

std::string with_table(const std::string &page, const std::string &name, const std::string &table,
                       const std::string &where)
{
  const std::string title = name.empty() ? "table" : "table " + name;
  const std::string begins = fmt::format("<!-- {}: begin -->", title), ends = fmt::format("<!-- {}: end -->", title);
  const size_t begin = page.find(begins + "\n"), end = page.find(ends + "\n");
  if (begin == std::string::npos || end == std::string::npos || end < begin)
    throw InputError(fmt::format("{}: it must hold the lines '{}' and '{}', between which the table is written", where,
                                 begins, ends));
  return page.substr(0, begin) + begins + "\n" + table + page.substr(end);
}

} // namespace tandem
