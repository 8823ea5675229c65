/* One result for every compiler, optimisation level and machine: hashes of the bodies, written down.
 *
 * A change of the physics or of a scene changes them; then, and only then, write them anew and say why in the commit:
 *
 *     TANDEM_WRITE_GOLDEN=1 build/release/bin/tandem_tests "parity on CPU: hashes written down"
 */
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tests/parity/parity.h"

using namespace tandem;
using nlohmann::json;

namespace {

std::string body_hash_of(const json &golden, const std::string &backend)
{
  World world(load_scene(golden.at("scene")), {}, Placement{backend, {}, false});
  for (uint64_t k = 0; k < golden.at("steps").get<uint64_t>(); ++k) world.step();
  return fmt::format("{:016x}", world.body_hash());
}

json read_json(const std::filesystem::path &path)
{
  std::ifstream file(path);
  REQUIRE(file);
  return json::parse(file);
}

std::vector<std::filesystem::path> golden_files()
{
  std::vector<std::filesystem::path> files;
  for (const auto &entry : std::filesystem::directory_iterator(TANDEM_SOURCE_DIR "/tests/golden"))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  return files;
}

} // namespace

TEST_CASE("parity on CPU: hashes written down")
{
  const std::vector<std::filesystem::path> files = golden_files();
  REQUIRE(files.size() >= 3);
  for (const auto &path : files) {
    json golden = read_json(path);
    CAPTURE(path.string());
    if (std::getenv("TANDEM_WRITE_GOLDEN")) {
      golden["body_hash"] = body_hash_of(golden, "serial");
      std::ofstream(path) << golden.dump(2) << "\n";
      WARN(path.string() << " written");
    }
    for (const char *backend : {"serial", "tbb:threads=2,lanes=4", "tbb"}) {
      CAPTURE(backend);
      CHECK(body_hash_of(golden, backend) == golden.at("body_hash").get<std::string>());
    }
  }
}
