/* pairs.h - two-body scenes for the narrowphase tests: buffers, launches through the kernel tables, results.
 *
 * Results come back in double precision, so that the references of the tests compute with them directly.
 */
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "host/runtime/interface/pair_tests.h"
#include "minicl/kernel_table.h"
#include "shared/pair_kinds.h"
#include "shared/parameters.h"

namespace tandem::narrowphase_tests {

using Vector = Eigen::Vector3d;

enum Shape : uint32_t { sphere = 0, box = 1, half_space = 2, capsule = 3 };

/* Values are kept in float, as the kernels read them, so that both sides of a comparison start from the same
 * numbers. */
struct TestBody {
  Shape shape = box;
  Eigen::Vector3f size{1, 1, 1}; /* of a capsule: its radius, half the distance of the ends, its radius again */
  Eigen::Vector3f position{0, 0, 0};
  Eigen::Quaternionf orientation{1, 0, 0, 0};
  Eigen::Vector3f linear{0, 0, 0}, angular{0, 0, 0};
  Eigen::Vector3f shape_position{0, 0, 0}; /* of a capsule in its body */
  Eigen::Quaternionf shape_orientation{1, 0, 0, 0};
  float inverse_mass = 1; /* 0: nothing that it touches moves it */

  Vector center() const { return position.cast<double>(); }
  Vector extent() const { return size.cast<double>(); }
  Eigen::Matrix3d axes() const { return orientation.cast<double>().normalized().toRotationMatrix(); }
  float bounding_radius() const
  {
    if (shape == capsule) return shape_position.norm() + size.x() + size.y();
    return shape == sphere ? size.x() : shape == box ? size.norm() : 0.0f;
  }
};

/* Where a body is after a time, if nothing changes its velocities. */
inline TestBody moved(TestBody body, double time)
{
  const double turn = body.angular.cast<double>().norm() * time;
  body.position += (time * body.linear.cast<double>()).cast<float>();
  if (turn > 0)
    body.orientation = (Eigen::Quaterniond(Eigen::AngleAxisd(turn, body.angular.cast<double>().normalized())) *
                        body.orientation.cast<double>())
                           .cast<float>();
  return body;
}

struct Point {
  Vector offset;
  double separation;
  uint32_t slot;
};

struct Contact {
  Vector normal;
  std::vector<Point> points;
  uint32_t code;
};

/* Every output word of a launch, for comparisons bit by bit. */
struct Outputs {
  std::vector<float4> normals, points;
  std::vector<uint32_t> counts, features;

  bool operator==(const Outputs &other) const
  {
    const auto same = [](const std::vector<float4> &a, const std::vector<float4> &b) {
      return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float4)) == 0;
    };
    return same(normals, other.normals) && same(points, other.points) && counts == other.counts &&
           features == other.features;
  }
};

class PairScene {
public:
  static constexpr uint32_t spare_pairs = 5; /* capacity beyond the pairs: the stride of planes is not their number */
  static constexpr uint32_t untouched = 0xcdcdcdcdu;

  PairScene()
  {
    std::memset(&parameters, 0, sizeof parameters);
    parameters.step = 1.0f / 60;
    parameters.speculative_distance = 0.02f;
    parameters.slop = 0.005f;
    parameters.slop_share = 0.05f;
  }

  void add(const TestBody &a, const TestBody &b)
  {
    pair_a_.push_back(add_body(a));
    pair_b_.push_back(add_body(b));
  }
  /* The same two bodies in the other order. */
  void add_swapped(size_t pair)
  {
    const uint32_t a = pair_b_[pair], b = pair_a_[pair];
    pair_a_.push_back(a);
    pair_b_.push_back(b);
  }
  /* Rounds up to a multiple of the most lanes. */
  void pad()
  {
    while (pair_a_.size() % 16 != 0) add_swapped(0);
  }
  size_t size() const { return pair_a_.size(); }
  const TestBody &a(size_t pair) const { return bodies_[pair_a_[pair]]; }
  const TestBody &b(size_t pair) const { return bodies_[pair_b_[pair]]; }

