/* spheres.cpp - a library for spheres alone: it has the kernels of its features and no others, gives the bits of the
 * full one, and refuses what needs more, in the first moment and later. */
#include <tandem/error.h>
#include <tandem/world.h>
#include <tandem/worlds.h>

#include "host/catalog/catalog.h"
#include "host/runtime/interface/built_features.h"
#include "host/runtime/opencl/program.h"
#include "minicl/kernel_table.h"
#include "tests/host/runtime/opencl/opencl_device.h"
#include "tests/host/world/bodies.h"
#include "tests/tools/command/command_line.h"

using namespace tandem;
using namespace command_line;
using Catch::Matchers::ContainsSubstring;

namespace {

Result small_command(const std::string &arguments) { return shell("'" TANDEM_OF_SPHERES "' " + arguments); }

/* With one line, which ends so. */
void check_refused_by_small(const std::string &arguments, const std::string &line)
{
  const Result result = small_command(arguments);
  INFO(arguments << "\nstderr: " << result.error);
  CHECK(result.status == 2);
  CHECK(result.error.starts_with("tandem: "));
  CHECK(result.error.ends_with(line + "\n"));
  CHECK(std::count(result.error.begin(), result.error.end(), '\n') == 1);
}

std::string hash_of(const Result &result)
{
  INFO(result.error);
  REQUIRE(result.status == 0);
  return Json::parse(result.out)["hash"];
}

void require_same_hash(const std::string &run)
{
  INFO(run);
  const std::string expected = hash_of(command(run + " --on serial --json -"));
  for (const char *backend : {"serial", "tbb:threads=2,lanes=1", "tbb:threads=2,lanes=4"})
    REQUIRE(hash_of(small_command(run + " --json - --on " + backend)) == expected);
}

bool is_kept(const KernelRow &row) { return row.feature == 0 || (row.feature & built_features()) != 0; }

bool is_embedded(const KernelRow &row)
{
  for (const EmbeddedProgram &program : embedded_programs())
    for (const EmbeddedEntry &entry : program.entries)
      if (std::string(entry.kernel) == row.name) return true;
  return false;
}

BodyProperties locked()
{
  BodyProperties properties;
  properties.linear_locks = Axes{true, false, false};
  return properties;
}

bool has_lanes(const KernelRow &row)
{
  return row.execution == Execution::lanes || row.execution == Execution::lanes_padded;
}

} // namespace

TEST_CASE("a library for spheres has the kernels of its features, and no others")
{
  CHECK(built_features() == (FEATURE_SPHERE_SPHERE | FEATURE_SPHERE_HALF_SPACE | FEATURE_FRICTION |
                             FEATURE_RESTITUTION | FEATURE_SUBSTEP_WARM_START | FEATURE_WORLDS | FEATURE_XPBD));
  for (size_t k = 0; k < kernel_count; ++k) {
    const KernelRow &row = row_of(kernel_at(k));
    if (row.execution == Execution::host) continue;
    INFO(row.name);
    CHECK((minicl::scalar_kernels.run[k] != nullptr) == is_kept(row));
    const bool in_lanes = minicl::lanes4_kernels.run[k] != nullptr;
    if (row.execution == Execution::group) CHECK((!in_lanes || is_kept(row))); /* some groups have lanes */
    else CHECK(in_lanes == (is_kept(row) && has_lanes(row)));
    CHECK(is_embedded(row) == is_kept(row));
  }
}

TEST_CASE("a library for spheres embeds no header of kernels that it lacks")
{
  const std::string narrowphase = opencl::headers_of(opencl::embedded_program("narrowphase"));
  CHECK_THAT(narrowphase, ContainsSubstring("void collide_sphere_sphere_item("));
  for (const char *absent : {"collide_box_box_item(", "collide_convex_item(", "find_separating_axis_item("})
    CHECK_THAT(narrowphase, !ContainsSubstring(absent));
}

TEST_CASE("a library for spheres: its programs build without the headers that are left out")
{
  const opencl::DeviceContext context(test_device());
  for (const EmbeddedProgram &program : embedded_programs())
    if (std::string(program.name) != "phases") {
      INFO(program.name);
      CHECK_NOTHROW(opencl::build_program(context, program, "-D FEATURES=0x9ul"));
    }
}

TEST_CASE("a library for spheres gives the bits of the full one")
{
  require_same_hash("run spheres:n=300,seed=3 --steps 60");
  require_same_hash("run spheres:n=100,restitution=0.7 --steps 60 --solver jacobi");
  require_same_hash("run spheres:n=100 --steps 60 --no-specialise --broadphase sap --substeps auto");
  require_same_hash("run spheres:n=40 --steps 200 --sleep --solver xpbd");
  require_same_hash("run bounce --steps 60 --solver direct");
  require_same_hash("run spheres:n=30 --steps 40 --worlds 3");
}

TEST_CASE("a library for spheres draws as the full one")
{
  const Scratch scratch;
  const std::string drawn = "run spheres:n=20 --steps 30 --on serial --image ";
  REQUIRE(command(drawn + scratch.file("full.png")).status == 0);
  REQUIRE(small_command(drawn + scratch.file("small.png")).status == 0);
  CHECK(contents(scratch.file("full.png")) == contents(scratch.file("small.png")));
}

