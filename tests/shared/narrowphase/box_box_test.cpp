/* Boxes against boxes: axis, surfaces, polygon, area and depth against the reference of box_reference.h. */
#include "tests/catch.h"

#include <map>

#include "tests/shared/narrowphase/box_reference.h"

using namespace tandem;
using namespace tandem::narrowphase_tests;

namespace {

enum Arrangement { anywhere, face_to_face, rotated_45, edge_to_edge, corner_to_face, deep, tiny_on_huge, nearly_aligned };
constexpr uint32_t arrangements = 8;

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
    b.position = (a.center() + random.direction() * random.uniform(0, a.extent().norm() + b.extent().norm())).cast<float>();
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

/* By how much a later axis must be better, as box_axes.h says. */
double lead_of(const PairScene &scene, const TestBody &a, const TestBody &b)
{
  return std::min(0.1 * scene.parameters.slop, 0.01 * std::min(a.extent().minCoeff(), b.extent().minCoeff())) +
         2 * rounding(a, b);
}

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
  if (gap < best.gap - error / best.sharpness - 2 * lead_of(scene, a, b)) return "not the axis of least overlap";
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

struct FaceCase {
  bool found = false;
  double polygon_area = 0, contact_area = 0;
};

/* Against the polygon of the face the normal belongs to: the first of a, then of b. Where two faces of the other box
 * are turned to it alike, either will do. */
std::string fault_of_polygon(const Contact &contact, const TestBody &body_a, const TestBody &body_b, double reach,
                             FaceCase &result)
{
  const ReferenceBox boxes[2] = {ReferenceBox(body_a), ReferenceBox(body_b)};
  const double tolerance = 4 * rounding(body_a, body_b);
  std::string fault;
  for (int owner = 0; owner < 2; ++owner) {
    const ReferenceBox &reference = boxes[owner], &incident = boxes[1 - owner];
    const Vector cosines = reference.axes.transpose() * contact.normal;
    int face;
    cosines.cwiseAbs().maxCoeff(&face);
    if (contact.normal.cross(Vector(reference.axes.col(face))).norm() > 1e-6) continue;
    result.found = true;
    const Vector outward = owner == 0 ? contact.normal : Vector(-contact.normal);
    const Vector turned = (incident.axes.transpose() * outward).cwiseAbs();
    for (int axis = 0; axis < 3; ++axis) {
      if (turned[axis] < turned.maxCoeff() - 1.1e-3) continue;
      fault = "";
      const Polygon polygon = contact_polygon(reference, face, outward, incident, axis);
      const double top = outward.dot(reference.center) + reference.extent[face];
      double deepest = INFINITY, highest = -INFINITY;
      for (const Vector &corner : polygon) {
        deepest = std::min(deepest, outward.dot(corner) - top);
        highest = std::max(highest, outward.dot(corner) - top);
      }
      const double size = std::min(reference.extent.lpNorm<1>(), incident.extent.lpNorm<1>());
      const double depth_tolerance = tolerance + 1e-4 * size;
      if (contact.points.empty()) {
        const Polygon narrow = contact_polygon(reference, face, outward, incident, axis, -tolerance);
        if (!narrow.empty() && deepest < reach - tolerance) fault = "no point for a polygon";
      } else {
        double found = INFINITY;
        std::vector<Vector> points;
        for (const Point &point : contact.points) {
          found = std::min(found, point.separation);
          points.push_back(point.offset);
        }
        if (polygon.empty()) {
          if (contact_polygon(reference, face, outward, incident, axis, tolerance).empty()) fault = "points of no polygon";
        } else {
          if (found > deepest + depth_tolerance) fault = "deepest point lost";
          if (found < deepest - depth_tolerance) fault = "deeper than the polygon";
          if (highest < reach - tolerance) {
            result.polygon_area = hull_area(polygon, outward);
            result.contact_area = hull_area(points, outward);
            const double negligible = tolerance * size * 4;
            if (result.contact_area > result.polygon_area + negligible) fault = "points outside the polygon";
            if (result.contact_area < 0.33 * (result.polygon_area - negligible) - 2e-4 * size * size) fault = "area lost";
          }
        }
      }
      if (fault.empty()) return fault;
    }
    return fault;
  }
  return fault;
}

} // namespace

TEST_CASE("box against box: axis, surfaces, polygon and depth of random pairs")
{
  for (float speculative : {0.02f, 100.0f}) {
    Random random(speculative < 1 ? 5 : 6);
    PairScene scene;
    scene.parameters.speculative_distance = speculative;
    std::vector<Arrangement> kinds;
    while (scene.size() < 24000) {
      kinds.push_back(Arrangement(random.below(arrangements)));
      add_random_pair(scene, random, kinds.back());
    }
    const Outputs outputs = scene.run({Kernel::collide_box_box});
    std::map<std::string, size_t> faults;
    std::map<size_t, size_t> by_count;
    size_t faces = 0, edges = 0, missed = 0;
    double least_share = 1;
    double worst_missed = 0;
    for (size_t pair = 0; pair < scene.size(); ++pair) {
      const TestBody &a = scene.a(pair), &b = scene.b(pair);
      const Contact contact = scene.contact(outputs, pair);
      by_count[contact.points.size()] += 1;
      const double overlap = -best_axis(all_axes(ReferenceBox(a), ReferenceBox(b)), rounding(a, b)).gap;
      if (contact.points.empty()) {
        if (overlap > 0) {
          ++missed;
          worst_missed = std::max(worst_missed, (overlap - 4*rounding(a,b)) / lead_of(scene, a, b));
        }
        continue;
      }
      FaceCase face;
      std::string fault = fault_of_axis(scene, contact, a, b);
      if (fault.empty()) fault = fault_of_points(contact, a, b);
      if (fault.empty()) fault = fault_of_polygon(contact, a, b, speculative, face);
      if (face.polygon_area > 1e-2 * std::pow(std::min(a.extent().minCoeff(), b.extent().minCoeff()), 2))
        least_share = std::min(least_share, face.contact_area / face.polygon_area);
      (face.found ? faces : edges) += 1;
      if (!face.found && fault.empty() && contact.points.size() != 1) fault = "edges touch in one point";
      if (!fault.empty() && faults[fault]++ < 2)
        UNSCOPED_INFO(fault << ": pair " << pair << " arrangement " << kinds[std::min(pair, kinds.size() - 1)] << " code " << contact.code
          << " points " << contact.points.size() << " areas " << face.contact_area << " of " << face.polygon_area);
    }
    for (const auto &[fault, times] : faults) UNSCOPED_INFO(fault << ": " << times << " times");
    UNSCOPED_INFO("share " << least_share << " missed " << missed << " worst " << worst_missed << " faces " << faces << " edges " << edges << " by count " << by_count[0] << " "
                            << by_count[1] << " " << by_count[2] << " " << by_count[3] << " " << by_count[4]);
    CHECK(faults.empty());
    CHECK(missed == 0);
    CHECK(faces > scene.size() / 3);
    CHECK(edges > scene.size() / 10);
  }
}
