/* Boxes against boxes: axis, surfaces, polygon, area and depth against the reference of box_reference.h. */
#include <map>

#include "tests/catch.h"
#include "tests/shared/narrowphase/box_reference.h"

using namespace tandem;
using namespace tandem::narrowphase_tests;

namespace {

enum Arrangement {
  anywhere,
  face_to_face,
  rotated_45,
  edge_to_edge,
  corner_to_face,
  deep,
  tiny_on_huge,
  nearly_aligned
};
constexpr uint32_t arrangements = 8;

/* Four of the points of a convex polygon; the deepest may stand in for one of them. */
constexpr double least_share_of_area = 0.33;

double small_gap(Random &random, double size)
{
  switch (random.below(3)) {
  case 0: return 0;
  case 1: return random.uniform(-1, 1) * 1e-6 * size;
  default: return random.uniform(-0.1, 0.02) * size;
  }
}

void resize(TestBody &body, Random &random, double low, double high)
{
  for (int k = 0; k < 3; ++k) body.size[k] = float(random.logarithmic(low, high));
}

/* b over face `face` of a, at a gap along its normal, moved sideways by a share of both sizes. */
void put_over_face(TestBody &a, TestBody &b, Random &random, double share)
{
  const ReferenceBox box_a(a);
  const int face = int(random.below(3));
  const Vector normal = box_a.axes.col(face) * random.sign();
  const double reach = (b.axes().transpose() * normal).cwiseAbs().dot(b.extent());
  const double gap = small_gap(random, std::min(a.extent().minCoeff(), b.extent().minCoeff()));
  Vector sideways = Vector::Zero();
  for (int side : {(face + 1) % 3, (face + 2) % 3})
    sideways += box_a.axes.col(side) * random.uniform(-share, share) * (a.extent()[side] + b.extent().mean());
  b.position = (a.center() + normal * (a.extent()[face] + reach + gap) + sideways).cast<float>();
}

void add_random_pair(PairScene &scene, Random &random, Arrangement arrangement)
{
  TestBody a, b;
  resize(a, random, 0.1, 2);
  resize(b, random, 0.1, 2);
  a.orientation = random.orientation().cast<float>();
  b.orientation = random.orientation().cast<float>();
  a.position = random.in_cube(1).cast<float>();
  const auto turned = [&](double angle, const Vector &axis) {
    return (Eigen::AngleAxisd(angle, axis) * a.orientation.cast<double>().normalized()).cast<float>();
  };
  switch (arrangement) {
  case anywhere:
    b.position =
        a.position + (random.direction() * random.uniform(0, a.extent().norm() + b.extent().norm())).cast<float>();
    break;
  case face_to_face:
    if (random.below(2)) b.size = a.size;
    if (random.below(2)) a.orientation = Eigen::Quaternionf::Identity();
    b.orientation = a.orientation;
    put_over_face(a, b, random, random.below(2) ? 0.4 : 0);
    break;
  case rotated_45:
    if (random.below(2)) b.size = a.size;
    b.orientation = turned(M_PI / 4, a.axes().col(random.below(3)));
    put_over_face(a, b, random, random.below(2) ? 0.4 : 0);
    break;
  case edge_to_edge: {
    const int k = int(random.below(3)), j = int(random.below(3));
    const Vector normal = Vector(a.axes().col(k)).cross(Vector(b.axes().col(j))).normalized();
    const auto edge = [&](const TestBody &body, int axis, const Vector &direction) -> Vector {
      Vector signs = (body.axes().transpose() * direction).cwiseSign().cwiseProduct(body.extent());
      signs[axis] = random.uniform(-0.9, 0.9) * body.extent()[axis];
      return body.axes() * signs;
    };
    const double gap = small_gap(random, std::min(a.extent().minCoeff(), b.extent().minCoeff()));
    b.position = (a.center() + edge(a, k, normal) - edge(b, j, -normal) + normal * gap).cast<float>();
    break;
  }
  case corner_to_face: put_over_face(a, b, random, 0.4); break;
  case deep: b.position = a.position + (random.in_cube(1) * (random.below(2) ? 0.05 : 0)).cast<float>(); break;
  case tiny_on_huge:
    resize(a, random, 1e2, 1e3);
    resize(b, random, 1e-3, 1);
    if (random.below(2)) b.orientation = a.orientation;
    put_over_face(a, b, random, 0.4);
    break;
  case nearly_aligned:
    b.orientation = turned(random.logarithmic(1e-6, 1e-2), random.direction());
    put_over_face(a, b, random, 0.4);
    break;
  }
  if (random.below(2)) std::swap(a, b);
  scene.add(a, b);
}

/* Sum of sizes and distance: what rounding errors are in proportion to. */
double span_of(const TestBody &a, const TestBody &b)
{
  return a.extent().lpNorm<1>() + b.extent().lpNorm<1>() + (b.center() - a.center()).lpNorm<1>();
}

double rounding(const TestBody &a, const TestBody &b) { return 2e-6 * span_of(a, b); }

/* The lead that a later axis needs, as in box_axes.h. */
double lead_of(const PairScene &scene, const TestBody &a, const TestBody &b)
{
  return std::min(0.1 * scene.parameters.slop, 0.01 * std::min(a.extent().minCoeff(), b.extent().minCoeff())) +
         2 * rounding(a, b);
}

/* Cosine of the angle up to which a face stands in for the axis of two edges, as box_axes.h says. */
constexpr double nearly_along = 0.99;

/* Best gap over all axes; what edges say is worth the less, the nearer they are to parallel. */
const ReferenceAxis &best_axis(const std::vector<ReferenceAxis> &axes, double error)
{
  const auto trusted = [&](const ReferenceAxis &axis) { return axis.gap - error / axis.sharpness; };
  return *std::max_element(axes.begin(), axes.end(),
                           [&](const auto &a, const auto &b) { return trusted(a) < trusted(b); });
}

/* The axis a normal was made of: faces before edges. */
ReferenceAxis nearest_axis(const std::vector<ReferenceAxis> &axes, const Vector &normal)
{
  const auto miss = [&](const ReferenceAxis &axis) {
    return (axis.direction - normal).norm() * axis.sharpness + (axis.edges ? 1e-6 : 0);
  };
  return *std::min_element(axes.begin(), axes.end(), [&](const auto &a, const auto &b) { return miss(a) < miss(b); });
}

std::string fault_of_axis(const PairScene &scene, const Contact &contact, const TestBody &a, const TestBody &b)
{
  const ReferenceBox box_a(a), box_b(b);
  const double error = rounding(a, b);
  const ReferenceAxis best = best_axis(all_axes(box_a, box_b), error);
  if (std::abs(contact.normal.norm() - 1) > 1e-6) return "normal not unit";
  const double gap = gap_along(box_a, box_b, contact.normal);
  /* Boxes with one centre part by three leads to a side of their own. */
  const double least = std::min(a.extent().minCoeff(), b.extent().minCoeff());
  const double leads = (a.center() - b.center()).norm() < 1.01e-3 * least ? 5 : 2;
  const double missing = best.gap - error / best.sharpness - leads * lead_of(scene, a, b) - gap;
  const bool face_for_edges = best.edges && !nearest_axis(all_axes(box_a, box_b), contact.normal).edges;
  const bool is_inclined = std::abs(best.direction.dot(contact.normal)) < nearly_along - 1e-5;
  if (missing > 0 && (!face_for_edges || is_inclined)) return "not the axis of least overlap";
  return "";
}

/* Each contact point lies midway between a point of the surface of a and one of the surface of b. Edges that are
 * still apart may pass each other beyond their ends; then the point is only known to be between the boxes. */
std::string fault_of_points(const Contact &contact, const TestBody &a, const TestBody &b)
{
  const ReferenceBox box_a(a), box_b(b);
  const ReferenceAxis axis = nearest_axis(all_axes(box_a, box_b), contact.normal);
  const double tolerance = 2 * rounding(a, b) / axis.sharpness;
  for (const Point &point : contact.points) {
    const Vector middle = a.center() + point.offset, half = contact.normal * point.separation / 2;
    if (axis.edges && point.separation > tolerance) {
      if (box_a.distance(middle) < point.separation / 2 - tolerance) return "point not between the boxes";
      if (box_b.distance(middle) < point.separation / 2 - tolerance) return "point not between the boxes";
      continue;
    }
    if (!(std::abs(box_a.distance(middle - half)) < tolerance)) return "point off the surface of a";
    if (!(std::abs(box_b.distance(middle + half)) < tolerance)) return "point off the surface of b";
  }
  for (size_t k = 1; k < contact.points.size(); ++k)
    if (contact.points[k].slot <= contact.points[k - 1].slot) return "slots not in order";
  return "";
}

/* Area and depth of a contact against one polygon it could stand for. */
struct PolygonMatch {
  std::string fault;
  double share = 1; /* of the polygon's area, where that is more than rounding */
};

PolygonMatch match_polygon(const Contact &contact, const ReferenceBox &reference, int face, const Vector &outward,
                           const ReferenceBox &incident, int axis, double reach, double tolerance)
{
  PolygonMatch match;
  const Polygon polygon = contact_polygon(reference, face, outward, incident, axis);
  if (polygon.empty()) {
    if (contact_polygon(reference, face, outward, incident, axis, tolerance).empty())
      match.fault = "points of no polygon";
    return match;
  }
  const double top = outward.dot(reference.center) + reference.extent[face];
  double deepest = INFINITY, highest = -INFINITY, found = INFINITY;
  for (const Vector &corner : polygon) {
    deepest = std::min(deepest, outward.dot(corner) - top);
    highest = std::max(highest, outward.dot(corner) - top);
  }
  std::vector<Vector> points;
  for (const Point &point : contact.points) {
    found = std::min(found, point.separation);
    points.push_back(point.offset);
  }
  const double size = std::min(reference.extent.lpNorm<1>(), incident.extent.lpNorm<1>());
  if (std::abs(found - deepest) > tolerance + 1e-4 * size) match.fault = "not the deepest point of the polygon";
  if (highest > reach - tolerance) return match; /* points out of reach are dropped, and their area with them */

  const double polygon_area = hull_area(polygon, outward), area = hull_area(points, outward);
  const double negligible = 4 * size * tolerance + 2e-4 * size * size;
  if (area > polygon_area + negligible) match.fault = "points outside the polygon";
  if (polygon_area > 100 * negligible) match.share = area / polygon_area;
  if (area < least_share_of_area * polygon_area - negligible) match.fault = "area lost";
  return match;
}

/* The polygon is that of the face the normal belongs to: the first of a, then of b. Where two faces of the other
 * box are turned to it alike, either will do. No owner: the normal is that of two edges. */
struct FaceCase {
  bool found = false;
  PolygonMatch match;
};

FaceCase match_faces(const Contact &contact, const TestBody &a, const TestBody &b, double reach)
{
  const ReferenceBox boxes[2] = {ReferenceBox(a), ReferenceBox(b)};
  FaceCase result;
  for (int owner = 0; owner < 2 && !result.found; ++owner) {
    const ReferenceBox &reference = boxes[owner], &incident = boxes[1 - owner];
    int face;
    (reference.axes.transpose() * contact.normal).cwiseAbs().maxCoeff(&face);
    if (contact.normal.cross(Vector(reference.axes.col(face))).norm() > 1e-6) continue;
    result.found = true;
    const Vector outward = owner == 0 ? contact.normal : Vector(-contact.normal);
    const Vector turned = (incident.axes.transpose() * outward).cwiseAbs();
    for (int axis = 0; axis < 3; ++axis) {
      if (turned[axis] < turned.maxCoeff() - 1.1e-3) continue;
      result.match = match_polygon(contact, reference, face, outward, incident, axis, reach, 4 * rounding(a, b));
      if (result.match.fault.empty()) break;
    }
  }
  return result;
}

/* The second largest gap along the face axes of one box. */
double second_gap(const ReferenceBox &of, const ReferenceBox &other)
{
  std::array<double, 3> gaps;
  for (int k = 0; k < 3; ++k)
    gaps[size_t(k)] = std::max(gap_along(of, other, of.axes.col(k)), gap_along(of, other, -of.axes.col(k)));
  std::sort(gaps.begin(), gaps.end());
  return gaps[1];
}

/* How far edges count as rounded off: the slop and a quarter more. */
double rounded_off(const PairScene &scene, const TestBody &a, const TestBody &b)
{
  const double least = std::min(a.extent().minCoeff(), b.extent().minCoeff());
  return 1.25 * std::min(double(scene.parameters.slop), scene.parameters.slop_share * least);
}

/* Whether one of two boxes has such a gap in a range of which the ends are moved apart by a margin. */
bool only_edges_meet(const PairScene &scene, const TestBody &a, const TestBody &b, double margin)
{
  const ReferenceBox box_a(a), box_b(b);
  const double rounded = rounded_off(scene, a, b);
  const auto meet = [&](double gap) { return gap > -rounded - margin && gap < margin; };
  return meet(second_gap(box_a, box_b)) || meet(second_gap(box_b, box_a));
}

/* The whole of what one pair must satisfy. */
std::string fault_of(const PairScene &scene, const Contact &contact, const TestBody &a, const TestBody &b,
                     FaceCase &face)
{
  const ReferenceAxis best = best_axis(all_axes(ReferenceBox(a), ReferenceBox(b)), rounding(a, b));
  const double reach = scene.parameters.speculative_distance;
  const double lead = lead_of(scene, a, b), error = rounding(a, b);
  if (contact.points.empty())
    return best.gap < 0 && !only_edges_meet(scene, a, b, 2 * lead + error) ? "overlap without a contact" : "";
  if (only_edges_meet(scene, a, b, -error)) return "a contact of rounded edges";
  if (best.gap > reach + rounding(a, b)) return "contact out of reach";
  for (const Point &point : contact.points)
    if (!(point.separation < reach)) return "point out of reach";
  std::string fault = fault_of_axis(scene, contact, a, b);
  if (fault.empty()) fault = fault_of_points(contact, a, b);
  if (!fault.empty()) return fault;
  face = match_faces(contact, a, b, reach);
  if (!face.found && contact.points.size() != 1) return "edges touch in one point";
  return face.match.fault;
}

/* True if no axis of another direction comes near the best one: neither rounding nor the order of bodies decides. */
bool axis_is_clear(const PairScene &scene, const TestBody &a, const TestBody &b)
{
  const std::vector<ReferenceAxis> axes = all_axes(ReferenceBox(a), ReferenceBox(b));
  const ReferenceAxis best = best_axis(axes, rounding(a, b));
  return std::all_of(axes.begin(), axes.end(), [&](const ReferenceAxis &axis) {
    const double margin = 2 * lead_of(scene, a, b) + 2 * rounding(a, b) / axis.sharpness;
    const bool face_for_edges =
        best.edges && !axis.edges && std::abs(best.direction.dot(axis.direction)) > nearly_along - 1e-5;
    return (axis.gap < best.gap - margin && !face_for_edges) || (axis.direction - best.direction).norm() < 1e-9;
  });
}

/* Pairs of all arrangements; the pair after each is the same one the other way round. */
PairScene random_scene(float speculative_distance, uint64_t seed, std::vector<Arrangement> &arrangements_of)
{
  Random random(seed);
  PairScene scene;
  scene.parameters.speculative_distance = speculative_distance;
  while (scene.size() < 40000) {
    const Arrangement arrangement = Arrangement(random.below(arrangements));
    arrangements_of.insert(arrangements_of.end(), {arrangement, arrangement});
    add_random_pair(scene, random, arrangement);
    scene.add_swapped(scene.size() - 1);
  }
  return scene;
}

} // namespace

