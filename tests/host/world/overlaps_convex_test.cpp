/* Overlap tests of all shapes against distances in double precision, by a hair on either side of touching. */
#include "tests/catch.h"
#include "tests/host/scene/shape_points.h"
#include "tests/host/world/convex_distance.h"

using namespace tandem;
using namespace tandem::physics_tests;
using namespace tandem::shape_points;
using namespace tandem::convex_distance;

namespace {

Shape hammer()
{
  std::vector<Child> children(3);
  children[0].shape = sphere_shape(0.4f);
  children[0].position = {0.5f, 0, 0};
  children[1].shape = cone_shape(0.3f, 0.5f);
  children[1].position = {-0.5f, 0.1f, 0};
  children[2].shape = capsule_shape(0.1f, 0.5f);
  children[2].orientation = turn_about({1, 2, 3}, 1);
  return compound_shape(children);
}

Scene one_body(Random &random, uint32_t kind)
{
  Scene scene = empty_scene({0, 0, 0});
  if (kind == 0) add_body(scene, BodyType::fixed, hammer(), {0, 0, 0}).orientation = random.orientation();
  else if (kind == 1)
    add_body(scene, BodyType::fixed, any_height_field(random, 6, 0.5f), {0, 0, 0}).orientation = random.orientation();
  else add_any(scene, random, {0, 0, 0});
  return scene;
}

} // namespace

/* Each shape is moved along the normal of the least distance until that distance is a hair, or a hair beyond nothing. A
 * sharp tip may then pass the other shape, so the distance of the second pose is asked too. */
TEST_CASE("overlap tests of any two shapes tell what misses by a hair from what overlaps by one")
{
  Random random(62);
  size_t tested = 0;
  for (int round = 0; round < 400; ++round) {
    const Scene scene = one_body(random, uint32_t(round % 5));
    const Shape shape = any_shape(random);
    const Vector away = 9 * direction(random);
    const Quat turn = random.orientation();
    const std::vector<Solid> query = solids_of(shape, {point_of(away), turn}), body = solids_of(scene, scene.bodies[0]);
    const DistanceBounds distance = distance_between(query, body);
    const double size = query[0].reach() + body[0].reach(), hair = 2e-6 * size;
    if (distance.lower < 0.1 || distance.upper - distance.lower > 0.1 * hair) continue;
    const std::vector<Pose> poses{{point_of(away + (distance.lower - hair) * distance.normal), turn},
                                  {point_of(away + (distance.upper + hair) * distance.normal), turn}};
    World world(scene, {}, {"serial", {}});
    const std::vector<std::vector<uint32_t>> found = world.overlap_shapes(shape, poses);
    const bool enters = distance_between(solids_of(shape, poses[1]), body).upper <= 0;
    CAPTURE(round, int(shape.type), int(scene.shapes[0].type), size);
    CHECK(found[0].empty());
    if (enters) CHECK(found[1].size() == 1);
    tested += enters;
  }
  CHECK(tested > 200);
}
