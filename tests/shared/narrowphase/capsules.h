/* capsules.h - capsules for the narrowphase tests: their segments, random ones, and the contacts of what moves. */
#pragma once

#include "tests/catch.h"
#include "tests/shared/narrowphase/pairs.h"

namespace tandem::narrowphase_tests {

struct Segment {
  Vector low, high;

  Vector middle() const { return (low + high) / 2; }
  Vector half() const { return (high - low) / 2; }
  double distance_to(const Vector &p) const
  {
    const Vector along = high - low;
    const double squared = along.squaredNorm();
    const double t = squared > 0 ? std::clamp((p - low).dot(along) / squared, 0.0, 1.0) : 0;
    return (low + t * along - p).norm();
  }
};

inline Segment segment_of(const TestBody &body)
{
  const Eigen::Matrix3d own = body.shape_orientation.cast<double>().normalized().toRotationMatrix();
  const Vector middle = body.center() + body.axes() * body.shape_position.cast<double>();
  const Vector half = body.axes() * own.col(1) * (body.shape == capsule ? double(body.size.y()) : 0.0);
  return {middle - half, middle + half};
}
inline double radius_of(const TestBody &body) { return double(body.size.x()); }
inline double size_of(const TestBody &body) { return segment_of(body).half().norm() + radius_of(body); }

inline TestBody random_round(Random &random, Shape shape, double low, double high)
{
  TestBody body;
  body.shape = shape;
  body.size.x() = body.size.z() = float(random.logarithmic(low, high));
  body.size.y() = float(random.logarithmic(low, high));
  body.orientation = random.orientation().cast<float>();
  if (shape == capsule && random.below(3) == 0) {
    body.shape_position = random.in_cube(double(body.size.y())).cast<float>();
    body.shape_orientation = random.orientation().cast<float>();
  }
  return body;
}

inline TestBody lying_capsule(double radius, double half, const Vector &at, const Vector &axis)
{
  TestBody body;
  body.shape = capsule;
  body.size = Eigen::Vector3f(float(radius), float(half), float(radius));
  body.position = at.cast<float>();
  body.orientation = Eigen::Quaterniond::FromTwoVectors(Vector::UnitY(), axis).cast<float>();
  return body;
}

inline double least_size_of(const TestBody &body)
{
  if (body.shape == half_space) return 1e30;
  return body.shape == box ? double(body.size.minCoeff()) : radius_of(body);
}

/* Contacts of moving bodies: none of the two touches before the moment of the contacts, they touch then, and pairs that
 * lose their contacts miss. */
template <class Separation>
void compare_in_motion(PairScene scene, const std::vector<Kernel> &kernels, const Separation &separation_of)
{
  const Outputs outputs = scene.run(kernels);
  const double step = scene.parameters.step;
  size_t at_impact = 0, guarded = 0, missing = 0, wrong = 0;
  for (size_t pair = 0; pair < scene.size(); ++pair) {
    const TestBody &a = scene.a(pair), &b = scene.b(pair);
    const double moment = std::abs(outputs.normals[pair].w), time = moment > 1e-11 ? moment : 0,
                 start = separation_of(a, b),
                 tolerance =
                     1e-5 * ((b.center() - a.center()).norm() + double(a.bounding_radius() + b.bounding_radius()) +
                             step * (a.linear - b.linear).norm());
    const double least = std::min(least_size_of(a), least_size_of(b));
    const double touching = std::min(1e-3 * least, 0.02 * double(scene.parameters.slop)) + tolerance;
    const auto least_until = [&](double end) {
      double found = 1e30;
      for (int k = 0; k <= 96; ++k)
        found = std::min(found, separation_of(moved(a, end * k / 96), moved(b, end * k / 96)));
      return found;
    };
    bool good = true;
    if (time > 0 && std::abs(time - step) > 1e-9) {
      ++at_impact;
      good = least_until(time * 0.999) > -tolerance && separation_of(moved(a, time), moved(b, time)) < touching;
    } else if (time > 0) {
      ++guarded;
      good = least_until(step) > -tolerance;
    } else if (outputs.counts[pair] == 0 && start > 0) {
      ++missing;
      good = least_until(step) > -tolerance;
    }
    if (!good && wrong++ < 3) {
      CAPTURE(pair, time, start, least_until(step), separation_of(moved(a, time), moved(b, time)), touching);
      CHECK(good);
    }
  }
  CAPTURE(at_impact, guarded, missing);
  CHECK(wrong == 0);
  CHECK(at_impact > scene.size() / 10);
  CHECK(missing > scene.size() / 20);
}

inline void set_in_motion(Random &random, TestBody &body, const Vector &towards)
{
  body.linear = (random.logarithmic(1, 300) * (towards + 0.4 * random.in_cube(1))).cast<float>();
  body.angular = random.in_cube(random.logarithmic(0.1, 60)).cast<float>();
}

} // namespace tandem::narrowphase_tests
