/* bvh_test.cpp - no overlap is missed, the boxes of 16 bits contain the boxes that they stand for, and the sizes of
 * subtrees fit the tree. */
#include <limits>

#include "host/geometry/bvh.h"
#include "tests/catch.h"
#include "tests/host/geometry/shapes.h"

using namespace tandem;
using namespace tandem::geometry_test;
using Catch::Matchers::ContainsSubstring;

namespace {

AxisAlignedBox random_box(Random &random, double reach, double size)
{
  AxisAlignedBox box;
  for (size_t axis = 0; axis < 3; ++axis) {
    box.lower[axis] = float(random.uniform(-reach, reach));
    box.upper[axis] = box.lower[axis] + float(random.uniform(0, size));
  }
  return box;
}

std::vector<AxisAlignedBox> random_boxes(size_t count, uint64_t seed, double size)
{
  Random random(seed);
  std::vector<AxisAlignedBox> boxes;
  for (size_t i = 0; i < count; ++i) boxes.push_back(random_box(random, 10, size));
  return boxes;
}

bool contains(const AxisAlignedBox &outer, const AxisAlignedBox &inner)
{
  bool result = true;
  for (size_t axis = 0; axis < 3; ++axis)
    result = result && outer.lower[axis] <= inner.lower[axis] && outer.upper[axis] >= inner.upper[axis];
  return result;
}

AxisAlignedBox box_of(const Bvh &bvh, const BvhNode &node) { return dequantised(bvh.quantisation, node.bounds); }

/* Checks the subtree that starts at `at` and returns the node after it: children inside their parent, skips that
 * meet. */
size_t check_subtree(const Bvh &bvh, std::span<const AxisAlignedBox> boxes, size_t at, uint32_t depth,
                     uint32_t &deepest, std::vector<int> &seen)
{
  const BvhNode &node = bvh.nodes.at(at);
  deepest = std::max(deepest, depth);
  if (is_leaf(node)) {
    ++seen.at(size_t(node.value));
    REQUIRE(contains(box_of(bvh, node), boxes[size_t(node.value)]));
    return at + 1;
  }
  size_t child = at + 1;
  for (int i = 0; i < 2; ++i) {
    REQUIRE(contains(box_of(bvh, node), box_of(bvh, bvh.nodes.at(child))));
    child = check_subtree(bvh, boxes, child, depth + 1, deepest, seen);
  }
  REQUIRE(child == at + nodes_below(node));
  return child;
}

/* The subtrees are as large as fits, in order, and hold every leaf; between them stand only nodes too large. */
void check_subtrees(const Bvh &bvh)
{
  size_t at = 0;
  for (const BvhSubtree &subtree : bvh.subtrees) {
    for (; at < subtree.root; ++at) REQUIRE(nodes_below(bvh.nodes[at]) > most_subtree_nodes);
    REQUIRE(at == subtree.root);
    REQUIRE(subtree.size <= most_subtree_nodes);
    REQUIRE(subtree.size == nodes_below(bvh.nodes[at]));
    REQUIRE(subtree.bounds == bvh.nodes[at].bounds);
    at += subtree.size;
  }
  REQUIRE(at == bvh.nodes.size());
}

Bvh checked_bvh(std::span<const AxisAlignedBox> boxes)
{
  const Bvh bvh = build_bvh(boxes, "test");
  REQUIRE(bvh.nodes.size() == 2 * boxes.size() - 1);
  std::vector<int> seen(boxes.size());
  uint32_t deepest = 0;
  REQUIRE(check_subtree(bvh, boxes, 0, 0, deepest, seen) == bvh.nodes.size());
  REQUIRE(std::all_of(seen.begin(), seen.end(), [](int times) { return times == 1; }));
  REQUIRE(bvh.depth == deepest);
  REQUIRE(bvh.depth <= depth_bound(boxes.size()));
  check_subtrees(bvh);
  return bvh;
}

/* The walk finds the leaves whose boxes overlap, no more and no fewer; and all primitives that do. */
void check_query(const Bvh &bvh, std::span<const AxisAlignedBox> boxes, const AxisAlignedBox &query)
{
  std::vector<uint32_t> found, exact, leaves, expected;
  for_each_overlap(bvh, query, [&](uint32_t primitive) { found.push_back(primitive); });
  std::sort(found.begin(), found.end());
  std::copy_if(found.begin(), found.end(), std::back_inserter(exact),
               [&](uint32_t i) { return overlap(boxes[i], query); });
  for (const BvhNode &node : bvh.nodes)
    if (is_leaf(node) && overlap(box_of(bvh, node), query)) leaves.push_back(uint32_t(node.value));
  std::sort(leaves.begin(), leaves.end());
  for (uint32_t i = 0; i < boxes.size(); ++i)
    if (overlap(boxes[i], query)) expected.push_back(i);
  REQUIRE(found == leaves);
  REQUIRE(exact == expected);
}

void check_queries(std::span<const AxisAlignedBox> boxes, int queries)
{
  const Bvh bvh = checked_bvh(boxes);
  Random random(99);
  for (int i = 0; i < queries; ++i) {
    const AxisAlignedBox &near = boxes[random.below(uint32_t(boxes.size()))];
    AxisAlignedBox query = near; /* touches at least one, and is now and then a point */
    for (size_t axis = 0; axis < 3; ++axis) {
      query.lower[axis] += float(random.uniform(-0.1, 0.1)) * float(i % 4);
      query.upper[axis] =
          std::max(query.lower[axis], query.upper[axis] + float(random.uniform(-0.1, 0.1)) * float(i % 5));
    }
    check_query(bvh, boxes, query);
  }
  for (int i = 0; i < queries; ++i) check_query(bvh, boxes, random_box(random, 12, i % 8));
}

std::string refusal_of_boxes(const std::vector<AxisAlignedBox> &boxes)
{
  return complaint([&] { build_bvh(boxes, "hall.glb"); });
}

} // namespace

