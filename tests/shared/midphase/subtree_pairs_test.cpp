/* The list of leaf pairs by each traversal of the trees, against a test of every leaf of every tree: the same entries
 * in the same order. Pairs of two trees, which both traversals descend together, are only compared between the two. */
#include "host/runtime/memory.h"
#include "shared/midphase/subtree_pairs.h"
#include "tests/catch.h"
#include "tests/physics/bodies.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

using Entry = std::array<uint32_t, 6>; /* two bodies, shape and triangle of either */

/* Buffers of a scene at the start of a step, as the kernels see them. */
struct Buffers {
  Parameters parameters;
  std::vector<uint32_t> flags, filters, body_trees, headers, nodes, leaves;
  std::vector<float4> shapes, poses, frames, positions, orientations, velocities;

  explicit Buffers(Memory &memory) : parameters(memory.read<Parameters>(Buffer::parameters, 1)[0])
  {
    for (auto &[words, buffer] :
         std::initializer_list<std::pair<std::vector<uint32_t> &, Buffer>>{{flags, Buffer::body_flags},
                                                                           {filters, Buffer::body_filter},
                                                                           {body_trees, Buffer::body_tree},
                                                                           {headers, Buffer::tree_header},
                                                                           {nodes, Buffer::tree_node},
                                                                           {leaves, Buffer::tree_leaf}})
      words = memory.read<uint32_t>(buffer, memory.bytes(buffer) / sizeof(uint32_t));
    for (auto &[rows, buffer] :
         std::initializer_list<std::pair<std::vector<float4> &, Buffer>>{{shapes, Buffer::body_shape},
                                                                         {poses, Buffer::body_shape_pose},
                                                                         {frames, Buffer::tree_frame},
                                                                         {positions, Buffer::body_position},
                                                                         {orientations, Buffer::body_orientation},
                                                                         {velocities, Buffer::body_velocity}})
      rows = memory.read<float4>(buffer, memory.bytes(buffer) / sizeof(float4));
  }

  midphase_scene scene() const
  {
    return {&parameters,
            {flags.data(), shapes.data(), nullptr, poses.data()},
            filters.data(),
            body_trees.data(),
            {headers.data(), frames.data(), nodes.data(), leaves.data()},
            {positions.data(), orientations.data(), velocities.data(), nullptr}};
  }
};

/* Collects what add_leaf_pair writes. */
struct PairStorage {
  std::vector<uint32_t> a, b, leaf;
  leaf_list list;
  explicit PairStorage(uint32_t size)
      : a(size), b(size), leaf(4 * size_t{size}), list(writing_list({a.data(), b.data(), leaf.data()}, 0, size))
  {}
};

void look_at_every_leaf(leaf_list *list, const midphase_scene &scene, uint32_t a, uint32_t b)
{
  if (!one_has_tree(&scene, a, b)) return find_without_walk(list, &scene, a, b);
  const tree_pair pair = load_tree_pair(&scene, a, b);
  const tree_probe probe = probe_of_pair(&scene, a, b, &pair);
  const tree t = load_tree(scene.trees, pair.tree_number);
  for (uint32_t node = 0; node < t.nodes; ++node) {
    const uint32_t word = word_of_node(scene.trees, &t, node);
    if (is_leaf(word) && probe_hits(&probe, bounds_of_node(scene.trees, &t, node)))
      add_leaf_of_tree(list, &scene, &pair, &t, word);
  }
}

std::vector<Entry> entries(const std::vector<uint32_t> &a, const std::vector<uint32_t> &b,
                           const std::vector<uint32_t> &leaf, uint32_t count)
{
  std::vector<Entry> result;
  for (size_t i = 0; i < count; ++i)
    result.push_back({a[i], b[i], leaf[4 * i], leaf[4 * i + 1], leaf[4 * i + 2], leaf[4 * i + 3]});
  return result;
}

/* Pairs of bodies in the order of the broadphase: by a, then b < a. */
std::vector<Entry> expected_list(const Buffers &before, const std::vector<float4> &bounds, uint32_t bodies)
{
  const midphase_scene scene = before.scene();
  PairStorage storage(1u << 20);
  for (uint32_t a = 0; a < bodies; ++a)
    for (uint32_t b = 0; b < a; ++b)
      if (pair_allowed(scene.parameters, scene.shapes.flags, scene.filters, a, b) &&
          bounds_overlap(load_bounds(bounds.data(), a), load_bounds(bounds.data(), b)))
        look_at_every_leaf(&storage.list, scene, a, b);
  REQUIRE(storage.list.found < storage.list.end);
  return entries(storage.a, storage.b, storage.leaf, storage.list.found);
}

std::vector<Entry> list_of(World &world)
{
  Memory &memory = world.memory();
  const uint32_t pairs = memory.read<uint32_t>(Buffer::counts, COUNT_TOTAL)[COUNT_PAIRS];
  return entries(memory.read<uint32_t>(Buffer::pair_a, pairs), memory.read<uint32_t>(Buffer::pair_b, pairs),
                 memory.read<uint32_t>(Buffer::pair_leaf, 4 * size_t{pairs}), pairs);
}

