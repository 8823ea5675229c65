/* golden_hashes.cpp - what every compiler, optimisation level, processor and width must compute: hashes written down.
 *
 * A program of its own, which needs the library alone, so that trees of other compilers and processors build little. A
 * change of the physics or of a scene changes the hashes; then, and only then, write them anew and say why in the
 * commit:
 *
 *     build/release/bin/golden_hashes --write
 *
 * Rows of tests/golden/hashes.txt: scene, solver, steps, and three hashes - of the bodies after the last step, of the
 * whole state then (contact cache and counts), and of the contact events of every step.
 */
#include <fstream>
#include <iostream>
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

/* The row with the hashes that this build computes. */
Row computed(Row row, const std::string &backend)
{
  Settings settings = settings_for(row.solver);
  settings.events = true;
  World world(load_scene(row.scene), settings, Placement{backend, {}, false});
  uint64_t events = 0;
  for (uint64_t step = 0; step < row.steps; ++step) {
    world.step();
    for (const ContactEvent &event : world.contact_events()) events = hash_of_event(event, events);
  }
  row.bodies = fmt::format("{:016x}", world.body_hash());
  row.state = fmt::format("{:016x}", world.state_hash());
  row.events = fmt::format("{:016x}", events);
  return row;
}

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
  for (std::string &line : lines)
    if (!is_comment(line)) line = text_of(computed(row_of_line(line), "serial"));
  std::ofstream file(path);
  for (const std::string &line : lines) file << line << '\n';
  if (!file.flush()) throw InputError(path + ": cannot be written");
}

/* How many rows this build computes otherwise. */
int compare(const std::string &path, const std::string &backend)
{
  int rows = 0, different = 0;
  for (const std::string &line : lines_of(path)) {
    if (is_comment(line)) continue;
    const Row wanted = row_of_line(line), found = computed(wanted, backend);
    const bool equal = wanted.bodies == found.bodies && wanted.state == found.state && wanted.events == found.events;
    std::cout << (equal ? "equal      " : "DIFFERENT  ") << text_of(found) << std::endl;
    if (!equal) std::cout << "  wanted   " << text_of(wanted) << '\n';
    ++rows;
    different += !equal;
  }
  if (rows == 0) throw InputError(path + ": no rows");
  std::cout << fmt::format("{}: {} of {} rows are equal\n", backend, rows - different, rows);
  return different;
}

} // namespace

int main(int count, char **arguments)
try {
  const std::string path = "tests/golden/hashes.txt";
  const std::vector<std::string> given(arguments + 1, arguments + count);
  if (given == std::vector<std::string>{"--write"}) return write(path), 0;
  if (given.empty() || given[0].starts_with("-")) throw InputError("usage: golden_hashes --write | BACKEND...");
  int different = 0;
  for (const std::string &backend : given) different += compare(path, backend);
  return different != 0;
} catch (const std::exception &error) {
  std::cerr << "golden_hashes: " << error.what() << '\n';
  return 2;
}