TEST_CASE("box against box: axis, surfaces, polygon and depth of random pairs")
{
  for (float speculative_distance : {0.02f, 100.0f}) { /* as a world has it; and so large that all points are kept */
    std::vector<Arrangement> arrangements_of;
    PairScene scene = random_scene(speculative_distance, speculative_distance < 1 ? 5 : 6, arrangements_of);
    const Outputs outputs = scene.run({Kernel::collide_box_box});
    std::map<std::string, size_t> faults;
    size_t faces = 0, edges = 0, none = 0;
    double least_share = 1;
    for (size_t pair = 0; pair < scene.size(); ++pair) {
      const Contact contact = scene.contact(outputs, pair);
      FaceCase face;
      const std::string fault = fault_of(scene, contact, scene.a(pair), scene.b(pair), face);
      (contact.points.empty() ? none : face.found ? faces : edges) += 1;
      least_share = std::min(least_share, face.match.share);
      if (!fault.empty() && faults[fault]++ == 0)
        UNSCOPED_INFO(fault << ": pair " << pair << ", arrangement " << arrangements_of[pair]);
    }
    for (const auto &[fault, times] : faults) UNSCOPED_INFO(fault << ": " << times << " times");
    CHECK(faults.empty());
    CHECK(least_share > least_share_of_area);
    CHECK(faces > scene.size() / 3);
    CHECK(edges > scene.size() / 10);
    if (speculative_distance < 1) CHECK(none > scene.size() / 20);
  }
}

