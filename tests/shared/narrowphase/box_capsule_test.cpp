/* A box against a capsule, in double precision: the distance by a search along the segment, and the depth along all
 * directions in which a segment can leave a box. */
#include "tests/shared/narrowphase/capsules.h"

using namespace tandem;
using namespace tandem::narrowphase_tests;

namespace {

struct Boxed { /* a segment in the axes of a box */
  Vector middle, half, extent;

  Vector at(double place) const { return middle + place * half; }
};

Boxed boxed(const TestBody &box, const TestBody &rod)
{
  const Segment segment = segment_of(rod);
  return {box.axes().transpose() * (segment.middle() - box.center()), box.axes().transpose() * segment.half(),
          box.extent()};
}

double distance_of(const Vector &point, const Vector &extent)
{
  return (point - point.cwiseMin(extent).cwiseMax(-extent)).norm();
}

/* The distance is convex along the segment. */
double distance_of(const Boxed &s)
{
  double low = -1, high = 1;
  for (int k = 0; k < 200; ++k) {
    const double first = low + (high - low) * 0.45, second = high - (high - low) * 0.45;
    (distance_of(s.at(first), s.extent) <= distance_of(s.at(second), s.extent) ? high : low) =
        distance_of(s.at(first), s.extent) <= distance_of(s.at(second), s.extent) ? second : first;
  }
  return distance_of(s.at((low + high) / 2), s.extent);
}

/* The gap along a unit direction from the box to the segment, in the axes of the box. */
double gap_along(const Boxed &s, const Vector &outward)
{
  return outward.dot(s.middle) - std::abs(outward.dot(s.half)) - outward.cwiseAbs().dot(s.extent);
}

double depth_of(const Boxed &s)
{
  double least = 1e30;
  for (int k = 0; k < 3; ++k) {
    const Vector axis = Vector::Unit(k), across = axis.cross(s.half);
    for (const Vector &direction : {axis, across}) {
      if (direction.norm() <= 1e-12 * s.half.norm()) continue;
      for (double side : {-1.0, 1.0}) least = std::min(least, -gap_along(s, side * direction.normalized()));
    }
  }
  return least;
}

double separation_from_box(const TestBody &a, const TestBody &b)
{
  if (a.shape == capsule) return separation_from_box(b, a);
  const Boxed s = boxed(a, b);
  const double distance = distance_of(s);
  return (distance > 1e-9 ? distance : -depth_of(s)) - radius_of(b);
}

TestBody random_box(Random &random, double low, double high)
{
  TestBody body;
  for (int k = 0; k < 3; ++k) body.size[k] = float(random.logarithmic(low, high));
  body.orientation = random.orientation().cast<float>();
  body.position = random.in_cube(1).cast<float>();
  return body;
}

/* Beside faces, edges and corners, lying, standing and leaning, and within each other. */
PairScene random_pairs(Random &random, size_t count)
{
  PairScene scene;
  while (scene.size() < count) {
    const bool extreme = random.below(4) == 0;
    const TestBody box = random_box(random, extreme ? 1e-2 : 0.1, extreme ? 10 : 1);
    TestBody rod = random_round(random, capsule, extreme ? 1e-2 : 0.1, extreme ? 10 : 1);
    if (random.below(2)) { /* along a face or an edge, or nearly so */
      const double angle = random.below(3) ? random.logarithmic(1e-5, 0.3) : 0;
      const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, random.direction())),
          around(Eigen::AngleAxisd(random.below(2) ? 0 : random.uniform(0, 7), Vector::UnitX())),
          to(Eigen::Quaterniond::FromTwoVectors(Vector::UnitY(), Vector::Unit(int(random.below(3)))));
      rod.orientation = (box.orientation.cast<double>() * turn * around * to).cast<float>();
      rod.shape_orientation = Eigen::Quaternionf::Identity();
    }
    /* A point of the box, and the way on which the segment leaves it. */
    Vector at = random.in_cube(1.5).cwiseMin(1).cwiseMax(-1).cwiseProduct(box.extent());
    const Vector outward = box.axes() * random.direction();
    const double size = std::min(radius_of(rod), double(box.size.minCoeff()));
    const double gap = random.below(2) ? random.uniform(-1, 1) * 1e-2 * size : random.uniform(-1.5, 1) * size;
    rod.position +=
        (box.center() + box.axes() * at - segment_of(rod).middle() + segment_of(rod).half() * random.uniform(-1.2, 1.2))
            .cast<float>();
    double low = 0, high = 2 * (size_of(rod) + box.extent().norm());
    const TestBody start = rod;
    for (int k = 0; k < 40; ++k) {
      const double way = (low + high) / 2;
      rod.position = start.position + (way * outward).cast<float>();
      (separation_from_box(box, rod) > gap ? high : low) = way;
    }
    if (random.below(2)) scene.add(box, rod);
    else scene.add(rod, box);
  }
  return scene;
}

struct Seen { /* from the box */
  const TestBody &box, &rod;
  Vector outward, center; /* center: of body a */
};

