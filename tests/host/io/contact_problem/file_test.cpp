/* file_test.cpp - both storage formats give one problem; an invalid file is refused with the line and the reason. */
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <unistd.h>

#include <tandem/scene.h>

#include "host/io/contact_problem/file.h"
#include "tests/catch.h"

using namespace tandem;
using Catch::Matchers::ContainsSubstring;

namespace {

struct ProblemFile {
  std::string path =
      (std::filesystem::temp_directory_path() / ("tandem_problem_" + std::to_string(getpid()) + ".dat")).string();
  explicit ProblemFile(const std::string &text) { std::ofstream(path, std::ios::binary) << text; }
  ~ProblemFile() { std::remove(path.c_str()); }
};

ContactProblem loaded_problem(const std::string &text)
{
  const ProblemFile file(text);
  return read_contact_problem(file.path);
}

std::string fault_in(const std::string &text)
{
  try {
    loaded_problem(text);
  } catch (const InputError &error) {
    return error.what();
  }
  return "no complaint";
}

/* One contact, W = columns (1 2 3) (4 5 6) (7 8 9). */
const std::string dense = "3\n1\n0\n3\n3\n3 3\n1 2 3\n4 5 6\n7 8 9\n-1 0 0\n0.5\n";
/* Two contacts; the row of contact 1 holds column 0 before its own. */
const std::string sparse =
    "3\n2\n1\n6\n6\n3\n2\n2\n3 6\n3 6\n3\n3\n0 1 3\n0 0 1\n0\n1 2 3 4 5 6 7 8 9\n1\n0 0 0 0 0 0 0 0 1\n"
    "2\n2 0 0 0 2 0 0 0 2\n-1 0 0 -2 0 0\n0.5 0\n";

/* `text` with its first `from` replaced. */
std::string with(std::string text, const std::string &from, const std::string &to)
{
  const size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

} // namespace

TEST_CASE("contact problem file: columns become rows, a contact's own block comes first")
{
  const std::array<double, 9> rows = {1, 4, 7, 2, 5, 8, 3, 6, 9};
  CHECK(loaded_problem(dense).blocks.at(0) == rows);
  const ContactProblem problem = loaded_problem(sparse);
  CHECK(problem.start == std::vector<uint32_t>{0, 1, 3});
  CHECK(problem.column == std::vector<uint32_t>{0, 1, 0});
  CHECK(problem.blocks[0] == rows);
  CHECK(problem.blocks[1][0] == 2);
  CHECK(problem.blocks[2][8] == 1);
  CHECK(problem.free_velocity[1] == std::array<double, 3>{-2, 0, 0});
  CHECK(problem.friction == std::vector<double>{0.5, 0});
  CHECK_NOTHROW(loaded_problem(sparse + "1\n")); /* the flag that some writers add */
}

TEST_CASE("contact problem file: anything wrong is refused with its line")
{
  CHECK_THAT(fault_in(""), ContainsSubstring("line 1: the file ends where the dimension should stand"));
  CHECK_THAT(fault_in(with(dense, "3", "2")), ContainsSubstring("line 1: the dimension is 2, it must be 3"));
  CHECK_THAT(fault_in(with(dense, "3\n1\n", "3\n0\n")), ContainsSubstring("line 2: the number of contacts is 0"));
  CHECK_THAT(fault_in(with(dense, "3\n1\n", "3\n-1\n")),
             ContainsSubstring("line 2: the number of contacts should be a whole number"));
  CHECK_THAT(fault_in(with(dense, "3\n1\n", "3\n2\n")),
             ContainsSubstring("line 4: the number of rows of W is 3, it must be 6"));
  CHECK_THAT(fault_in(with(dense, "1\n0\n", "1\n7\n")),
             ContainsSubstring("line 3: the storage of W is 7, it must be 0 to 1"));
  CHECK_THAT(fault_in(with(dense, "3 3\n", "3 4\n")),
             ContainsSubstring("line 6: the number of columns of W is 4, it must be 3"));
  CHECK_THAT(fault_in(with(dense, "5", "nan")), ContainsSubstring("line 8: W[1][1] is not finite"));
  CHECK_THAT(fault_in(with(dense, "5", "five")), ContainsSubstring("line 8: W[1][1] should be a number, not 'five'"));
  CHECK_THAT(fault_in(with(dense, "5", "1e-400")), ContainsSubstring("is '1e-400', too large or too small for 64"));
  CHECK_THAT(fault_in(with(dense, "5", std::string("5\0x", 3))), ContainsSubstring("should be a number, not '5"));
  CHECK_THAT(fault_in(with(dense, "5", std::string("5\0x", 3))), ContainsSubstring("x'"));
  CHECK_THAT(fault_in(with(dense, "5", "0")), ContainsSubstring("W[1][1] must be positive"));
  CHECK_THAT(fault_in(with(dense, "0.5\n", "")),
             ContainsSubstring("line 11: the file ends where the friction coefficient of contact 0"));
  CHECK_THAT(fault_in(with(dense, "0.5", "-0.5")),
             ContainsSubstring("line 11: the friction coefficient of contact 0 is negative"));
  CHECK_THAT(fault_in(with(dense, "0.5", "inf")), ContainsSubstring("not finite"));
  CHECK_THAT(fault_in(dense + "1\n0\n"), ContainsSubstring("line 13: the problem has ended"));
  CHECK_THAT(fault_in(with(sparse, "0 0 1\n", "0 2 1\n")),
             ContainsSubstring("line 14: the column of block 1 is 2, it must be 0 to 1"));
  CHECK_THAT(fault_in(with(sparse, "0 0 1\n", "0 0 0\n")), ContainsSubstring("contact 1 has no block of its own"));
  CHECK_THAT(fault_in(with(sparse, "0 0 1\n", "0 1 1\n")), ContainsSubstring("contact 1 has two blocks in column 1"));
  CHECK_THAT(fault_in(with(sparse, "0 1 3\n", "0 4 3\n")), ContainsSubstring("line 13: the start of block row 1 is 4"));
  CHECK_THAT(fault_in(with(sparse, "\n3\n2\n2\n", "\n3\n2\n1\n")),
             ContainsSubstring("the number of block columns is 1, it must be 2"));
  CHECK_THAT(fault_in(with(sparse, "3 6\n", "3 7\n")), ContainsSubstring("the end of block row 1 is 7, it must be 6"));
  CHECK_THAT(fault_in(with(sparse, "\n1\n0 0", "\n5\n0 0")),
             ContainsSubstring("the number of a block is 5, it must be 1"));
  for (size_t length = 0; length + 2 < sparse.size(); length += 7)
    CHECK(fault_in(sparse.substr(0, length)) != "no complaint");
}