/* Steps a world with that walk and holds each list against every leaf; returns the lists, one behind the other. */
std::vector<Entry> checked_lists(const Scene &scene, Midphase midphase, const std::string &backend)
{
  Settings settings;
  settings.midphase = midphase;
  World world(scene, settings, {backend, {}});
  world.set_observer([](const Launch &) {}); /* so that no list lies in the memory of another */
  std::vector<Entry> all;
  for (int step = 0; step < 2; ++step) {
    const Buffers before(world.memory());
    world.step();
    const auto bodies = uint32_t(scene.bodies.size());
    const std::vector<Entry> list = list_of(world),
                             expected =
                                 expected_list(before, world.memory().read<float4>(Buffer::bounds, 2 * bodies), bodies);
    const auto [found, wanted] = std::mismatch(list.begin(), list.end(), expected.begin(), expected.end());
    CAPTURE(midphase, backend, step, list.size(), expected.size(), found - list.begin());
    REQUIRE((found == list.end() && wanted == expected.end()));
    all.insert(all.end(), list.begin(), list.end());
  }
  return all;
}

void check_scene(const Scene &scene, size_t at_least)
{
  const std::vector<Entry> walked = checked_lists(scene, Midphase::walk, "serial");
  CHECK(walked.size() > at_least);
  for (const char *backend : {"serial", "serial:order=backward", "tbb:threads=2"})
    CHECK((checked_lists(scene, Midphase::subtrees, backend) == walked)); /* without writing them out */
}

Shape hills(Random &random, uint32_t columns)
{
  std::vector<float> heights;
  for (uint32_t i = 0; i < columns * columns; ++i) heights.push_back(float(random.uniform(-0.2, 0.2)));
  return height_field_shape(heights, columns, 4.0f / float(columns - 1), 4.0f / float(columns - 1), "hills");
}

Point somewhere(Random &random) { return {random.uniform(-2, 2), random.uniform(-0.4, 0.4), random.uniform(-2, 2)}; }

/* Hulls and balls, that move, in and over the hills. */
void add_bodies(Scene &scene, Random &random, int count)
{
  for (int k = 0; k < count; ++k) {
    const Point at = somewhere(random);
    Body &body = add_dynamic_body(scene, k % 3 ? random_hull_shape(random, 12, 0.2) : sphere_shape(0.15f),
                                  {at[0], at[1], at[2]}, random.orientation());
    body.linear_velocity = vec3_of(Vector(random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-4, 4)));
  }
}

Shape dumbbell()
{
  Child first, second;
  first.shape = second.shape = sphere_shape(0.15f);
  first.position = {-0.2f, 0, 0};
  second.position = {0.2f, 0, 0};
  return compound_shape({first, second});
}

uint32_t subtrees_of(const Scene &scene, uint32_t tree)
{
  Settings settings;
  settings.midphase = Midphase::subtrees;
  World world(scene, settings);
  world.set_observer([](const Launch &) {}); /* so that no list lies in the memory of another */
  return world.memory().read<uint32_t>(Buffer::tree_header, TREE_HEADER * (size_t{tree} + 1))[TREE_HEADER * tree + 5];
}

} // namespace

TEST_CASE("leaf pairs of one tree: of one subtree, of a few, of many windows of them", "[address]")
{
  const auto [columns, least, most] =
      GENERATE(table<uint32_t, uint32_t, uint32_t>({{2, 1, 1}, {9, 2, WINDOW}, {61, 8 * WINDOW, 1000}}));
  Random random(columns);
  Scene scene = empty_scene();
  add_body(scene, BodyType::fixed, hills(random, columns), {0, 0, 0}).orientation = random.orientation();
  add_bodies(scene, random, 150); /* more pairs than two groups take, no multiple of them */
  CHECK(subtrees_of(scene, 0) >= least);
  CHECK(subtrees_of(scene, 0) <= most);
  check_scene(scene, 100);
}

TEST_CASE("leaf pairs of several trees in one group, in turns, and of bodies without")
{
  Random random(7);
  Scene scene = empty_scene();
  for (const uint32_t columns : {12u, 2u, 30u, 5u})
    add_body(scene, BodyType::fixed, hills(random, columns), somewhere(random)).orientation = random.orientation();
  add_bodies(scene, random, 60);
  for (int k = 0; k < 40; ++k) {
    const Point at = somewhere(random);
    add_dynamic_body(scene, dumbbell(), {at[0], at[1], at[2]},
                     random.orientation()); /* of one shape each: a tree each */
  }
  add_bodies(scene, random, 30);
  scene.shapes.push_back(half_space_shape());
  Body &floor = scene.bodies.emplace_back();
  floor.shape = uint32_t(scene.shapes.size() - 1);
  floor.type = BodyType::fixed;
  floor.position = {0, -0.1, 0};
  check_scene(scene, 1000);
}

TEST_CASE("leaf pairs by subtrees: filters of children, and a list that grows")
{
  Random random(9);
  Scene scene = empty_scene();
  add_body(scene, BodyType::fixed, hills(random, 41), {0, 0, 0});
  add_bodies(scene, random, 20);
  add_dynamic_body(scene, box_shape(1.9f, 0.1f, 1.9f),
                   {0, 0.1, 0}); /* meets nearly every triangle: more than there is room for */
  Child seen, unseen;
  seen.shape = unseen.shape = sphere_shape(0.3f);
  unseen.position = {0.4f, 0, 0};
  unseen.filter_group = 2;
  add_dynamic_body(scene, compound_shape({seen, unseen}), {0.5, 0.3, 0.5}).filter_mask = 1;
  scene.bodies[3].filter_mask = 1;
  check_scene(scene, 3000);
  Settings settings;
  settings.midphase = Midphase::subtrees;
  World world(scene, settings);
  world.set_observer([](const Launch &) {}); /* so that no list lies in the memory of another */
  world.step();
  CHECK(world.statistics().overflow >= 1);
}
