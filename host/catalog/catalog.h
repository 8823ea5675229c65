/* catalog.h - the scenes that need no file, such as `box-grid:nx=20,ny=20,nz=20`.
 *
 * There is one row for each scene: name, description, typed parameters with default and range, and the function that
 * builds it. The command's listing, the parser's error messages and the tests read the same rows. Most scenes have a
 * ground with its top at y = 0. All are deterministic (seeds, host/base/random.h) and start without deep overlaps.
 */
#pragma once

#include <map>
#include <span>
#include <string>

#include <tandem/load_scene.h>

namespace tandem {

struct SceneParameter {
  enum class Type { integer, real };
  const char *name;
  Type type;
  double default_value, minimum, maximum; /* range inclusive */
  const char *description;
};

/* The values of all parameters of a scene, by name; those not given have their defaults. */
using SceneValues = std::map<std::string, double, std::less<>>;

struct BuiltInScene {
  const char *name;
  const char *description;
  std::vector<SceneParameter> parameters;
  uint64_t (*body_count)(const SceneValues &);
  Scene (*build)(const SceneValues &);
};

/* A scene with more bodies than this is refused before any memory is allocated. */
inline constexpr uint64_t most_bodies = 64'000'000;
/* So is one whose bodies alone do not fit into so much memory, in the scene and in the world that copies it. */
void check_bodies(const std::string &scene, uint64_t bodies, uint64_t memory);

std::span<const BuiltInScene> built_in_scenes();

/* A built-in scene with values for all its parameters. */
struct SceneSpec {
  const BuiltInScene *scene;
  SceneValues values;
};

/* Parses `name` or `name:key=value,key=value`. Throws InputError that lists the valid names for an unknown scene, an
 * unknown or repeated parameter, a value that is malformed or out of range, or too many bodies. */
SceneSpec parse_scene_spec(const std::string &text);

/* Builds and validates a scene; Scene::name is the full specification, with all parameters. */
Scene build_scene(const SceneSpec &spec);

} // namespace tandem
