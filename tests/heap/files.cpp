/* files.cpp - every allocation fails in turn while scenes are read, built and written: a full memory is not a wrong file, what was there
 * is there still, and nothing half made is. */
#include <functional>
#include <string>
#include <vector>

#include "host/animation.h"
#include "host/contact_problem_file.h"
#include "host/scene_catalog.h"
#include "host/scene_json.h"
#include "host/world.h"
#include "tests/heap/attempt.h"
#include "tests/host/gltf_text.h"
#include "tests/tools/command_line.h"
#include "tools/event_file.h"
#include "tools/image.h"

using namespace tandem;
using namespace tests::heap;
using command_line::Scratch;

namespace {

namespace files = std::filesystem;

std::string of_tests(const std::string &name) { return TANDEM_SOURCE_DIR "/tests/scenes/" + name; }

void write(const std::string &path, const std::string &text) { std::ofstream(path, std::ios::binary) << text; }

/* Meshes, hulls, compounds, data in the file and beside it, materials and filters. */
std::vector<std::string> write_scenes(const Scratch &folder)
{
  using namespace gltf_text;
  write(folder.file("tip.obj"), "# a tip\nv 0 0 0\nv 3 0 0\nv 0 2 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  write(folder.file("obj.json"), R"({"tandem_scene": 1, "shapes": [{"type": "mesh", "obj": "tip.obj"}, {"type": "hull", "obj": "tip.obj", "scale": [2, 2, 2]}],
 "bodies": [{"name": "a rather long name of a body", "shape": 0, "density": 1000}, {"shape": 1, "density": 3, "position": [9, 0, 0]}]})");
  const std::string materials = R"("physicsMaterials":[{"restitution":0.25}],"collisionFilters":[{"collisionSystems":["a"],"collideWithSystems":["b"]}])";
  write(folder.file("mesh.gltf"), gltf({.nodes = cup_of(R"("mesh":0)"), .document = materials, .more = with_mesh(tip_points, tip_triangles)}));
  write(folder.file("hull.gltf"), gltf({.nodes = cup_of(R"("mesh":0,"convexHull":true)"), .document = materials, .more = with_mesh(tip_points, tip_triangles)}));
  write(folder.file("compound.gltf"), gltf({.nodes = R"({"name":"Cup","children":[1],"extensions":{"KHR_physics_rigid_bodies":{"motion":{},"collider":{"geometry":{"shape":0},"physicsMaterial":0}}}},)" +
                                                     collider(1, R"("translation":[0,2,0],)", R"(,"collisionFilter":0)"),
                                            .document = materials}));
  std::vector<std::string> scenes;
  for (const char *name : {"obj.json", "mesh.gltf", "hull.gltf", "compound.gltf"}) scenes.push_back(folder.file(name));
  for (const char *name : {"every_shape.json", "few_hulls.json", "few_trees.json", "three_bodies.json", "triggers.json", "tilted_box_on_plane.gltf"})
    scenes.push_back(of_tests(name));
  return scenes;
}

} // namespace

TEST_CASE("heap: a scene that memory does not suffice to read is not called wrong, and leaves nothing", "[sanitizer]")
{
  const Scratch folder;
  for (const std::string &scene : write_scenes(folder)) {
    CAPTURE(scene);
    const std::string whole = to_scene_json(load_scene(scene));
    const uint64_t n = fail_everywhere([&] { load_scene(scene); });
    std::printf("load %s: %lu\n", scene.c_str(), (unsigned long)n);
    CHECK(to_scene_json(load_scene(scene)) == whole);
  }
}