  Outputs run(const std::vector<Kernel> &kernels, const minicl::KernelTable &table = minicl::scalar_kernels)
  {
    pad();
    const size_t pairs = size(), capacity = pairs + spare_pairs;
    counts_.assign(COUNT_TOTAL, 0);
    counts_[COUNT_PAIRS] = static_cast<uint32_t>(pairs);
    counts_[CAPACITY_PAIRS] = static_cast<uint32_t>(capacity);
    counts_[CAPACITY_POINTS] = 4;
    list();
    Outputs outputs;
    float4 unwritten;
    std::memset(&unwritten, 0xcd, sizeof unwritten);
    outputs.normals.assign(capacity, unwritten);
    outputs.points.assign(4 * capacity, unwritten);
    outputs.counts.assign(capacity, untouched);
    outputs.features.assign(capacity, untouched);
    for (Kernel kernel : kernels) {
      std::vector<void *> arguments;
      for (const Argument &argument : row_of(kernel).arguments) arguments.push_back(storage(argument.buffer, outputs));
      const auto [first, last] = range_of(kernel);
      const auto scalar = minicl::scalar_kernels.run[index_of(kernel)];
      const auto own = table.lanes == 1 && !table.run[index_of(kernel)] ? scalar : table.run[index_of(kernel)];
      if (row_of(kernel).execution == Execution::group) {
        own(arguments.data(), 0, (last - first + TILE - 1) / TILE);
        continue;
      }
      const uint32_t whole = last - (last - first) % table.lanes;
      if (whole > first) own(arguments.data(), first, whole);
      if (last > whole) scalar(arguments.data(), whole, last);
    }
    return outputs;
  }

  /* The kinds of the pairs as find_pair_kinds tells them, which clears all outputs; none for those that are far by
   * their cores. */
  std::vector<uint32_t> kinds_by_core(Outputs &outputs, const minicl::KernelTable &table = minicl::scalar_kernels)
  {
    pad();
    while (bodies_.size() % 16 != 0) add_body(bodies_.front());
    const auto pairs = static_cast<uint32_t>(size()), bodies = static_cast<uint32_t>(bodies_.size());
    cores_.assign(2 * bodies, {});
    kinds_.assign(pairs, untouched);
    for (const auto &[kernel, items] : {std::pair{Kernel::find_cores, bodies}, {Kernel::find_pair_kinds, pairs}}) {
      std::vector<void *> arguments;
      for (const Argument &argument : row_of(kernel).arguments)
        arguments.push_back(argument.kind == Argument::Kind::value ? &by_core_ : storage(argument.buffer, outputs));
      table.run[index_of(kernel)](arguments.data(), 0, items);
    }
    return kinds_;
  }

  Contact contact(const Outputs &outputs, size_t pair) const
  {
    Contact contact;
    contact.normal = xyz(outputs.normals[pair]);
    contact.code = outputs.features[pair] >> 8;
    for (uint32_t k = 0; k < outputs.counts[pair] % TO_FOLLOW; ++k) {
      const float4 &point = outputs.points[k * outputs.counts.size() + pair];
      contact.points.push_back({xyz(point), point.w, outputs.features[pair] >> (2 * k) & 3u});
    }
    return contact;
  }

  Parameters parameters;

private:
  static Vector xyz(const float4 &r) { return {r.x, r.y, r.z}; }
  static float4 to_row(const Eigen::Vector3f &v, float w) { return {v.x(), v.y(), v.z(), w}; }