TEST_CASE("two boxes the other way round have the opposite normal and the same depth")
{
  std::vector<Arrangement> arrangements_of;
  PairScene scene = random_scene(0.02f, 7, arrangements_of);
  const Outputs outputs = scene.run({Kernel::collide_box_box});
  size_t compared = 0, wrong = 0;
  for (size_t pair = 0; pair + 1 < arrangements_of.size(); pair += 2) {
    const TestBody &a = scene.a(pair), &b = scene.b(pair);
    const Contact forth = scene.contact(outputs, pair), back = scene.contact(outputs, pair + 1);
    if (forth.points.empty() || back.points.empty() || !axis_is_clear(scene, a, b)) continue;
    /* Opposite normals of two boxes with one centre are equivalent. */
    if (std::abs(forth.normal.dot(b.center() - a.center())) < rounding(a, b)) continue;
    ++compared;
    const auto deepest = [](const Contact &contact) {
      double least = INFINITY;
      for (const Point &point : contact.points) least = std::min(least, point.separation);
      return least;
    };
    const double size = std::min(a.extent().lpNorm<1>(), b.extent().lpNorm<1>());
    if ((forth.normal + back.normal).norm() > 1e-3 ||
        std::abs(deepest(forth) - deepest(back)) > 4 * rounding(a, b) + 2e-4 * size)
      if (wrong++ < 3) UNSCOPED_INFO("pair " << pair << ", arrangement " << arrangements_of[pair]);
  }
  CHECK(wrong == 0);
  CHECK(compared > scene.size() / 16);
}

