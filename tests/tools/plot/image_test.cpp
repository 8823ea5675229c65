/* Images by ray casting: the positions of bodies in the image, light and shadow, the same bytes on every backend. */
#include "host/catalog/catalog.h"
#include "tests/catch.h"
#include "tests/physics/physics.h"
#include "tools/plot/image.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

using Pixel = std::array<int, 3>;

Pixel pixel(const std::vector<uint8_t> &image, const Camera &camera, uint32_t x, uint32_t y)
{
  const size_t at = 3 * (size_t{y} * camera.width + x);
  return {image.at(at), image.at(at + 1), image.at(at + 2)};
}
int brightness(const Pixel &p) { return p[0] + p[1] + p[2]; }

/* A ball on a floor, seen from the front; the light comes from above, the right and the front. */
Scene ball_on_floor()
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_body(scene, BodyType::dynamic, sphere_shape(1), {0, 1, 0});
  return scene;
}

} // namespace

TEST_CASE("a picture shows the ball in the middle, sky above, floor below, and its shadow")
{
  World world(ball_on_floor());
  const Camera camera = camera_from("0,1,10,0,1,0", 160, 100);
  const std::vector<uint8_t> image = draw(world, camera);
  REQUIRE(image.size() == 3 * 160 * 100);
  const Pixel ball = pixel(image, camera, 80, 50), sky = pixel(image, camera, 80, 5),
              floor = pixel(image, camera, 150, 90);
  CHECK(sky[2] > sky[0]);                                                /* blue */
  CHECK(std::abs(floor[0] - floor[2]) < 20);                             /* grey */
  CHECK(std::abs(ball[0] - ball[2]) + std::abs(ball[0] - ball[1]) > 40); /* in colour */
  /* Half of the ball's height at 10 m is 50 pixels of tan 20 degrees: 13.7. */
  CHECK(pixel(image, camera, 80, 50 - 12) != sky);
  CHECK(pixel(image, camera, 80, 50 - 17)[2] > pixel(image, camera, 80, 50 - 17)[0]);
  /* The light stands to the right, so the left side of the ball and the floor to its left are dark. */
  CHECK(brightness(pixel(image, camera, 90, 46)) > brightness(pixel(image, camera, 70, 46)));
}

TEST_CASE("shadows lie where the ball is between floor and light")
{
  World world(ball_on_floor());
  const Camera camera = camera_from("0,12,0.1,0,0,0", 200, 200); /* from above; x to the right, z down */
  const std::vector<uint8_t> image = draw(world, camera);
  /* The ball's shadow lies about (-0.5, -0.35), where the light through its centre meets the floor, and reaches 1.17 m
   * (1 over the sine of the light's height) beyond that, away from the light: 1.78 m. The ball itself hides what is
   * nearer than 1.10 m to the middle of the picture. 1.44 m is between; 100 pixels are 4.37 m. */
  const int shadow = brightness(pixel(image, camera, 100 - 27, 100 - 19)),
            lit = brightness(pixel(image, camera, 100 + 27, 100 + 19));
  CHECK(shadow < lit - 60);
}

TEST_CASE("a picture shows bodies that sleep in grey, and in their colour when they wake")
{
  Settings settings;
  settings.sleeping = true;
  World world(ball_on_floor(), settings);
  const Camera camera = camera_from("0,1,10,0,1,0", 80, 50);
  const auto saturation_of_ball = [&] {
    const Pixel ball = pixel(draw(world, camera), camera, 40, 25);
    return std::abs(ball[0] - ball[2]) + std::abs(ball[0] - ball[1]);
  };
  CHECK(saturation_of_ball() > 40);
  for (int k = 0; k < 120 && !world.is_asleep(world.id_of(1)); ++k) world.step();
  REQUIRE(world.is_asleep(world.id_of(1)));
  CHECK(saturation_of_ball() < 20);
  world.wake_body(world.id_of(1));
  CHECK(saturation_of_ball() > 40);
}

TEST_CASE("a picture has the same bytes on every backend, and its camera finds what there is to see")
{
  std::vector<uint8_t> first;
  for (const char *backend : {"serial", "tbb:threads=3"}) {
    World world(load_scene("shapes:n=30"), {}, {backend, {}});
    for (int k = 0; k < 3; ++k) world.step();
    const Camera camera = camera_for(world, 64, 48);
    const std::vector<uint8_t> image = draw(world, camera);
    if (first.empty()) first = image;
    CHECK(image == first);
  }
  World alone(ball_on_floor());
  const Camera camera = camera_for(alone, 100, 100);
  const std::vector<uint8_t> image = draw(alone, camera);
  CHECK(pixel(image, camera, 50, 50) != pixel(image, camera, 2, 98));
  Scene bare = empty_scene();
  add_ground(bare);
  World floor(bare);
  CHECK(draw(floor, camera_for(floor, 1, 1)).size() == 3);
}