TEST_CASE("bvh: queries of random boxes find what brute force finds", "[sanitizer]")
{
  for (size_t count : {1, 2, 3, 5, 17, 64, 65, 100, 1000}) {
    check_queries(random_boxes(count, count, 1), 40);
    check_queries(random_boxes(count, count, 8), 20);
  }
}

TEST_CASE("bvh: a hundred thousand boxes")
{
  const std::vector<AxisAlignedBox> boxes = random_boxes(100000, 5, 0.2);
  check_queries(boxes, 5);
  const Bvh bvh = build_bvh(boxes, "test");
  CHECK(bvh.depth <= 25);
  CHECK(build_bvh(boxes, "test").nodes == bvh.nodes);
}

TEST_CASE("bvh: boxes all in one place, flat, in a line, or very long", "[sanitizer]")
{
  check_queries(std::vector<AxisAlignedBox>(300, {{1, 2, 3}, {2, 3, 4}}), 10);
  check_queries(std::vector<AxisAlignedBox>(300, {{1, 2, 3}, {1, 2, 3}}), 10);
  std::vector<AxisAlignedBox> flat = random_boxes(300, 1, 1), line = flat, longish = flat;
  for (size_t i = 0; i < flat.size(); ++i) {
    flat[i].lower[1] = flat[i].upper[1] = 0.3f;
    line[i] = {{float(i), 0, 0}, {float(i), 0, 0}};
    longish[i].lower[i % 3] = -1e6f;
    longish[i].upper[i % 3] = 1e6f;
  }
  check_queries(flat, 30);
  check_queries(line, 30);
  check_queries(longish, 30);
}

TEST_CASE("bvh: positions that halve again and again do not make the tree deep", "[sanitizer]")
{
  std::vector<AxisAlignedBox> boxes;
  for (int i = 0; i < 250; ++i) {
    const float x = std::ldexp(1.0f, -i / 2) * (i % 2 ? 1.0f : 1.5f);
    boxes.push_back({{x, 0, 0}, {x * 1.01f, 1, 1}});
  }
  const Bvh bvh = checked_bvh(boxes);
  CHECK(bvh.depth <= depth_bound(boxes.size()));
  CHECK(depth_bound(250) == 24);
  CHECK(depth_bound(1) == 8);
}

TEST_CASE("bvh: the order of the nodes is that of the sketch: left child next, right child after the skip")
{
  const std::vector<AxisAlignedBox> boxes{
      {{0, 0, 0}, {1, 1, 1}}, {{2, 0, 0}, {3, 1, 1}}, {{20, 0, 0}, {21, 1, 1}}, {{22, 0, 0}, {23, 1, 1}}};
  const Bvh bvh = checked_bvh(boxes);
  std::vector<int32_t> values;
  for (const BvhNode &node : bvh.nodes) values.push_back(node.value);
  CHECK(values == std::vector<int32_t>{-7, -3, 0, 1, -3, 2, 3});
  CHECK(bvh.depth == 2);
  CHECK(bvh.subtrees.size() == 1);
}