TEST_CASE("a box resting on a box keeps feature code and slots while it jitters")
{
  for (double angle : {0.0, 0.3, M_PI / 4}) {
    for (bool upper_first : {true, false}) {
      Random random(8);
      PairScene scene;
      for (int frame = 0; frame < 100; ++frame) {
        TestBody lower, upper;
        lower.size = {0.5f, 0.5f, 0.5f};
        upper.size = angle == 0.3 ? Eigen::Vector3f(0.3f, 0.2f, 0.4f) : lower.size;
        upper.position = {0, lower.size.y() + upper.size.y() - 0.001f, 0};
        upper.position += (random.in_cube(1e-6)).cast<float>();
        upper.orientation = (Eigen::AngleAxisd(1e-6 * random.uniform(-1, 1), random.direction()) *
                             Eigen::AngleAxisd(angle, Vector::UnitY()))
                                .cast<float>();
        if (upper_first) scene.add(upper, lower);
        else scene.add(lower, upper);
      }
      const Outputs outputs = scene.run({Kernel::collide_box_box});
      const Contact first = scene.contact(outputs, 0);
      REQUIRE(first.points.size() == 4);
      for (size_t frame = 1; frame < 100; ++frame) {
        const Contact contact = scene.contact(outputs, frame);
        REQUIRE(outputs.features[frame] == outputs.features[0]);
        REQUIRE(contact.points.size() == 4);
        for (size_t k = 0; k < 4; ++k) REQUIRE((contact.points[k].offset - first.points[k].offset).norm() < 1e-3);
      }
    }
  }
}

