/* include_directions - checks the sources against the table of CONTRIBUTING.md that states which folder may include
 * which.
 *
 * Includes point one way: a folder may include those above it in the table, and of these the ones that its row names. A
 * table whose rows name only rows above them has no cycle, so the folders have none. A folder that is not listed is
 * refused, too: a new folder needs a row.
 *
 * Usage: include_directions ROOT              lists file:line: include that the table does not allow; exit status 1 if
 *                                             there is any
 *        include_directions --self-test DIR   plants what it must find in a tree under DIR
 */
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Row {
  std::string folder;
  std::set<std::string> may_include;
};

struct Fault {
  std::string file;
  int line;
  std::string what;
  bool operator==(const Fault &) const = default;
};

const std::string table_head = "| folder | holds | may include |";

std::vector<std::string> words_in_backticks(const std::string &cell)
{
  std::vector<std::string> words;
  static const std::regex word("`([^`]+)`");
  for (std::sregex_iterator at(cell.begin(), cell.end(), word), none; at != none; ++at) words.push_back((*at)[1]);
  return words;
}

std::vector<std::string> cells_of(const std::string &line)
{
  std::vector<std::string> cells;
  std::stringstream rest(line.substr(1));
  for (std::string cell; std::getline(rest, cell, '|');) cells.push_back(cell);
  return cells;
}

/* "all above" stands for every row above. */
Row row_from(const std::string &line, const std::vector<Row> &above)
{
  const std::vector<std::string> cells = cells_of(line);
  if (cells.size() != 3 || words_in_backticks(cells[0]).size() != 1)
    throw std::runtime_error("not a row of three cells: " + line);
  Row row{words_in_backticks(cells[0])[0], {}};
  const auto known = [&](const std::string &folder) {
    return std::any_of(above.begin(), above.end(), [&](const Row &other) { return other.folder == folder; });
  };
  if (cells[2].find("all above") != std::string::npos)
    for (const Row &other : above) row.may_include.insert(other.folder);
  for (const std::string &folder : words_in_backticks(cells[2])) {
    if (!known(folder))
      throw std::runtime_error(row.folder + " may include " + folder + ", which does not stand above it");
    row.may_include.insert(folder);
  }
  return row;
}

std::vector<Row> table_in(const fs::path &document)
{
  std::ifstream in(document);
  std::string line;
  while (std::getline(in, line) && line != table_head) {}
  if (!std::getline(in, line))
    throw std::runtime_error(document.string() + " has no table that begins with: " + table_head);
  std::vector<Row> rows;
  while (std::getline(in, line) && line.starts_with("|")) rows.push_back(row_from(line, rows));
  return rows;
}

/* The longest folder of the table that holds the file. */
std::optional<Row> row_of(const std::vector<Row> &table, const std::string &file)
{
  std::optional<Row> best;
  for (const Row &row : table)
    if (file.starts_with(row.folder + "/") && (!best || row.folder.size() > best->folder.size())) best = row;
  return best;
}

/* Public headers are included as <tandem/...>, all others of the project from the root. */
std::optional<std::string> own_file(const std::string &name)
{
  if (name.starts_with("tandem/")) return "host/include/" + name;
  for (const char *folder : {"shared/", "cl/", "minicl/", "host/", "tools/", "tests/"})
    if (name.starts_with(folder)) return name;
  return {};
}

/* What is included by the name of a list is read where that name is defined. */
void find_fault(const std::vector<Row> &table, const Row &own, const std::string &line, Fault fault,
                std::vector<Fault> &faults)
{
  static const std::string lists = "(BUFFER_LIST|KERNEL_LIST|KERNEL_HEADERS)";
  static const std::regex comment("/[*].*?[*]/"), include("\\s*#\\s*(include\\b|define\\s+" + lists + "\\b)\\s*(.*)"),
      name("[<\"]([^>\"]+)[>\"].*"), list(lists + "\\s*");
  const auto refuse = [&](const std::string &what) { faults.push_back({fault.file, fault.line, what}); };
  const std::string code = std::regex_replace(line, comment, " ");
  std::smatch included, match;
  if (!std::regex_match(code, included, include)) return;
  const std::string rest = included[3];
  if (std::regex_match(rest, list)) return;
  if (!std::regex_match(rest, match, name)) return refuse("an include that this check does not read");
  if (match[1].str().find("./") != std::string::npos) return refuse(match[1].str() + " is not named from the root");
  const std::optional<std::string> file = own_file(match[1]);
  if (!file) return;
  const std::optional<Row> other = row_of(table, *file);
  if (!other) refuse(*file + " stands in a folder without a row");
  else if (other->folder != own.folder && !own.may_include.contains(other->folder))
    refuse(own.folder + " may not include " + *file);
}

