/* files.cpp - lets every allocation fail in turn while scenes are read, built and written. Exhausted memory must not be
 * reported as a wrong file, existing files must stay, and no partial file may appear. */
#include <functional>
#include <string>
#include <vector>

#include <tandem/world.h>

#include "host/catalog/catalog.h"
#include "host/io/contact_problem/file.h"
#include "host/io/glb/animation.h"
#include "host/io/json/scene.h"
#include "tests/heap/attempt.h"
#include "tests/host/io/gltf/gltf_text.h"
#include "tests/tools/command/command_line.h"
#include "tools/plot/image.h"
#include "tools/run/event_file.h"

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
  write(folder.file("obj.json"),
        R"({"tandem_scene": 1, "shapes": [{"type": "mesh", "obj": "tip.obj"}, {"type": "hull", "obj": "tip.obj",)"
        R"( "scale": [2, 2, 2]}],
 "bodies": [{"name": "a rather long name of a body", "shape": 0, "density": 1000}, {"shape": 1, "density": 3,)"
        R"( "position": [9, 0, 0]}]})");
  const std::string materials =
      R"("physicsMaterials":[{"restitution":0.25}],"collisionFilters":[{"collisionSystems":["a"],)"
      R"("collideWithSystems":["b"]}])";
  write(folder.file("mesh.gltf"),
        gltf({.nodes = cup_of(R"("mesh":0)"), .document = materials, .more = with_mesh(tip_points, tip_triangles)}));
  write(folder.file("hull.gltf"), gltf({.nodes = cup_of(R"("mesh":0,"convexHull":true)"),
                                        .document = materials,
                                        .more = with_mesh(tip_points, tip_triangles)}));
  write(folder.file("compound.gltf"),
        gltf({.nodes = R"({"name":"Cup","children":[1],"extensions":{"KHR_physics_rigid_bodies":{"motion":{},)"
                       R"("collider":{"geometry":{"shape":0},"physicsMaterial":0}}}},)" +
                       collider(1, R"("translation":[0,2,0],)", R"(,"collisionFilter":0)"),
              .document = materials}));
  write(folder.file("joints.gltf"),
        gltf({.nodes = R"({"name":"Hinge","extensions":{"KHR_physics_rigid_bodies":{"joint":{"connectedNode":1,)"
                       R"("joint":0}}}},{"name":"Pin"},{"name":"Cup","children":[1],"extensions":)"
                       R"({"KHR_physics_rigid_bodies":{"motion":{"mass":2},"collider":{"geometry":{"shape":0}}}}})",
              .document =
                  R"("physicsJoints":[{"limits":[{"linearAxes":[0,1,2],"min":0,"max":0},)"
                  R"({"angularAxes":[1,2],"min":0,"max":0},{"angularAxes":[0],"min":-1,"max":1}],)"
                  R"("drives":[{"type":"angular","mode":"acceleration","axis":0,"stiffness":3,"damping":1}]}])"}));
  std::vector<std::string> scenes;
  for (const char *name : {"obj.json", "mesh.gltf", "hull.gltf", "compound.gltf", "joints.gltf"})
    scenes.push_back(folder.file(name));
  for (const char *name : {"every_shape.json", "few_hulls.json", "few_trees.json", "three_bodies.json", "triggers.json",
                           "tilted_box_on_plane.gltf", "arm.urdf", "four_bar.xml"})
    scenes.push_back(of_tests(name));
  return scenes;
}

size_t names_in(const Scratch &folder)
{
  return static_cast<size_t>(std::distance(files::directory_iterator(folder.path), {}));
}

/* The old contents are unchanged, or all that was to be written is there, and there is no other file. */
void check_written_whole_or_not(const char *name, const std::function<void(const std::string &)> &write_to)
{
  const Scratch folder;
  const std::string path = folder.file(name);
  write_to(path);
  const std::string whole = command_line::contents(path), old = "what stood there";
  REQUIRE(whole.size() > 100);
  const auto check = [&](const Outcome &outcome) {
    CHECK(command_line::contents(path) == (outcome.thrown ? old : whole));
    CHECK(names_in(folder) == 1);
  };
  fail_everywhere([&] { write_to(path); }, [&] { write(path, old); }, check);
}

} // namespace

TEST_CASE("heap: a scene that memory does not suffice to read is not called wrong, and leaves nothing", "[sanitizer]")
{
  const Scratch folder;
  for (const std::string &scene : write_scenes(folder)) {
    CAPTURE(scene);
    const std::string whole = to_scene_json(load_scene(scene));
    fail_everywhere([&] { load_scene(scene); });
    CHECK(to_scene_json(load_scene(scene)) == whole);
  }
}

TEST_CASE("heap: a built-in scene that memory does not suffice to build leaves nothing", "[sanitizer]")
{
  for (const char *scene : {"box-grid:nx=2,ny=2,nz=2", "compounds:n=2", "mixed:n=3", "rolling"}) {
    CAPTURE(scene);
    fail_everywhere([&] { load_scene(scene); });
  }
}

TEST_CASE("heap: a contact problem that memory does not suffice to read is not called wrong", "[sanitizer]")
{
  for (const char *problem : {"box-on-corners.dat", "contact-sliding.dat"})
    fail_everywhere([&] { read_contact_problem(of_tests(problem)); });
}

TEST_CASE("heap: a file that memory does not suffice to write is what it was before", "[sanitizer]")
{
  const Scene scene = load_scene("box-grid:nx=2,ny=1,nz=1");
  check_written_whole_or_not("scene.json", [&](const std::string &path) { write_scene_json(scene, path); });
  check_written_whole_or_not("motion.glb", [&](const std::string &path) {
    AnimationWriter writer(scene, path);
    std::vector<Vec3> positions(scene.bodies.size(), Vec3{0, 1, 0});
    const std::vector<Quat> orientations(scene.bodies.size(), Quat{0, 0, 0, 1});
    for (int frame = 0; frame < 3; ++frame) {
      positions.front()[0] += 1;
      writer.add_frame(frame, positions, orientations);
    }
    writer.finish();
  });
  Settings settings;
  settings.events = true;
  World world(scene, settings, Placement{"serial", {}, false});
  for (int k = 0; k < 3; ++k) world.step();
  check_written_whole_or_not("events.json", [&](const std::string &path) {
    EventFile file(path, "a scene", world);
    for (uint64_t step = 0; step < 3; ++step) file.add_step(step, world);
    file.finish();
  });
  check_written_whole_or_not(
      "picture.png", [&](const std::string &path) { write_png(path, draw(world, camera_for(world, 16, 9)), 16, 9); });
}

/* The name of the file is so long that the folder takes no name beside it. The new contents are then copied over the
 * old ones. */
TEST_CASE("heap: a file that is written in its place is what it was before, or whole", "[sanitizer]")
{
  const Scene scene = load_scene("box-grid:nx=2,ny=1,nz=1");
  const std::string long_name(250, 'x');
  check_written_whole_or_not(long_name.c_str(), [&](const std::string &path) {
    if (!files::exists(path)) write(path, "");
    write_scene_json(scene, path);
  });
}