TEST_CASE("aligned boxes touch in the four corners of their overlap, far from the origin too")
{
  for (float far : {0.0f, 4096.0f}) {
    TestBody lower, upper;
    lower.position = {far, far, far};
    upper.position = {far + 0.5f, far + 2 - 0.0078125f, far - 0.25f};
    PairScene scene;
    scene.add(upper, lower);
    const Contact contact = scene.contact(scene.run({Kernel::collide_box_box}), 0);
    REQUIRE(contact.points.size() == 4);
    CHECK(contact.normal == Vector(0, -1, 0));
    std::vector<Vector> offsets;
    for (const Point &point : contact.points) {
      CHECK(point.separation == Approx(-0.0078125));
      CHECK(point.offset.y() == Approx(-1 + 0.0078125 / 2));
      offsets.push_back(point.offset);
    }
    CHECK(hull_area(offsets, Vector::UnitY()) == Approx(1.5 * 1.75));
  }
}

/* A contact acts within a step of `step` seconds if its point closes by more than its separation. */
bool acts(const TestBody &a, const TestBody &b, const Contact &contact, double step)
{
  return std::any_of(contact.points.begin(), contact.points.end(), [&](const Point &point) {
    const Vector arm_b = a.center() + point.offset - b.center();
    const Vector approach = (a.linear - b.linear).cast<double>() + a.angular.cast<double>().cross(point.offset) -
                            b.angular.cast<double>().cross(arm_b);
    return approach.dot(contact.normal) * step > point.separation;
  });
}

