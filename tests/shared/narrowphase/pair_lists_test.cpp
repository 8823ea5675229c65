/* pair_lists_test.cpp - pairs by kind against a search over all pairs, on every backend; and the table of pairs.def in
 * the documents. */
#include <algorithm>
#include <fstream>
#include <sstream>

#include "host/base/random.h"
#include "host/catalog/catalog.h"
#include "host/pipeline/layout.h"
#include "host/pipeline/pair_lists.h"
#include "host/runtime/interface/pair_tests.h"
#include "host/runtime/launcher.h"
#include "host/runtime/make_backend.h"
#include "host/runtime/memory.h"
#include "shared/pair_kinds.h"
#include "tests/catch.h"
#include "tests/parity/parity.h"
#include "tests/shared/words.h"

using namespace tandem;

namespace {

/* leaf: as pair_leaf, in scenes with trees; the flags of the shapes of parts follow those of bodies. */
struct Pairs {
  std::vector<uint32_t> a, b, flags, leaf;

  Features features() const { return FEATURE_PAIR_KINDS | (leaf.empty() ? 0 : FEATURE_TREES); }
  uint32_t code(uint32_t pair, uint32_t side) const
  {
    return flags[leaf.empty() ? (side == 0 ? a : b)[pair] : leaf[4 * pair + 2 * side]] & 7;
  }
};

/* Flags of bodies with the given shapes; the other bits must not matter. */
Pairs random_pairs(uint32_t count, const std::vector<uint32_t> &shapes, uint64_t seed)
{
  Random random(seed);
  Pairs pairs;
  for (uint32_t body = 0; body < 50; ++body)
    pairs.flags.push_back(shapes[random.below(static_cast<uint32_t>(shapes.size()))] | random.below(1 << 20) << 3);
  for (uint32_t pair = 0; pair < count; ++pair) {
    pairs.a.push_back(random.below(50));
    pairs.b.push_back(random.below(50));
  }
  return pairs;
}

/* Each of the bodies is a compound of as many parts as there are shapes. */
Pairs random_pairs_of_parts(uint32_t count, const std::vector<uint32_t> &shapes, uint64_t seed)
{
  Random random(seed);
  Pairs pairs = random_pairs(count, {SHAPE_OTHER}, seed + 1);
  const auto bodies = static_cast<uint32_t>(pairs.flags.size()), parts = static_cast<uint32_t>(shapes.size());
  for (uint32_t body = 0; body < bodies; ++body) pairs.flags.insert(pairs.flags.end(), shapes.begin(), shapes.end());
  for (uint32_t pair = 0; pair < count; ++pair)
    for (const uint32_t body : {pairs.a[pair], pairs.b[pair]})
      pairs.leaf.insert(pairs.leaf.end(), {bodies + parts * body + random.below(parts), INDEX_NONE});
  return pairs;
}

struct PairLists {
  std::vector<uint32_t> starts, pairs;
  bool operator==(const PairLists &) const = default;
};

/* The kind according to the drawing in pairs.def, not to its rows. */
uint32_t kind_by_hand(uint32_t a, uint32_t b)
{
  if (a > b) std::swap(a, b);
  if (a == SHAPE_HALF_SPACE && b == SHAPE_HALF_SPACE) return PAIR_KIND_NONE;
  if (b == SHAPE_HALF_SPACE) return a == SHAPE_SPHERE ? PAIR_KIND_SPHERE_HALF_SPACE : PAIR_KIND_BOX_HALF_SPACE;
  if (a == SHAPE_HALF_SPACE) return b == SHAPE_CAPSULE ? PAIR_KIND_CAPSULE_HALF_SPACE : PAIR_KIND_CONVEX_HALF_SPACE;
  if (b == SHAPE_CAPSULE && a == SHAPE_SPHERE) return PAIR_KIND_SPHERE_CAPSULE;
  if (b == SHAPE_CAPSULE && a == SHAPE_CAPSULE) return PAIR_KIND_CAPSULE_CAPSULE;
  if (b == SHAPE_CAPSULE && a == SHAPE_BOX) return PAIR_KIND_BOX_CAPSULE;
  if (b > SHAPE_HALF_SPACE) return PAIR_KIND_CONVEX_CONVEX;
  return b == SHAPE_SPHERE ? PAIR_KIND_SPHERE_SPHERE : a == SHAPE_BOX ? PAIR_KIND_BOX_BOX : PAIR_KIND_SPHERE_BOX;
}

PairLists pairs_by_hand(const Pairs &pairs)
{
  PairLists lists;
  for (uint32_t kind = 0; kind <= PAIR_KIND_NONE; ++kind) {
    lists.starts.push_back(static_cast<uint32_t>(lists.pairs.size()));
    for (uint32_t pair = 0; pair < pairs.a.size(); ++pair)
      if (kind_by_hand(pairs.code(pair, 0), pairs.code(pair, 1)) == kind) lists.pairs.push_back(pair);
  }
  return lists;
}

PairLists pairs_on_backend(const std::string &name, const Pairs &pairs)
{
  const auto count = static_cast<uint32_t>(pairs.a.size()), capacity = count + 5;
  const std::unique_ptr<Backend> backend = make_backend(name);
  Memory memory;
  std::vector<Kernel> kernels = {Kernel::find_pair_kinds, Kernel::count_pair_kinds, Kernel::start_pair_lists,
                                 Kernel::list_pairs};
  for (size_t k = 0; k < kernel_count; ++k)
    if (row_of(kernel_at(k)).stage == Stage::parallel) kernels.push_back(kernel_at(k));
  backend->prepare(pairs.features(), kernels);
  const Sizes sizes{.bodies = static_cast<uint32_t>(pairs.flags.size()),
                    .materials = 1,
                    .hulls = {},
                    .trees = {},
                    .pairs = capacity,
                    .cells = 1024,
                    .features = pairs.features()};
  for (Buffer buffer : {Buffer::pair_of_kind, Buffer::sort_key, Buffer::sort_histogram, Buffer::scan_sums})
    memory.resize(buffer, bytes_of(buffer, sizes));
  std::vector<uint32_t> counts(COUNT_TOTAL);
  counts[COUNT_ONE] = 1;
  counts[COUNT_PAIRS] = count;
  Parameters parameters{};
  parameters.features = pairs.features();
  memory.resize(Buffer::parameters, sizeof parameters);
  memory.upload(Buffer::parameters, &parameters, sizeof parameters);
  set_words(memory, Buffer::counts, counts);
  set_words(memory, Buffer::pair_leaf, pairs.leaf);
  set_words(memory, Buffer::pair_a, pairs.a);
  set_words(memory, Buffer::pair_b, pairs.b);
  set_words(memory, Buffer::body_flags, pairs.flags);
  DirectLauncher launcher(memory, *backend);
  list_pairs(launcher, capacity, false);
  PairLists lists;
  lists.starts = memory.read<uint32_t>(Buffer::counts, PAIR_KIND_NONE + 1, KIND_START);
  lists.pairs = memory.read<uint32_t>(Buffer::pair_of_kind, count);
  backend->finish();
  return lists;
}

Pairs pairs_of_step(World &world)
{
  Memory &memory = world.memory();
  const uint32_t count = memory.read<uint32_t>(Buffer::counts, 1, COUNT_PAIRS).at(0);
  Pairs pairs{memory.read<uint32_t>(Buffer::pair_a, count),
              memory.read<uint32_t>(Buffer::pair_b, count),
              memory.read<uint32_t>(Buffer::body_flags, memory.bytes(Buffer::body_flags) / sizeof(uint32_t)),
              {}};
  if ((world.features() & FEATURE_TREES) != 0) pairs.leaf = memory.read<uint32_t>(Buffer::pair_leaf, 4 * count);
  return pairs;
}

std::string text_of(const std::string &path)
{
  std::ifstream file(TANDEM_SOURCE_DIR "/" + path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

struct NamedShape {
  const char *name;
  uint32_t code;
};
constexpr NamedShape shapes[] = {
    {"sphere", SHAPE_SPHERE},         {"box", SHAPE_BOX},      {"capsule", SHAPE_CAPSULE},
    {"half-space", SHAPE_HALF_SPACE}, {"convex", SHAPE_OTHER},
};

/* A row of the matrix on its page: below the diagonal nothing, since either body may be a. */
std::string row_of_matrix(size_t first)
{
  std::string row = std::string("| **") + shapes[first].name + "** |";
  for (size_t second = 0; second < std::size(shapes); ++second) {
    const uint32_t kind = pair_kind(shapes[first].code, shapes[second].code);
    row += second < first           ? " |"
           : kind == PAIR_KIND_NONE ? " never: neither moves |"
                                    : std::string(" `") + row_of(pair_tests[kind].kernel).name + "` |";
  }
  return row + "\n";
}

} // namespace

TEST_CASE("pair lists: each pair once, in the list of its kind, in order", "[sanitizer]")
{
  const uint32_t count = GENERATE(0u, 1u, 2u, TILE - 1, TILE, TILE + 1, 3 * TILE + 7, 40000u);
  const std::vector<uint32_t> all = {SHAPE_SPHERE, SHAPE_BOX, SHAPE_CAPSULE, SHAPE_HALF_SPACE, SHAPE_OTHER};
  for (const std::vector<uint32_t> &some :
       std::vector<std::vector<uint32_t>>{all, {SHAPE_BOX}, {SHAPE_BOX, SHAPE_OTHER}, {SHAPE_HALF_SPACE}}) {
    const Pairs pairs = random_pairs(count, some, count + some.size());
    const PairLists expected = pairs_by_hand(pairs);
    REQUIRE(expected.pairs.size() == count);
    CAPTURE(count, some.size());
    for (const char *name : {"serial", "serial:order=backward", "serial:order=shuffled", "tbb:threads=7"}) {
      CAPTURE(name);
      CHECK((pairs_on_backend(name, pairs) == expected));
    }
  }
}

TEST_CASE("pair lists: a pair of parts is of the kind of their shapes", "[sanitizer]")
{
  for (const uint32_t count : {1u, TILE, 3 * TILE + 7}) {
    const Pairs pairs = random_pairs_of_parts(count, {SHAPE_CAPSULE, SHAPE_OTHER, SHAPE_CAPSULE}, count);
    const PairLists expected = pairs_by_hand(pairs);
    REQUIRE(expected.pairs.size() == count);
    for (const char *name : {"serial", "serial:order=backward", "tbb:threads=7"}) {
      CAPTURE(name, count);
      CHECK((pairs_on_backend(name, pairs) == expected));
    }
  }
}

TEST_CASE("pair lists: the same on OpenCL")
{
  parity::require_pocl();
  for (const uint32_t count : {0u, 1u, TILE, 3 * TILE + 7}) {
    const Pairs pairs =
        random_pairs(count, {SHAPE_SPHERE, SHAPE_BOX, SHAPE_CAPSULE, SHAPE_HALF_SPACE, SHAPE_OTHER}, count);
    CHECK((pairs_on_backend("cl:pocl", pairs) == pairs_by_hand(pairs)));
  }
  const Pairs parts = random_pairs_of_parts(TILE + 3, {SHAPE_CAPSULE, SHAPE_OTHER}, 5);
  CHECK((pairs_on_backend("cl:pocl", parts) == pairs_by_hand(parts)));
}

TEST_CASE("pair lists: a scene has them where pairs of several kinds mix")
{
  const auto has_lists = [](const Scene &scene) {
    const World world(scene, Settings{}, Placement{"serial", {}, false});
    return (world.features() & FEATURE_PAIR_KINDS) != 0;
  };
  for (const char *name : {"mixed:n=20", "shapes:n=20"}) CHECK(has_lists(load_scene(name)));
  for (const char *name : {"box-grid:nx=2,ny=2,nz=2", "spheres:n=8", "convex-hulls:n=8"})
    CHECK_FALSE(has_lists(load_scene(name)));
}

/* The lists after a step of a scene with all kinds. */
TEST_CASE("pair lists: those of a step hold the pairs of the step", "[sanitizer]")
{
  World world(load_scene("shapes:n=40"), Settings{}, Placement{"tbb:threads=3", {}, false});
  world.set_observer([](const Launch &) {}); /* so that no list lies in the memory of another */
  for (int step = 0; step < 40; ++step) world.step();
  Memory &memory = world.memory();
  const uint32_t count = memory.read<uint32_t>(Buffer::counts, 1, COUNT_PAIRS).at(0);
  const Pairs pairs = pairs_of_step(world);
  const PairLists lists{memory.read<uint32_t>(Buffer::counts, PAIR_KIND_NONE + 1, KIND_START),
                        memory.read<uint32_t>(Buffer::pair_of_kind, count)};
  CHECK((lists == pairs_by_hand(pairs)));
  CHECK(count > 40);
}

/* A kind that the scene was not thought to have would leave its pairs without contacts, alike on every backend. */
TEST_CASE("pair kinds: a scene has the kernel of every pair that it makes")
{
  std::vector<Scene> scenes;
  for (const std::string &name : parity::small_scenes()) scenes.push_back(load_scene(name));
  Scene triggers; /* a half-space that is moved past what is fixed */
  triggers.shapes = {half_space_shape(), sphere_shape(1), box_shape(1, 1, 1), capsule_shape(1, 1)};
  for (uint32_t shape = 0; shape < 4; ++shape) {
    Body body;
    body.shape = shape;
    body.type = shape == 0 ? BodyType::kinematic : BodyType::fixed;
    body.trigger = shape == 0;
    triggers.bodies.push_back(body);
  }
  scenes.push_back(triggers);
  size_t met = 0;
  for (const Scene &scene : scenes) {
    World world(scene, Settings{}, Placement{"serial", {}, false});
    for (const Buffer buffer : {Buffer::pair_a, Buffer::pair_leaf}) world.keep_after_steps(buffer);
    for (int step = 0; step < 12; ++step) world.step();
    const Pairs pairs = pairs_of_step(world);
    const auto count = static_cast<uint32_t>(pairs.a.size());
    CAPTURE(scene.name);
    for (uint32_t pair = 0; pair < count; ++pair) {
      const uint32_t kind = pair_kind(pairs.code(pair, 0), pairs.code(pair, 1));
      REQUIRE(kind != PAIR_KIND_NONE);
      REQUIRE((world.features() & pair_tests[kind].feature) != 0);
      ++met;
    }
    if (scene.bodies.size() == 4) CHECK(count == 3);
  }
  CHECK(met > 1000);
}

TEST_CASE("pair kinds: capsules have tests of their own but for those with two radii or continuous collision")
{
  const auto launches_general_test = [](const Shape &shape, bool continuous) {
    Scene scene;
    scene.shapes = {shape, half_space_shape()};
    for (uint32_t k = 0; k < 3; ++k) {
      Body body;
      body.shape = k == 2;
      body.type = k == 2 ? BodyType::fixed : BodyType::dynamic;
      body.continuous = k < 2 && continuous;
      body.position = {0.3 * k, k == 2 ? -1.0 : 0.0, 0};
      body.shape_position = {0.1f, 0, 0.2f};
      if (k == 2) body.shape_position = {0, 0, 0};
      body.shape_orientation = k == 2 ? Quat{0, 0, 0, 1} : Quat{0, 0.6f, 0, 0.8f};
      scene.bodies.push_back(body);
    }
    const std::vector<Kernel> kernels = World(scene, Settings{}, Placement{"serial", {}, false}).kernels();
    const auto launches = [&](Kernel kernel) { return std::count(kernels.begin(), kernels.end(), kernel) > 0; };
    CHECK(launches(Kernel::collide_convex) != launches(Kernel::collide_capsule_capsule));
    CHECK(launches(Kernel::collide_convex_half_space) != launches(Kernel::collide_capsule_half_space));
    return launches(Kernel::collide_convex);
  };
  Shape tapered = capsule_shape(0.2f, 0.5f);
  tapered.size[2] = 0.3f;
  CHECK_FALSE(launches_general_test(capsule_shape(0.2f, 0.5f), false));
  CHECK(launches_general_test(capsule_shape(0.2f, 0.5f), true));
  CHECK(launches_general_test(tapered, false));
}

TEST_CASE("pair kinds: the matrix on its page is that of pairs.def")
{
  const std::string page = text_of("docs/pipeline.md");
  for (size_t first = 0; first < std::size(shapes); ++first) {
    CAPTURE(row_of_matrix(first));
    CHECK(page.find("\n" + row_of_matrix(first)) != page.npos);
  }
}

TEST_CASE("pair kinds: either body may be the first, and every row is some pair's")
{
  std::vector<bool> found(PAIR_KIND_NONE + 1);
  for (const NamedShape &a : shapes)
    for (const NamedShape &b : shapes) {
      found[pair_kind(a.code, b.code)] = true;
      CHECK(pair_kind(a.code, b.code) == kind_by_hand(a.code, b.code));
      CHECK(pair_kind(a.code, b.code) == pair_kind(b.code, a.code));
    }
  CHECK(std::count(found.begin(), found.end(), true) == PAIR_KIND_NONE + 1);
}