TEST_CASE("a library for spheres casts shapes of any kind: closed forms")
{
  Scene scene;
  scene.shapes = {sphere_shape(1)};
  scene.bodies = {body_at({0, 0, 0})};
  World world(scene, {}, {"serial", {}});
  const Vec3 octahedron[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const Pose above{{0, 4, 0}, {0, 0, 0, 1}};
  const auto fraction_of = [&](const Shape &shape, Vec3 displacement) {
    return world.cast_shapes(shape, std::span(&above, 1), std::span(&displacement, 1)).front().fraction;
  };
  CHECK(fraction_of(box_shape(0.5f, 0.5f, 0.5f), {0, -5, 0}) == Approx(0.5).margin(2e-5));
  CHECK(fraction_of(hull_shape(octahedron, "octahedron"), {0, -4, 0}) == Approx(0.5).margin(2e-5));
  CHECK(fraction_of(capsule_shape(0.5f, 1), {0, -3, 0}) == Approx(0.5).margin(2e-5));
}

TEST_CASE("a library for spheres refuses scenes and settings that need more")
{
  check_refused_by_small("run falling-boxes:n=2 --on serial",
                         ": body 1 needs BOX_BOX (a moving box beside another box), which this library is "
                         "built without; one that is configured with -DTANDEM_FEATURES=\"spheres;WORLDS;XPBD;BOX_BOX;"
                         "BOX_HALF_SPACE;SEVERAL_POINTS\" has all that is needed");
  const Scratch scratch;
  check_refused_by_small("run spheres:n=2 --events " + scratch.file("events.json"),
                         ": the settings need EVENTS (contact events, where the user asks for them), which this "
                         "library is built without; one that is configured with "
                         "-DTANDEM_FEATURES=\"spheres;WORLDS;XPBD;EVENTS\" has all that is needed");
  check_refused_by_small("run spheres:n=2 --solver nncg --on serial",
                         ": the settings need PGS (the solvers pgs and nncg), which this library is built without; one "
                         "that is configured with -DTANDEM_FEATURES=\"spheres;WORLDS;XPBD;PGS;NNCG\" has all that is "
                         "needed");
  const std::string recording = scratch.file("boxes.tandem");
  REQUIRE(command("run falling-boxes:n=2 --steps 3 --on serial --record " + recording).status == 0);
  const Result replayed = small_command("replay " + recording + " --on serial");
  CHECK(replayed.status == 2);
  CHECK_THAT(replayed.error, ContainsSubstring("body 1 needs BOX_BOX"));
  CHECK_THROWS_WITH(Worlds(load_scene("falling-boxes:n=2"), 3, {}, {"serial", {}}),
                    ContainsSubstring("body 1 needs BOX_BOX"));
}

TEST_CASE("a library for spheres says in its plan what it is built for")
{
  const Result plan = small_command("plan spheres:n=2 --on serial");
  CHECK(plan.status == 0);
  CHECK_THAT(plan.out,
             ContainsSubstring("library: built for TANDEM_FEATURES=\"spheres;WORLDS;XPBD\"; for such scenes alone: "
                               "-DTANDEM_FEATURES=\"SPHERE_SPHERE;SPHERE_HALF_SPACE;FRICTION;SUBSTEP_WARM_START\"\n"));
  CHECK_THAT(command("plan spheres:n=2 --on serial").out, ContainsSubstring("library: built for all features; "));
}

TEST_CASE("a world that is refused a feature goes on as if it had not been asked for")
{
  const Scene scene = load_scene("spheres:n=20");
  World asked(scene, {}, {"serial", {}}), left_alone(scene, {}, {"serial", {}});
  for (int step = 0; step < 40; ++step) {
    if (step % 10 == 5) {
      const BodyId body = asked.id_of(3);
      const BodyProperties properties = locked();
      CHECK_THROWS_WITH(asked.set_properties(std::span(&body, 1), std::span(&properties, 1)),
                        ContainsSubstring("body 3 needs GYROSCOPIC (a moving body whose principal moments differ, or "
                                          "with locked axes)") &&
                            ContainsSubstring("GYROSCOPIC;LOCKS"));
      Body trigger = body_at({0, 50, 0}, scene.bodies[3].shape);
      trigger.trigger = true;
      CHECK_THROWS_AS(asked.create_bodies(std::span(&trigger, 1)), InputError);
    }
    asked.step();
    left_alone.step();
    REQUIRE(asked.state_hash() == left_alone.state_hash());
  }
  const Body sphere = body_at({0, 50, 0}, scene.bodies[3].shape);
  CHECK(asked.create_bodies(std::span(&sphere, 1)).size() == 1);
}

TEST_CASE("a body that is refused a feature in its sleep sleeps on")
{
  Settings settings;
  settings.sleeping = true;
  World world(load_scene("spheres:n=1,height=0"), settings, {"serial", {}});
  for (int step = 0; step < 200 && world.statistics().asleep == 0; ++step) world.step();
  REQUIRE(world.statistics().asleep == 1);
  const BodyId body = world.id_of(1);
  const BodyProperties properties = locked();
  CHECK_THROWS_AS(world.set_properties(std::span(&body, 1), std::span(&properties, 1)), InputError);
  CHECK(world.statistics().asleep == 1);
  world.step();
  CHECK(world.statistics().asleep == 1);
}

TEST_CASE("a batch that is refused a feature goes on as if it had not been asked for")
{
  const Scene scene = load_scene("spheres:n=10");
  Worlds asked(scene, 3, {}, {"serial", {}}), left_alone(scene, 3, {}, {"serial", {}});
  const WorldBody body{1, 4};
  const BodyProperties properties = locked();
  const uint32_t world = 1;
  for (int step = 0; step < 20; ++step) {
    if (step == 8)
      CHECK_THROWS_WITH(asked.set_properties(std::span(&body, 1), std::span(&properties, 1)),
                        ContainsSubstring("needs GYROSCOPIC"));
    if (step == 12)
      for (Worlds *worlds : {&asked, &left_alone}) worlds->reset(std::span(&world, 1));
    asked.step();
    left_alone.step();
    REQUIRE(asked.state_hashes() == left_alone.state_hashes());
  }
}