TEST_CASE("bvh: a quantised box contains the box, and no smaller one of 16 bits does", "[sanitizer]")
{
  Random random(12);
  for (int turn = 0; turn < 400; ++turn) {
    const double scale = std::pow(10.0, random.uniform(-30, 30)),
                 far = turn % 2 ? scale * std::pow(10.0, random.uniform(0, 8)) : 0;
    std::vector<AxisAlignedBox> boxes;
    for (int i = 0; i < 8; ++i) {
      AxisAlignedBox box = random_box(random, 1, turn % 3);
      for (size_t axis = 0; axis < 3; ++axis) {
        box.lower[axis] = float(box.lower[axis] * scale + far);
        box.upper[axis] = float(box.upper[axis] * scale + far);
      }
      boxes.push_back(box);
    }
    const Bvh bvh = checked_bvh(boxes);
    const Quantisation &quantisation = bvh.quantisation;
    for (const AxisAlignedBox &box : boxes) {
      const QuantisedBounds q = quantised(quantisation, box);
      REQUIRE(contains(dequantised(quantisation, q), box));
      for (size_t axis = 0; axis < 3; ++axis) {
        if (q.lower[axis] < 65535)
          REQUIRE(quantisation.coordinate(axis, uint16_t(q.lower[axis] + 1)) > box.lower[axis]);
        if (q.upper[axis] > 0) REQUIRE(quantisation.coordinate(axis, uint16_t(q.upper[axis] - 1)) < box.upper[axis]);
      }
    }
  }
}

TEST_CASE("bvh: quantised boxes are hardly larger: by less than two steps and the roundings of floats")
{
  const std::vector<AxisAlignedBox> boxes = random_boxes(1000, 3, 1);
  const Bvh bvh = checked_bvh(boxes);
  for (const BvhNode &node : bvh.nodes) {
    if (!is_leaf(node)) continue;
    const AxisAlignedBox outer = box_of(bvh, node), &inner = boxes[size_t(node.value)];
    for (size_t axis = 0; axis < 3; ++axis) {
      CHECK(bvh.quantisation.step[axis] == Approx(21.0 / 65535).epsilon(0.05));
      CHECK(inner.lower[axis] - outer.lower[axis] <= bvh.quantisation.step[axis] + 4e-6f);
      CHECK(outer.upper[axis] - inner.upper[axis] <= bvh.quantisation.step[axis] + 4e-6f);
    }
  }
}

TEST_CASE("bvh: walks over the triangles of a mesh visit few of its nodes")
{
  const Soup sphere = icosphere(5);
  const std::vector<AxisAlignedBox> boxes = triangle_bounds(triangle_mesh(sphere.vertices, sphere.triangles, "test"));
  const Bvh bvh = checked_bvh(boxes);
  size_t found = 0;
  for_each_overlap(bvh, {{0.9f, -0.05f, -0.05f}, {1.1f, 0.05f, 0.05f}}, [&](uint32_t) { ++found; });
  CHECK(found > 0);
  CHECK(found < 100);                                                       /* of 20480 */
  CHECK(bvh.subtrees.size() < 3 * boxes.size() / (most_subtree_nodes / 2)); /* full by a third or more in the mean */
}

TEST_CASE("bvh: what has no hierarchy is refused by name")
{
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  const float largest = std::numeric_limits<float>::max();
  CHECK_THAT(refusal_of_boxes({}), ContainsSubstring("hall.glb: a hierarchy needs at least one box"));
  CHECK_THAT(refusal_of_boxes({{{0, 0, 0}, {1, 1, 1}}, {{0, 2, 0}, {1, 1, 1}}}),
             ContainsSubstring("hall.glb: box 1 runs from 2 to 1 along y"));
  CHECK_THAT(refusal_of_boxes({{{0, 0, nan}, {1, 1, 1}}}), ContainsSubstring("box 0 runs from nan to 1 along z"));
  CHECK_THAT(refusal_of_boxes({{{0, 0, 0}, {infinity, 1, 1}}}), ContainsSubstring("along x; finite numbers"));
  CHECK_THAT(refusal_of_boxes({{{-largest, 0, 0}, {largest, 1, 1}}}), ContainsSubstring("wider than floats can tell"));
}