void find_faults(const std::vector<Row> &table, const fs::path &root, const std::string &file,
                 std::vector<Fault> &faults)
{
  const std::optional<Row> own = row_of(table, file);
  if (!own) return faults.push_back({file, 1, "stands in a folder without a row"});
  std::ifstream in(root / file);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) find_fault(table, *own, line, {file, number, {}}, faults);
}

std::vector<Fault> faults_under(const fs::path &root, int &files)
{
  const std::vector<Row> table = table_in(root / "CONTRIBUTING.md");
  std::vector<Fault> faults;
  static const std::set<std::string> endings = {".h", ".c", ".cpp", ".cl", ".def", ".inc"};
  for (const char *folder : {"shared", "cl", "minicl", "host", "tools", "tests"}) {
    if (!fs::exists(root / folder)) continue;
    for (const auto &entry : fs::recursive_directory_iterator(root / folder)) {
      if (!entry.is_regular_file() || !endings.contains(entry.path().extension().string())) continue;
      find_faults(table, root, fs::relative(entry.path(), root).generic_string(), faults);
      ++files;
    }
  }
  return faults;
}

int check(const fs::path &root)
{
  int files = 0;
  const std::vector<Fault> faults = faults_under(root, files);
  for (const Fault &fault : faults)
    std::cout << fault.file << ':' << fault.line << ": " << fault.what << " (CONTRIBUTING.md)\n";
  if (files == 0) throw std::runtime_error("no source under " + root.string());
  std::cout << files << " files read, " << faults.size() << " includes that the table does not allow\n";
  return !faults.empty();
}

void plant(const fs::path &file, const std::string &text)
{
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

const std::string planted_table =
    table_head + "\n|---|---|---|\n| `shared` | kernels | |\n| `host/include` | public | |\n"
                 "| `minicl` | lanes | `shared`, `host/include` |\n| `host/world` | worlds | all above |\n";

std::vector<Fault> faults_with(const fs::path &root, const std::string &file, const std::string &text)
{
  fs::remove_all(root);
  plant(root / "CONTRIBUTING.md", planted_table);
  plant(root / file, text);
  int files = 0;
  return faults_under(root, files);
}

bool is_refused(const std::function<void()> &work)
{
  try {
    work();
    return false;
  } catch (const std::runtime_error &) {
    return true;
  }
}

int self_test(const fs::path &root)
{
  int failures = 0;
  const auto expect = [&](bool right, const char *what) {
    if (!right) ++failures, std::cerr << "self-test: " << what << '\n';
  };
  expect(faults_with(root, "minicl/a.cpp", "#include <vector>\n#include \"shared/math.h\"\n#include <tandem/world.h>\n")
             .empty(),
         "what is allowed");
  expect(faults_with(root, "minicl/a.cpp", "\n#include \"host/world/world.h\"\n") ==
             std::vector<Fault>{{"minicl/a.cpp", 2, "minicl may not include host/world/world.h"}},
         "upwards");
  expect(faults_with(root, "shared/a.h", "# include <tandem/world.h>\n").size() == 1, "a public header from below");
  expect(faults_with(root, "host/world/a.cpp", "#include \"host/new/b.h\"\n").size() == 1,
         "an include of a folder without a row");
  expect(faults_with(root, "host/new/b.h", "").size() == 1, "a folder without a row");
  for (const char *spelling : {"#include \"../host/world/world.h\"", "#include /* here */ \"host/world/world.h\"",
                               "#/* here */include <tandem/../../world/world.h>", "#include HEADER",
                               "#define KERNEL_LIST \"host/world/world.def\""})
    expect(faults_with(root, "minicl/a.cpp", spelling + std::string("\n")).size() == 1, spelling);
  expect(faults_with(root, "minicl/a.cpp", "#include KERNEL_LIST\n").empty(), "a list by its name");
  expect(faults_with(root, "host/world/a.cpp", "#include \"minicl/b.h\"\n#include \"shared/b.h\"\n").empty(),
         "all above");
  plant(root / "CONTRIBUTING.md", table_head + "\n|---|---|---|\n| `a` | x | `b` |\n| `b` | x | `a` |\n");
  int files = 0;
  expect(is_refused([&] { faults_under(root, files); }), "a table with a circle");
  plant(root / "CONTRIBUTING.md", "no table\n");
  expect(is_refused([&] { faults_under(root, files); }), "no table");
  fs::remove_all(root);
  std::cout << "self-test: " << (failures ? "failed" : "every planted include is judged rightly") << '\n';
  return failures != 0;
}

} // namespace

int main(int count, char **arguments)
try {
  const std::vector<std::string> given(arguments + 1, arguments + count);
  if (given.size() == 2 && given[0] == "--self-test")
    return self_test(fs::path(given[1]) / "include-directions-self-test");
  if (given.size() == 1) return check(given[0]);
  throw std::runtime_error("usage: include_directions ROOT | --self-test DIR");
} catch (const std::exception &error) {
  std::cerr << "include_directions: " << error.what() << '\n';
  return 2;
}