TEST_CASE("contacts are made as far ahead as two bodies can close in a step")
{
  const auto follow = [](float gap, float speed, float spin, auto finds) {
    TestBody lower, upper;
    upper.position = {0, 2 + gap, 0};
    upper.linear = {0, -speed, 0};
    upper.angular = {0, 0, spin};
    PairScene scene;
    scene.parameters.step = 0.125f;
    scene.add(upper, lower);
    scene.add(lower, upper);
    const Outputs outputs = scene.run({Kernel::collide_box_box, Kernel::follow_boxes});
    CHECK(outputs.counts[0] == outputs.counts[1]);
    return finds(scene, outputs);
  };
  const auto touches = [&](float gap, float speed, float spin) {
    return follow(gap, speed, spin, [](const PairScene &, const Outputs &outputs) { return outputs.counts[0] > 0; });
  };
  const auto stops = [&](float gap, float spin) {
    return follow(gap, 0, spin, [](const PairScene &scene, const Outputs &outputs) {
      return outputs.counts[0] > 0 && acts(scene.a(0), scene.b(0), scene.contact(outputs, 0), scene.parameters.step);
    });
  };
  CHECK(touches(0.019f, 0, 0));
  CHECK_FALSE(touches(0.021f, 0, 0));
  CHECK(touches(0.26f, 2, 0));
  CHECK_FALSE(touches(0.28f, 2, 0));
  CHECK_FALSE(touches(0.021f, -2, 0));
  /* Turned by 0.25 rad its lowest edge is cos 0.25 + sin 0.25 = 1.216 m below its middle. */
  CHECK(stops(0.21f, 2));
  CHECK_FALSE(stops(0.225f, 2));
  CHECK_FALSE(stops(0.44f, 2));
}

