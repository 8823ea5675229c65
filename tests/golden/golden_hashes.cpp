/* golden_hashes.cpp - holds all compilers, optimisation levels, processors and widths to one result: hashes written
 * down.
 *
 * It is a program of its own that needs only the library, so that trees of other compilers and processors build little.
 * A change of the physics or of a scene changes the hashes. Only then are they written anew, and the commit states why:
 *
 *     build/release/bin/golden_hashes --write
 *
 * A row of tests/golden/hashes.txt holds scene, solver, steps, and three hashes: of the bodies after the last step, of
 * the whole state then (contact cache and counts), and of the contact events of every step. A row with the scene and
 * solver of the row above continues that run. --steps N leaves out rows of more than N steps, for slow builds (without
 * optimisation, or emulated).
 */
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <tandem/world.h>

#include "host/base/hash.h"
#include "host/catalog/catalog.h"

namespace {

using namespace tandem;

struct Row {
  std::string scene, solver;
  uint64_t steps = 0;
  std::string bodies, state, events;
};

template <class Number> uint64_t hash_of(const Number &number, uint64_t seed)
{
  return hash_bytes(&number, sizeof number, seed);
}

/* Field by field: what fills the gaps between them is no result. */
uint64_t hash_of_event(const ContactEvent &event, uint64_t hash)
{
  for (const uint32_t x : {static_cast<uint32_t>(event.kind), event.a, event.b, event.trigger ? 1u : 0u, event.points})
    hash = hash_of(x, hash);
  for (const float x : {event.impulse, event.separation, event.normal[0], event.normal[1], event.normal[2]})
    hash = hash_of(x, hash);
  for (const double x : event.point) hash = hash_of(x, hash);
  return hash;
}

/* Computes the hashes of rows as this build does; a row that goes on from the last one takes only the steps between. */
class Computer {
public:
  explicit Computer(const std::string &backend) : backend_(backend) {}

  Row computed(Row row)
  {
    if (!world_ || row.scene != last_.scene || row.solver != last_.solver || row.steps < last_.steps) begin(row);
    for (; last_.steps < row.steps; ++last_.steps) {
      world_->step();
      for (const ContactEvent &event : world_->contact_events()) events_ = hash_of_event(event, events_);
    }
    row.bodies = fmt::format("{:016x}", world_->body_hash());
    row.state = fmt::format("{:016x}", world_->state_hash());
    row.events = fmt::format("{:016x}", events_);
    return row;
  }

private:
  void begin(const Row &row)
  {
    Settings settings = settings_for(parse_setting<Solver>(row.solver));
    settings.events = true;
    world_.emplace(load_scene(row.scene), settings, Placement{backend_, {}, false});
    last_ = {row.scene, row.solver, 0, {}, {}, {}};
    events_ = 0;
  }

  std::string backend_;
  std::optional<World> world_;
  Row last_;
  uint64_t events_ = 0;
};

std::string text_of(const Row &row)
{
  return fmt::format("{:<40} {:<9} {:>5}  {}  {}  {}", row.scene, row.solver, row.steps, row.bodies, row.state,
                     row.events);
}

bool is_comment(const std::string &line) { return line.empty() || line[0] == '#'; }

std::vector<std::string> lines_of(const std::string &path)
{
  std::ifstream file(path);
  if (!file) throw InputError(path + ": cannot be read; start golden_hashes in the root of the sources");
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

/* A new row may leave the hashes out until they are written. */
Row row_of_line(const std::string &line)
{
  Row row;
  std::istringstream text(line);
  if (!(text >> row.scene >> row.solver >> row.steps))
    throw InputError(fmt::format("'{}' is no row; scene, solver and steps are needed", line));
  text >> row.bodies >> row.state >> row.events;
  return row;
}

void write(const std::string &path)
{
  std::vector<std::string> lines = lines_of(path);
  Computer computer("serial");
  for (std::string &line : lines)
    if (!is_comment(line)) line = text_of(computer.computed(row_of_line(line)));
  std::ofstream file(path);
  for (const std::string &line : lines) file << line << '\n';
  if (!file.flush()) throw InputError(path + ": cannot be written");
}

/* How many rows this build computes otherwise. */
int compare(const std::string &path, const std::string &backend, uint64_t most_steps)
{
  int rows = 0, different = 0;
  Computer computer(backend);
  for (const std::string &line : lines_of(path)) {
    if (is_comment(line)) continue;
    const Row wanted = row_of_line(line);
    if (wanted.steps > most_steps) continue;
    const Row found = computer.computed(wanted);
    const bool equal = wanted.bodies == found.bodies && wanted.state == found.state && wanted.events == found.events;
    std::cout << (equal ? "equal      " : "DIFFERENT  ") << text_of(found) << std::endl;
    if (!equal) std::cout << "  wanted   " << text_of(wanted) << '\n';
    ++rows;
    different += !equal;
  }
  if (rows == 0) throw InputError(fmt::format("{}: no rows of at most {} steps", path, most_steps));
  std::cout << fmt::format("{}: {} of {} rows are equal\n", backend, rows - different, rows);
  return different;
}

} // namespace

int main(int count, char **arguments)
try {
  const std::string path = "tests/golden/hashes.txt";
  std::vector<std::string> given(arguments + 1, arguments + count);
  if (given == std::vector<std::string>{"--write"}) return write(path), 0;
  uint64_t most_steps = ~uint64_t{0};
  if (given.size() > 2 && given[0] == "--steps") {
    most_steps = std::stoull(given[1]);
    given.erase(given.begin(), given.begin() + 2);
  }
  if (given.empty() || given[0].starts_with("-"))
    throw InputError("usage: golden_hashes --write | [--steps N] BACKEND...");
  int different = 0;
  for (const std::string &backend : given) different += compare(path, backend, most_steps);
  return different != 0;
} catch (const std::exception &error) {
  std::cerr << "golden_hashes: " << error.what() << '\n';
  return 2;
}
