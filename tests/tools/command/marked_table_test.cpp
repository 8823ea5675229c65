/* marked_table_test.cpp - a table replaces what stands between its own marks, and a page without them is refused. */
#ifdef TANDEM_COMMAND
#include <tandem/error.h>

#include "tests/catch.h"
#include "tools/command/marked_table.h"

using namespace tandem;

namespace {

const std::string plain_begin = "<!-- table: begin -->\n", plain_end = "<!-- table: end -->\n";

std::string between_marks(const std::string &name, const std::string &table)
{
  return "<!-- table " + name + ": begin -->\n" + table + "<!-- table " + name + ": end -->\n";
}

} // namespace

TEST_CASE("a table is written between the marks of a page, which must have them in their order")
{
  CHECK(with_table("a\n" + plain_begin + "old\n" + plain_end + "z\n", "", "new\n", "page.md") ==
        "a\n" + plain_begin + "new\n" + plain_end + "z\n");
  CHECK_THROWS_AS(with_table("a\n" + plain_end + plain_begin, "", "new\n", "page.md"), InputError);
  CHECK_THROWS_AS(with_table("a\n", "", "new\n", "page.md"), InputError);
}

TEST_CASE("a page may have several tables, each with its name in its marks")
{
  const std::string page = between_marks("cl:0.0", "old\n") + "text\n" + between_marks("tbb", "other\n");
  CHECK(with_table(page, "tbb", "new\n", "page.md") ==
        between_marks("cl:0.0", "old\n") + "text\n" + between_marks("tbb", "new\n"));
  CHECK(with_table(page, "cl:0.0", "new\n", "page.md") ==
        between_marks("cl:0.0", "new\n") + "text\n" + between_marks("tbb", "other\n"));
  for (const char *name : {"", "cl", "tbb:threads=2"})
    CHECK_THROWS_AS(with_table(page, name, "new\n", "page.md"), InputError);
}
#endif
