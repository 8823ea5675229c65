/* Lists of backends and placements are read as users write them, and what names nothing is refused. */
#include <string>
#include <utility>
#include <vector>

#include <tandem/world.h>

#include "host/runtime/backend_list.h"
#include "tests/catch.h"

using namespace tandem;

TEST_CASE("backend list: options keep their commas", "[settings]")
{
  CHECK(split_backends("serial") == std::vector<std::string>{"serial"});
  CHECK(split_backends("serial,tbb:threads=2,lanes=4,cl:pocl") ==
        std::vector<std::string>{"serial", "tbb:threads=2,lanes=4", "cl:pocl"});
  CHECK(split_backends("tbb:threads=2,tbb:lanes=4,serial:order=backward").size() == 3);
  for (const char *bad : {"", ",", "serial,", ",tbb", "serial,,tbb"}) CHECK_THROWS_AS(split_backends(bad), InputError);
}

TEST_CASE("placement: stages and kernels, with options of backends", "[settings]")
{
  using Pairs = std::vector<std::pair<std::string, std::string>>;
  CHECK(parse_placement("solve=serial") == Pairs{{"solve", "serial"}});
  CHECK(parse_placement("narrowphase=tbb:threads=2,lanes=4,solve_contacts=cl:0.0") ==
        Pairs{{"narrowphase", "tbb:threads=2,lanes=4"}, {"solve_contacts", "cl:0.0"}});
  for (const char *bad : {"solve", "=serial", "solve=", "nowhere=serial", "lanes=4"})
    CHECK_THROWS_AS(parse_placement(bad), InputError);
  const Placement misspelt{"serial", {{"slove", "serial"}}};
  CHECK_THROWS_AS(validate(misspelt), InputError);
  Scene scene;
  scene.shapes = {sphere_shape(1)};
  scene.bodies.resize(1);
  CHECK_THROWS_AS(World(scene, {}, misspelt), InputError);
  World world(scene, {}, {"serial", {{"solve_contacts", "tbb"}, {"solve", "serial"}}});
  CHECK_THROWS_AS(world.place(misspelt), InputError);
  world.step();
}
