/* All pair kinds, mixed, at every width and in both orders: the same bits in every word of every output. */
#include "tests/catch.h"
#include "tests/shared/narrowphase/pairs.h"

using namespace tandem;
using namespace tandem::narrowphase_tests;

namespace {

constexpr uint32_t code_of_middle_ball = 0x800000u << 8; /* shared/narrowphase/middle_ball.h */

const std::vector<Kernel> lane_kernels = {
    Kernel::collide_sphere_sphere,     Kernel::collide_sphere_box,      Kernel::collide_box_box,
    Kernel::collide_sphere_half_space, Kernel::collide_box_half_space,  Kernel::collide_sphere_capsule,
    Kernel::collide_box_capsule,       Kernel::collide_capsule_capsule, Kernel::collide_capsule_half_space};

std::vector<Kernel> followed(std::vector<Kernel> kernels)
{
  /* the last in any order */
  kernels.insert(kernels.end(), {Kernel::follow_boxes, Kernel::follow_box_capsules, Kernel::follow_sphere_capsules,
                                 Kernel::follow_capsules});
  return kernels;
}
const std::vector<Kernel> narrowphase_kernels = followed(lane_kernels);

TestBody random_body_of_any_shape(Random &random, bool may_be_half_space)
{
  TestBody body;
  constexpr Shape shapes[] = {sphere, box, capsule, half_space};
  body.shape = shapes[random.below(may_be_half_space ? 4 : 3)];
  for (int k = 0; k < 3; ++k) body.size[k] = static_cast<float>(random.logarithmic(0.1, 2));
  if (body.shape == capsule && random.below(2)) {
    body.shape_position = random.in_cube(0.3).cast<float>();
    body.shape_orientation = random.orientation().cast<float>();
  }
  if (random.below(3)) body.orientation = random.orientation().cast<float>();
  body.position = random.in_cube(1).cast<float>();
  const double speed = random.logarithmic(0.5, 300); /* so that some pairs meet or miss within the step, some rest */
  body.linear = random.in_cube(speed).cast<float>();
  body.angular = random.in_cube(std::min(speed, 100.0)).cast<float>();
  if (random.below(3) == 0) body.inverse_mass = 0;
  return body;
}

/* Body b from afar, so that the pair hits or misses within the step. */
void throw_at(Random &random, const TestBody &a, TestBody &b)
{
  const Vector way = random.direction();
  const double distance = random.uniform(1, 5), speed = random.uniform(100, 600);
  b.position = (a.center() + distance * way + random.in_cube(0.2)).cast<float>();
  b.linear = a.linear - (speed * way).cast<float>();
}

PairScene mixed_pairs()
{
  Random random(11);
  PairScene scene;
  while (scene.size() < 20000) {
    TestBody a = random_body_of_any_shape(random, true), b = random_body_of_any_shape(random, a.shape != half_space);
    /* The general test has its own kernel, of one item at a time. */
    if (pair_kind(a.shape, b.shape) == PAIR_KIND_CONVEX_CONVEX) continue;
    if (random.below(16) == 0) b.position = a.position;
    if (random.below(16) == 0) b.orientation = a.orientation;
    if (random.below(2)) throw_at(random, a, b);
    scene.add(a, b);
  }
  return scene;
}

} // namespace

TEST_CASE("narrowphase: every width and direction gives the same bits")
{
  PairScene scene = mixed_pairs();
  const Outputs expected = scene.run(narrowphase_kernels);
  size_t at_impact = 0, with_ball = 0;
  for (size_t pair = 0; pair < scene.size(); ++pair) {
    at_impact += expected.normals[pair].w > 0;
    with_ball += (expected.features[pair] & code_of_middle_ball) != 0;
  }
  CHECK(at_impact > 500);
  CHECK(with_ball > 60);
  CHECK(scene.run(narrowphase_kernels, minicl::backward_kernels) == expected);
  const Outputs before_following = scene.run(lane_kernels);
  CHECK_FALSE(before_following == expected);
  for (uint32_t lanes : {4u, 8u, 16u}) {
    const minicl::KernelTable *table = minicl::lanes_table(lanes);
    if (lanes > minicl::widest_lanes()) continue;
    REQUIRE(table != nullptr);
    INFO(lanes << " lanes");
    CHECK(scene.run(lane_kernels, *table) == before_following);
    CHECK(scene.run(narrowphase_kernels, *table) == expected);
  }
}

TEST_CASE("narrowphase: over lists of each kind as over all pairs")
{
  PairScene scene = mixed_pairs();
  const Outputs expected = scene.run(narrowphase_kernels);
  scene.parameters.features = FEATURE_PAIR_KINDS;
  CHECK(scene.run(narrowphase_kernels) == expected);
  CHECK(scene.run(narrowphase_kernels, minicl::backward_kernels) == expected);
  for (uint32_t lanes : {4u, 8u, 16u}) {
    if (lanes > minicl::widest_lanes()) continue;
    INFO(lanes << " lanes");
    CHECK(scene.run(narrowphase_kernels, *minicl::lanes_table(lanes)) == expected);
  }
}

TEST_CASE("narrowphase: the order of the kernels does not matter, and each pair is written whole")
{
  PairScene scene = mixed_pairs();
  const Outputs expected = scene.run(narrowphase_kernels);
  CHECK(scene.run(followed({lane_kernels.rbegin(), lane_kernels.rend()})) == expected);
  const size_t pairs = scene.size(), capacity = expected.counts.size();
  for (size_t pair = 0; pair < capacity; ++pair) {
    const bool written = pair < pairs;
    REQUIRE((expected.counts[pair] != PairScene::untouched) == written);
    REQUIRE((expected.features[pair] != PairScene::untouched) == written);
    uint32_t word;
    for (uint32_t k = 0; k < 4; ++k) {
      std::memcpy(&word, &expected.points[k * capacity + pair].w, sizeof word);
      REQUIRE((word != PairScene::untouched) == written);
    }
  }
  size_t finite = 0;
  for (size_t pair = 0; pair < pairs; ++pair)
    for (const Point &point : scene.contact(expected, pair).points) finite += point.offset.allFinite();
  size_t points = 0;
  for (size_t pair = 0; pair < pairs; ++pair) points += expected.counts[pair];
  CHECK(finite == points);
  CHECK(points > pairs / 2);
}