  /* Makes the lists of pairs, if the parameters say that there are any. */
  void list()
  {
    of_kind_.clear();
    for (uint32_t kind = 0; kind <= PAIR_KIND_NONE; ++kind) {
      counts_[KIND_START + kind] = static_cast<uint32_t>(of_kind_.size());
      for (uint32_t pair = 0; pair < size(); ++pair)
        if (pair_kind(flags_[pair_a_[pair]], flags_[pair_b_[pair]]) == kind) of_kind_.push_back(pair);
    }
  }
  std::pair<uint32_t, uint32_t> range_of(Kernel kernel) const
  {
    if ((parameters.features & FEATURE_PAIR_KINDS) == 0) return {0, static_cast<uint32_t>(size())};
    const auto test = std::find_if(std::begin(pair_tests), std::end(pair_tests),
                                   [&](const PairTest &row) { return row.kernel == kernel || row.follower == kernel; });
    return {counts_[KIND_START + test->kind], counts_[KIND_START + test->kind + 1]};
  }

  uint32_t add_body(const TestBody &body)
  {
    bodies_.push_back(body);
    shapes_.push_back(to_row(body.size, body.bounding_radius()));
    flags_.push_back(body.shape | 2u << 3 | 7u << 8);
    positions_.push_back(to_row(body.position, 0));
    positions_.push_back({0, 0, 0, 0});
    poses_.push_back(to_row(body.shape_position, 0));
    poses_.push_back({body.shape_orientation.x(), body.shape_orientation.y(), body.shape_orientation.z(),
                      body.shape_orientation.w()});
    poses_.insert(poses_.end(), 2, {0, 0, 0, 0}); /* a box around the shape, for other stages */
    orientations_.push_back({body.orientation.x(), body.orientation.y(), body.orientation.z(), body.orientation.w()});
    velocities_.push_back(to_row(body.linear, body.inverse_mass));
    velocities_.push_back(to_row(body.angular, 0));
    return static_cast<uint32_t>(bodies_.size() - 1);
  }

  void *storage(Buffer buffer, Outputs &outputs)
  {
    switch (buffer) {
    case Buffer::pair_a: return pair_a_.data();
    case Buffer::pair_b: return pair_b_.data();
    case Buffer::pair_of_kind: return of_kind_.data();
    case Buffer::body_flags: return flags_.data();
    case Buffer::body_shape: return shapes_.data();
    case Buffer::body_shape_pose: return poses_.data();
    case Buffer::body_position: return positions_.data();
    case Buffer::body_orientation: return orientations_.data();
    case Buffer::body_velocity: return velocities_.data();
    case Buffer::body_core: return cores_.data();
    case Buffer::sort_key: return kinds_.data();
    case Buffer::body_gravity: return nullptr; /* of batches of worlds alone */
    case Buffer::parameters: return &parameters;
    case Buffer::pair_leaf: return nullptr; /* of scenes with trees alone */
    case Buffer::counts: return counts_.data();
    case Buffer::manifold_normal: return outputs.normals.data();
    case Buffer::manifold_points: return outputs.points.data();
    case Buffer::manifold_count: return outputs.counts.data();
    case Buffer::manifold_feature: return outputs.features.data();
    default: throw std::logic_error("a narrowphase kernel reads a buffer unknown to its tests");
    }
  }

  std::vector<TestBody> bodies_;
  std::vector<float4> shapes_, poses_, positions_, orientations_, velocities_, cores_;
  std::vector<uint32_t> flags_, pair_a_, pair_b_, of_kind_, counts_, kinds_;
  uint32_t by_core_ = 1;
};

class Random {
public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high)
  {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  uint32_t below(uint32_t n) { return static_cast<uint32_t>(engine_() % n); }
  double logarithmic(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  double sign() { return below(2) ? 1.0 : -1.0; }
  Vector in_cube(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }
  Vector direction()
  {
    for (;;) {
      const Vector v = in_cube(1);
      if (v.norm() > 0.1 && v.norm() < 1) return v.normalized();
    }
  }
  Eigen::Quaterniond orientation() { return Eigen::Quaterniond(Eigen::AngleAxisd(uniform(0, 2 * M_PI), direction())); }

private:
  std::mt19937_64 engine_;
};

} // namespace tandem::narrowphase_tests
