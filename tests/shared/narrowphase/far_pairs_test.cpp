/* Pairs that are dropped by their cores against what the tests of their shapes find: the same contacts, to the bit. */
#include "tests/shared/narrowphase/capsules.h"

using namespace tandem;
using namespace tandem::narrowphase_tests;

namespace {

TestBody random_limb(Random &random, Shape shape)
{
  TestBody body = random_round(random, shape, 0.02, 0.5);
  if (shape == box)
    for (int k = 0; k < 3; ++k) body.size[k] = static_cast<float>(random.logarithmic(0.02, 0.5));
  const double speed = random.below(2) ? 0.1 : random.logarithmic(1, 100);
  body.linear = random.in_cube(speed).cast<float>();
  body.angular = random.in_cube(std::min(speed, 50.0)).cast<float>();
  return body;
}

/* Half of the pairs are near each other, a quarter lies far from the origin, and some lie side by side. */
PairScene random_limbs(Random &random, Shape first, size_t count)
{
  PairScene scene;
  scene.parameters.features = FEATURE_CAPSULE_CAPSULE;
  while (scene.size() < count) {
    TestBody a = random_limb(random, first), b = random_limb(random, capsule);
    if (random.below(4) == 0) b.orientation = a.orientation;
    const Vector at = random.in_cube(random.below(4) ? 1 : 2000);
    a.position = at.cast<float>();
    b.position = a.position + random.in_cube(random.below(2) ? 0.6 : 2).cast<float>();
    if (random.below(2)) scene.add(a, b);
    else scene.add(b, a);
  }
  return scene;
}

void take_outputs(Outputs &outputs, const Outputs &from, size_t pair)
{
  outputs.normals[pair] = from.normals[pair];
  outputs.counts[pair] = from.counts[pair];
  outputs.features[pair] = from.features[pair];
  for (size_t k = 0; k < 4; ++k) {
    const size_t at = k * from.counts.size() + pair;
    outputs.points[at] = from.points[at];
  }
}

struct LimbPairs {
  Shape first;
  Kernel kernel;
  uint32_t code;
};
constexpr LimbPairs limb_pairs[] = {{capsule, Kernel::collide_capsule_capsule, PAIR_KIND_CAPSULE_CAPSULE},
                                    {sphere, Kernel::collide_sphere_capsule, PAIR_KIND_SPHERE_CAPSULE},
                                    {box, Kernel::collide_box_capsule, PAIR_KIND_BOX_CAPSULE}};

} // namespace

TEST_CASE("far pairs: what is dropped has no contacts, and most of what has none is dropped")
{
  Random random(71);
  for (const LimbPairs &kind : limb_pairs) {
    PairScene scene = random_limbs(random, kind.first, 20000);
    const Outputs found = scene.run({kind.kernel});
    Outputs outputs = found;
    const std::vector<uint32_t> by_core = scene.kinds_by_core(outputs);
    size_t dropped = 0, apart = 0, wrong = 0;
    for (size_t pair = 0; pair < scene.size(); ++pair) {
      const bool drops = by_core[pair] == PAIR_KIND_NONE, touches = found.counts[pair] != 0;
      dropped += drops;
      apart += !touches;
      wrong += drops ? touches : by_core[pair] != kind.code;
    }
    CAPTURE(kind.code, dropped, apart);
    CHECK(wrong == 0);
    REQUIRE(apart > scene.size() / 10); /* there are enough of both */
    REQUIRE(apart < scene.size() * 9 / 10);
    CHECK(dropped > apart / 2);
  }
}

TEST_CASE("far pairs: those that are dropped have the outputs of pairs that do not touch")
{
  Random random(72);
  for (const LimbPairs &kind : limb_pairs) {
    PairScene scene = random_limbs(random, kind.first, 4000);
    const Outputs found = scene.run({kind.kernel});
    Outputs outputs = found;
    const std::vector<uint32_t> by_core = scene.kinds_by_core(outputs);
    for (size_t pair = 0; pair < scene.size(); ++pair)
      if (by_core[pair] != PAIR_KIND_NONE) take_outputs(outputs, found, pair); /* as their kernel would write them */
    CHECK((outputs == found));
  }
}

TEST_CASE("far pairs: every width drops the same pairs")
{
  Random random(73);
  for (const LimbPairs &kind : limb_pairs) {
    PairScene scene = random_limbs(random, kind.first, 4000);
    Outputs outputs = scene.run({kind.kernel});
    const std::vector<uint32_t> expected = scene.kinds_by_core(outputs);
    for (const uint32_t lanes : {4u, 8u, 16u})
      if (const minicl::KernelTable *table = minicl::lanes_table(lanes))
        CHECK(scene.kinds_by_core(outputs, *table) == expected);
  }
}