Seen seen(const PairScene &scene, size_t pair, const Contact &contact)
{
  const TestBody &a = scene.a(pair), &b = scene.b(pair);
  return a.shape == box ? Seen{a, b, contact.normal, a.center()} : Seen{b, a, -contact.normal, a.center()};
}

bool is_contact_of(const Seen &pair, const Contact &contact, double separation, double tolerance)
{
  const TestBody &rod = pair.rod;
  const Segment segment = segment_of(rod);
  const Boxed s = boxed(pair.box, rod);
  if (std::abs(contact.normal.norm() - 1) > 1e-6) return false;
  /* No normal shows a larger gap than the separation; the way out may be longer than the shortest by two hundredths. */
  const double depth = separation + radius_of(rod), gap = gap_along(s, pair.box.axes().transpose() * pair.outward);
  const double longer = depth < 0 ? 0.021 * -depth : 0;
  if (gap > depth + tolerance || gap < depth - longer - tolerance) return false;
  double least = 1e30;
  const bool two = contact.points.size() > 1;
  for (const Point &point : contact.points) {
    const Vector at = pair.center + point.offset, on_rod = at + pair.outward * (radius_of(rod) + point.separation / 2),
                 on_box = pair.box.axes().transpose() * (at - pair.outward * point.separation / 2 - pair.box.center());
    if (segment.distance_to(on_rod) > tolerance) return false;
    /* A normal that leans over an edge, or an edge that is not quite parallel, leads beside the face. */
    const double beside =
        two ? 0.5 * std::max(point.separation + radius_of(rod), 0.0) + 0.03 * 2 * segment.half().norm() : 0;
    if (distance_of(on_box, s.extent) > tolerance + beside) return false;
    least = std::min(least, point.separation);
  }
  /* Of a segment that has entered the box, its deepest end may have left it beside the face. */
  const double beyond = depth < 0 ? 2 * std::abs(s.half.dot(pair.box.axes().transpose() * pair.outward)) : 0;
  const double lead = two ? beyond : 0;
  return least > separation - longer - tolerance && least < separation + tolerance + lead;
}

} // namespace

TEST_CASE("box and capsule: at rest, contacts of the nearest points, or along the way out")
{
  Random random(31);
  PairScene scene = random_pairs(random, 30000);
  const Outputs outputs = scene.run({Kernel::collide_box_capsule});
  size_t touching = 0, apart = 0, two = 0, deep = 0, wrong = 0;
  for (size_t pair = 0; pair < scene.size(); ++pair) {
    const Contact contact = scene.contact(outputs, pair);
    const Seen sides = seen(scene, pair, contact);
    const double separation = separation_from_box(sides.box, sides.rod),
                 limit = double(scene.parameters.speculative_distance),
                 tolerance = 6e-6 * ((sides.rod.center() - sides.box.center()).norm() + size_of(sides.rod) +
                                     sides.box.extent().norm());
    if (std::abs(separation - limit) < tolerance) continue;
    const bool near = separation < limit;
    (near ? touching : apart) += 1;
    two += contact.points.size() == 2;
    deep += separation < -radius_of(sides.rod);
    /* Where the segment all but touches the box, rounding decides the normal. */
    if (std::abs(separation + radius_of(sides.rod)) < 64 * tolerance) continue;
    const bool good =
        near ? !contact.points.empty() && is_contact_of(sides, contact, separation, tolerance) : contact.points.empty();
    if (!good && wrong++ < 5) {
      CAPTURE(pair, separation, radius_of(sides.rod), contact.points.size(), sides.outward, tolerance);
      for (const Point &point : contact.points) UNSCOPED_INFO("separation " << point.separation);
      CHECK(good);
    }
  }
  CAPTURE(touching, apart, two, deep);
  CHECK(wrong == 0);
  CHECK(touching > scene.size() / 3);
  CHECK(apart > scene.size() / 50);
  CHECK(two > scene.size() / 10);
  CHECK(deep > scene.size() / 50);
}

TEST_CASE("box and capsule: above a face the contacts are the ends of what lies above it")
{
  TestBody box;
  box.size = {1.0f, 0.5f, 2.0f};
  for (const double shift : {-1.6, -0.5, 0.0, 0.3, 1.1, 1.7})
    for (const double tilt : {0.0, 0.002, -0.002}) {
      PairScene scene;
      scene.add(box, lying_capsule(0.25, 0.8, {shift, 0.75 + 0.8 * std::abs(tilt), 0.7}, {1, tilt, 0}));
      const Contact contact = scene.contact(scene.run({Kernel::collide_box_capsule}), 0);
      CAPTURE(shift, tilt);
      REQUIRE(contact.points.size() == 2);
      CHECK(contact.normal.y() == Approx(1).margin(1e-5));
      std::vector<double> x = {contact.points[0].offset.x(), contact.points[1].offset.x()};
      std::sort(x.begin(), x.end());
      CHECK(x[0] == Approx(std::max(-1.0, shift - 0.8)).margin(1e-3));
      CHECK(x[1] == Approx(std::min(1.0, shift + 0.8)).margin(1e-3));
      CHECK(contact.points[0].slot != contact.points[1].slot);
    }
}