TEST_CASE("boxes with one centre have finite contacts and the axis of their least size")
{
  TestBody a, b;
  a.size = {0.5f, 0.25f, 1};
  b.size = {0.5f, 0.25f, 1};
  PairScene scene;
  scene.add(a, b);
  const Contact contact = scene.contact(scene.run({Kernel::collide_box_box}), 0);
  REQUIRE(contact.points.size() == 4);
  CHECK(std::abs(contact.normal.y()) == 1);
  for (const Point &point : contact.points) CHECK(point.separation == Approx(-0.5));
}

TEST_CASE("cubes with one centre part sideways, some along each axis and to each side")
{
  PairScene scene;
  const size_t pairs = 256;
  while (scene.size() < pairs) scene.add(TestBody(), TestBody());
  const Outputs outputs = scene.run({Kernel::collide_box_box});
  std::map<int, size_t> times;
  for (size_t pair = 0; pair < pairs; ++pair) {
    const Contact contact = scene.contact(outputs, pair);
    REQUIRE(contact.points.size() == 4);
    REQUIRE(contact.normal.y() == 0);
    REQUIRE(contact.points[0].separation == -2);
    ++times[int(contact.normal.x()) + 3 * int(contact.normal.z())];
  }
  for (int side : {1, -1, 3, -3}) CHECK(times[side] > pairs / 8);
}

/* Two boxes of 2 m, b beside a at the first gap and above it at the second. */
TEST_CASE("boxes of which only edges thinner than the slop meet are apart, in every direction")
{
  const auto points = [](double beside, double above, int side_axis, int up_axis, double angle) {
    TestBody a, b;
    b.position[side_axis] = float(2 + beside);
    b.position[up_axis] = float(2 + above);
    const Eigen::Quaternionf turn(Eigen::AngleAxisf(float(angle), Eigen::Vector3f(1, 2, 3).normalized()));
    a.orientation = b.orientation = turn;
    b.position = turn * b.position;
    PairScene scene;
    scene.add(a, b);
    scene.add(b, a);
    const Outputs outputs = scene.run({Kernel::collide_box_box});
    CHECK(outputs.counts[0] == outputs.counts[1]);
    return outputs.counts[0];
  };
  for (double angle : {0.0, 0.5})
    for (int side = 0; side < 3; ++side)
      for (int up = 0; up < 3; ++up) {
        if (side == up) continue;
        CAPTURE(side, up, angle);
        for (double beside : {0.015, 1e-3, -1e-3, -0.004, -0.006}) CHECK(points(beside, -0.005, side, up, angle) == 0);
        CHECK(points(-0.012, -0.005, side, up, angle) == 4); /* carried: 12 mm wide */
        CHECK(points(0.015, -0.03, side, up, angle) == 4);   /* a step of 3 cm, ahead */
        CHECK(points(-0.001, -0.03, side, up, angle) == 4);
        CHECK(points(-1, -0.005, side, up, angle) == 4);
        CHECK(points(-1, 0.005, side, up, angle) == 4);
      }
}

TEST_CASE("small boxes have edges rounded off by less")
{
  TestBody a, b;
  a.size = b.size = {0.02f, 0.02f, 0.02f}; /* so by 1.25 mm */
  PairScene scene;
  b.position = {0.038f, 0.039f, 0};
  scene.add(a, b);
  b.position = {0.039f, 0.0392f, 0};
  scene.add(a, b);
  const Outputs outputs = scene.run({Kernel::collide_box_box});
  CHECK(outputs.counts[0] == 4);
  CHECK(outputs.counts[1] == 0);
}