TEST_CASE("box and capsule: along an edge it has two contacts, across an edge and at a corner one")
{
  TestBody box; /* 2 m wide */
  const Vector beside = Vector(0, 1, 1).normalized();
  const auto points = [&](const Vector &at, const Vector &axis) {
    PairScene scene;
    scene.add(lying_capsule(0.25, 0.6, at, axis), box);
    const Contact contact = scene.contact(scene.run({Kernel::collide_box_capsule}), 0);
    REQUIRE_FALSE(contact.points.empty());
    return contact;
  };
  const Contact along = points(Vector(0.2, 1, 1) + 0.25 * beside, {1, 0, 0});
  REQUIRE(along.points.size() == 2);
  CHECK((along.normal + beside).norm() < 1e-5);
  for (const Point &point : along.points) CHECK(std::abs(point.separation) < 1e-5);
  CHECK(points(Vector(0.2, 1, 1) + 0.25 * beside, {0.3, 1, -1}).points.size() == 1);
  const Contact corner = points(Vector(1, 1, 1) + 0.25 * Vector(1, 1, 1).normalized(), {1, -1, 0});
  REQUIRE(corner.points.size() == 1);
  CHECK((corner.normal + Vector(1, 1, 1).normalized()).norm() < 1e-5);
  const Contact hanging = points({0, 1.24, 1.05}, {1, 0, 0}); /* its axis is beyond the edge of the top */
  REQUIRE(hanging.points.size() == 2);
  CHECK(hanging.normal.z() < -0.15);
}

TEST_CASE("box and capsule: one that leans a little along an edge keeps both contacts")
{
  TestBody box; /* 2 m wide */
  for (const double sag : {-0.012, -0.003, -0.0011, -0.0009, 0.0, 0.0009, 0.0011, 0.003, 0.012}) {
    PairScene scene;
    const Vector beside = Vector(0, 1, 1).normalized();
    scene.add(box, lying_capsule(0.25, 0.6, Vector(0.7, 1, 1) + 0.245 * beside, Vector(1, sag, sag)));
    const Contact contact = scene.contact(scene.run({Kernel::collide_box_capsule}), 0);
    CAPTURE(sag);
    REQUIRE(contact.points.size() == 2);
    for (const Point &point : contact.points) {
      const Vector on_edge = Vector(point.offset.x(), 1, 1), axis = Vector(1, sag, sag).normalized();
      const Vector from = on_edge - (Vector(0.7, 1, 1) + 0.245 * beside);
      const double distance = (from - from.dot(axis) * axis).norm();
      CHECK(point.separation == Approx(distance - 0.25).margin(1e-3));
    }
  }
}

TEST_CASE("box and capsule: a large floor is no less exact than a small one")
{
  Random random(35);
  for (const double size : {10.0, 100.0, 1000.0}) {
    PairScene scene;
    while (scene.size() < 4000) {
      TestBody floor;
      floor.size = Eigen::Vector3f(float(size), 0.5f, float(size));
      const Vector axis =
          Vector(random.below(2) ? random.logarithmic(1e-5, 1) : 0, random.uniform(-0.5, 0.5), 1).normalized();
      const double half = 0.4, edge = random.below(2) ? size : random.uniform(-size, size);
      const double height = 0.5 + half * std::abs(axis.y()) + 0.05 + random.uniform(-0.04, 0.01);
      scene.add(floor,
                lying_capsule(
                    0.05, half,
                    {edge + random.uniform(-1, 1) * half * axis.x(), height, random.uniform(-0.9, 0.9) * size}, axis));
    }
    const Outputs outputs = scene.run({Kernel::collide_box_capsule});
    double worst = 0;
    size_t near = 0;
    for (size_t pair = 0; pair < scene.size(); ++pair) {
      const double separation = separation_from_box(scene.a(pair), scene.b(pair));
      double least = 1e30;
      for (const Point &point : scene.contact(outputs, pair).points) least = std::min(least, point.separation);
      if (separation > double(scene.parameters.speculative_distance) - 1e-4) continue; /* beside the floor */
      ++near;
      worst = std::max(worst, std::abs(least - separation));
    }
    CAPTURE(size);
    CHECK(near > scene.size() / 2);
    CHECK(worst < 6e-5 + 5e-7 * size); /* of a radius of 5 cm; two points may be less deep than one by 1e-4 of it */
  }
}

TEST_CASE("box and capsule: in motion, contacts of the moment at which they touch, and none where they pass")
{
  Random random(33);
  PairScene scene;
  while (scene.size() < 4000) {
    TestBody box = random_box(random, 0.05, 0.5), rod = random_round(random, capsule, 0.05, 0.5);
    const Vector direction = random.direction();
    rod.position =
        box.position +
        (direction * double(box.bounding_radius() + rod.bounding_radius()) * random.uniform(0.7, 2.5)).cast<float>();
    set_in_motion(random, box, direction);
    set_in_motion(random, rod, -direction);
    if (separation_from_box(box, rod) <= 0) continue;
    if (random.below(2)) scene.add(box, rod);
    else scene.add(rod, box);
  }
  compare_in_motion(scene, {Kernel::collide_box_capsule, Kernel::follow_box_capsules}, separation_from_box);
}
