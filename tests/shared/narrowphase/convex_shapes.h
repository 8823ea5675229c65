/* convex_shapes.h - convex shapes for the tests of the narrowphase, and references for them in double precision.
 *
 * The references share nothing with the kernels: supports and distances of a point from closed forms, hulls from all
 * triples of points, depths from all faces and all pairs of edges. Both sides start from the same float numbers.
 */
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <vector>

#include <Eigen/Geometry>

#include "host/scene/hull_chunks.h"
#include "shared/narrowphase/convex_contact.h"
#include "shared/narrowphase/convex_half_space.h"

namespace tandem::convex_tests {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

class Random {
public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high)
  {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  uint32_t below(uint32_t n) { return static_cast<uint32_t>(engine_() % n); }
  double logarithmic(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
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

/* A convex polytope with the tables that the kernels read. */
struct Hull {
  std::vector<Vector> vertices;
  struct Face {
    std::vector<uint32_t> corners;
    Vector normal;
    double distance;
  };
  std::vector<Face> faces;
  std::vector<std::array<uint32_t, 4>> edges;

  std::vector<uint> headers, face_starts, corners, edge_table, links;
  uint support = SUPPORT_BRUTE_FORCE;
  std::vector<float4> rows, planes, chunks;

  hull_tables tables() const
  {
    return {headers.data(), rows.data(),       planes.data(), face_starts.data(),
            corners.data(), edge_table.data(), chunks.data(), links.data(),
            nullptr,        nullptr,           support};
  }
};

/* The face through three points, if all others lie behind it. */
inline bool supporting_face(const std::vector<Vector> &points, const std::array<size_t, 3> &three, double tolerance,
                            Hull::Face &face)
{
  Vector normal = (points[three[1]] - points[three[0]]).cross(points[three[2]] - points[three[0]]);
  if (normal.norm() < tolerance * tolerance) return false;
  normal.normalize();
  double above = -1e300, below = 1e300;
  const double distance = normal.dot(points[three[0]]);
  for (const Vector &p : points) {
    above = std::max(above, normal.dot(p) - distance);
    below = std::min(below, normal.dot(p) - distance);
  }
  if (above > tolerance && below < -tolerance) return false;
  if (above > tolerance) normal = -normal;
  face.normal = normal;
  face.distance = normal.dot(points[three[0]]);
  face.corners.clear();
  for (size_t k = 0; k < points.size(); ++k)
    if (normal.dot(points[k]) > face.distance - tolerance) face.corners.push_back(static_cast<uint32_t>(k));
  return true;
}

inline void sort_corners(const std::vector<Vector> &points, Hull::Face &face)
{
  Vector middle = Vector::Zero();
  for (uint32_t k : face.corners) middle += points[k] / double(face.corners.size());
  const Vector u = face.normal.unitOrthogonal(), v = face.normal.cross(u);
  std::sort(face.corners.begin(), face.corners.end(), [&](uint32_t a, uint32_t b) {
    const Vector p = points[a] - middle, q = points[b] - middle;
    return std::atan2(p.dot(v), p.dot(u)) < std::atan2(q.dot(v), q.dot(u));
  });
}

inline std::shared_ptr<Hull> make_hull(const std::vector<Vector> &given)
{
  constexpr uint map_side = 8;
  auto hull = std::make_shared<Hull>();
  for (const Vector &p : given) hull->vertices.push_back(p.cast<float>().cast<double>());
  double size = 0;
  for (const Vector &p : hull->vertices) size = std::max(size, p.norm());
  std::set<std::vector<uint32_t>> known;
  const size_t n = hull->vertices.size();
  for (size_t i = 0; i < n; ++i)
    for (size_t j = i + 1; j < n; ++j)
      for (size_t k = j + 1; k < n; ++k) {
        Hull::Face face;
        if (!supporting_face(hull->vertices, {i, j, k}, 1e-6 * size, face) || !known.insert(face.corners).second)
          continue;
        sort_corners(hull->vertices, face);
        hull->faces.push_back(face);
      }
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> left;
  for (uint32_t f = 0; f < hull->faces.size(); ++f) {
    const auto &corners = hull->faces[f].corners;
    for (size_t k = 0; k < corners.size(); ++k) left[{corners[k], corners[(k + 1) % corners.size()]}] = f;
  }
  for (const auto &[edge, face] : left)
    if (edge.first < edge.second && left.count({edge.second, edge.first}))
      hull->edges.push_back({edge.first, edge.second, face, left[{edge.second, edge.first}]});
  hull->face_starts = {0};
  for (const Hull::Face &face : hull->faces) {
    hull->corners.insert(hull->corners.end(), face.corners.begin(), face.corners.end());
    hull->face_starts.push_back(uint(hull->corners.size()));
    hull->planes.push_back({memory_real(face.normal.x()), memory_real(face.normal.y()), memory_real(face.normal.z()),
                            memory_real(face.distance)});
  }
  for (const Vector &p : hull->vertices)
    hull->rows.push_back({memory_real(p.x()), memory_real(p.y()), memory_real(p.z()), 0});
  for (const auto &edge : hull->edges) hull->edge_table.insert(hull->edge_table.end(), edge.begin(), edge.end());
  hull->headers = {
      0, uint(n),  0,       uint(hull->faces.size()), 0, uint(hull->edges.size()), 0, uint(hull->corners.size()), 0,
      0, map_side, map_side};
  std::vector<std::vector<uint32_t>> faces;
  for (const Hull::Face &face : hull->faces) faces.push_back(face.corners);
  ::tandem::append_chunks(hull->chunks, hull->rows, 3);
  ::tandem::append_chunks(hull->chunks, hull->planes, 4);
  ::tandem::append_links(hull->links, uint(n), faces, hull->edge_table);
  hull->chunks.push_back(::tandem::middle_of(std::span(hull->rows)));
  ::tandem::append_vertex_map(hull->links, std::span(hull->rows), map_side);
  ::tandem::append_face_map(hull->links, std::span(hull->planes), hull->chunks.back(), map_side);
  return hull;
}

/* Points of an ellipsoid, each of which is a vertex of their hull. */
inline std::shared_ptr<Hull> random_hull(Random &random, uint32_t vertices, const Vector &size)
{
  std::vector<Vector> points;
  for (uint32_t k = 0; k < vertices; ++k) points.push_back(random.direction().cwiseProduct(size));
  return make_hull(points);
}
inline std::shared_ptr<Hull> box_hull(const Vector &extent)
{
  std::vector<Vector> points;
  for (int k = 0; k < 8; ++k)
    points.push_back(Vector(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1).cwiseProduct(extent));
  return make_hull(points);
}

/* A shape as the kernels get it, and the same shape in double precision. */
struct Shape {
  uint_lanes kind = SHAPE_BOX;
  Eigen::Vector3f size{1, 1, 1};
  Eigen::Quaternionf orientation{1, 0, 0, 0};
  Eigen::Vector3f center{0, 0, 0}; /* seen from the centre of a */
  std::shared_ptr<Hull> hull;

  mat3 rotation() const
  {
    return rotation_of(quat_normalized(make_quat(orientation.x(), orientation.y(), orientation.z(), orientation.w())));
  }
  const Matrix &axes() const
  {
    if (kept_for_ == orientation.coeffs()) return kept_axes_;
    const mat3 m = rotation();
    kept_axes_ << m.x.x, m.x.y, m.x.z, m.y.x, m.y.y, m.y.z, m.z.x, m.z.y, m.z.z;
    kept_for_ = orientation.coeffs();
    return kept_axes_;
  }
  convex record() const
  {
    const vec3 zero = make_vec3(0, 0, 0);
    return convex_of(kind, make_vec3(size.x(), size.y(), size.z()), rotation(),
                     make_vec3(center.x(), center.y(), center.z()), zero, 0, hull ? hull->tables() : hull_tables{});
  }
  Vector middle() const { return center.cast<double>(); }
  Vector extent() const { return size.cast<double>(); }
  double radius() const
  {
    const double widest = std::max(extent().x(), extent().z());
    if (kind == SHAPE_SPHERE) return extent().x();
    return kind == SHAPE_CAPSULE || kind == SHAPE_CYLINDER ? extent().y() + widest : extent().norm();
  }
  double least() const
  {
    const double widest = std::max(extent().x(), extent().z());
    if (kind == SHAPE_SPHERE || kind == SHAPE_CAPSULE) return kind == SHAPE_SPHERE ? extent().x() : widest;
    return kind == SHAPE_CYLINDER ? std::min(widest, extent().y()) : extent().minCoeff();
  }
  /* The farthest point of the whole shape, including its radius. */
  Vector support(const Vector &direction) const
  {
    const Vector d = axes().transpose() * direction, e = extent();
    Vector p = Vector::Zero();
    const double across = std::hypot(d.x(), d.z());
    switch (kind) {
    case SHAPE_SPHERE: p = d.normalized() * e.x(); break;
    case SHAPE_BOX:
      p = Vector(d.x() < 0 ? -e.x() : e.x(), d.y() < 0 ? -e.y() : e.y(), d.z() < 0 ? -e.z() : e.z());
      break;
    case SHAPE_CAPSULE: {
      const Vector low = Vector(0, -e.y(), 0) + d.normalized() * e.x(),
                   high = Vector(0, e.y(), 0) + d.normalized() * e.z();
      p = d.dot(high) > d.dot(low) ? high : low;
      break;
    }
    case SHAPE_CYLINDER: {
      const Vector out = across > 0 ? Vector(d.x() / across, 0, d.z() / across) : Vector(1, 0, 0);
      const Vector low = out * e.x() - Vector(0, e.y(), 0), high = out * e.z() + Vector(0, e.y(), 0);
      p = d.dot(high) > d.dot(low) ? high : low;
      break;
    }
    default: {
      double best = -1e300;
      for (const Vector &v : hull->vertices)
        if (v.dot(d) > best) {
          best = v.dot(d);
          p = v;
        }
    }
    }
    return middle() + axes() * p;
  }

private:
  mutable Eigen::Vector4f kept_for_{0, 0, 0, 0};
  mutable Matrix kept_axes_;
};

/* A hull whose points are all vertices, with a random rotation. */
inline Shape random_hull_shape(Random &random, uint32_t vertices, const Vector &size)
{
  Shape shape;
  shape.kind = SHAPE_HULL;
  shape.hull = random_hull(random, vertices, size);
  shape.size = size.cast<float>();
  shape.orientation = random.orientation().cast<float>();
  return shape;
}

/* The gap of two shapes along a unit direction from a to b. */
inline double gap_between(const Shape &a, const Shape &b, const Vector &normal)
{
  return normal.dot(b.support(-normal)) - normal.dot(a.support(normal));
}

/* The signed distance from the hull of two balls, in the half plane through its axis; negative inside. size: as that of
 * a capsule. */
inline double distance_to_round_cone(Eigen::Vector2d p, const Vector &size)
{
  const double length = 2 * size.y(), low = size.x(), high = size.z();
  const double sine = length > 0 ? (low - high) / length : 2, cosine = std::sqrt(std::max(0.0, 1 - sine * sine));
  p.y() += size.y();
  const double to_low = p.norm() - low, to_high = (p - Eigen::Vector2d(0, length)).norm() - high;
  if (std::abs(sine) >= 1) return low > high ? to_low : to_high;
  const double along = p.dot(Eigen::Vector2d(-sine, cosine));
  if (along < 0) return to_low;
  return along > cosine * length ? to_high : p.dot(Eigen::Vector2d(cosine, sine)) - low;
}

/* Distance of a point from a shape, 0 inside; for hulls the largest height above a face. */
inline double outside_by(const Shape &shape, const Vector &point)
{
  const Vector p = shape.axes().transpose() * (point - shape.middle()), e = shape.extent();
  switch (shape.kind) {
  case SHAPE_SPHERE: return std::max(0.0, p.norm() - e.x());
  case SHAPE_BOX: return (p.cwiseAbs() - e).cwiseMax(0).norm();
  case SHAPE_CAPSULE: return std::max(0.0, distance_to_round_cone({std::hypot(p.x(), p.z()), p.y()}, e));
  case SHAPE_CYLINDER: {
    const Eigen::Vector2d q(std::hypot(p.x(), p.z()), p.y());
    const Eigen::Vector2d outline[4] = {{0, -e.y()}, {e.x(), -e.y()}, {e.z(), e.y()}, {0, e.y()}};
    double distance = 1e300, within = -1e300;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2d side = outline[k + 1] - outline[k];
      if (side.norm() == 0) continue;
      const double t = std::clamp(side.dot(q - outline[k]) / side.squaredNorm(), 0.0, 1.0);
      distance = std::min(distance, (q - outline[k] - t * side).norm());
      within = std::max(within, Eigen::Vector2d(side.y(), -side.x()).normalized().dot(q - outline[k]));
    }
    return within <= 0 ? 0 : distance;
  }
  default: {
    double worst = 0;
    for (const Hull::Face &face : shape.hull->faces) worst = std::max(worst, face.normal.dot(p) - face.distance);
    return worst;
  }
  }
}

struct Axis {
  Vector normal;
  double gap;
};

struct Polytope {
  std::vector<Vector> normals;
  std::vector<Vector> edges; /* directions, one of each */
};
inline Polytope polytope_of(const Shape &shape)
{
  Polytope p;
  const Matrix axes = shape.axes();
  if (shape.kind == SHAPE_BOX) {
    for (int k = 0; k < 3; ++k) {
      p.normals.push_back(axes.col(k).normalized());
      p.normals.push_back(-axes.col(k).normalized());
      p.edges.push_back(axes.col(k).normalized());
    }
  } else {
    for (const Hull::Face &face : shape.hull->faces) p.normals.push_back((axes * face.normal).normalized());
    for (const auto &edge : shape.hull->edges)
      p.edges.push_back((axes * (shape.hull->vertices[edge[1]] - shape.hull->vertices[edge[0]])).normalized());
  }
  return p;
}

/* The axis of the largest gap over all faces and pairs of edges: for overlapping polytopes minus the depth. */
inline Axis exhaustive_axis(const Shape &a, const Shape &b)
{
  Axis best{Vector::UnitY(), -1e300};
  const auto consider = [&](const Vector &normal) {
    const double gap = gap_between(a, b, normal);
    if (gap > best.gap) best = {normal, gap};
  };
  const Polytope pa = polytope_of(a), pb = polytope_of(b);
  for (const Vector &n : pa.normals) consider(n);
  for (const Vector &n : pb.normals) consider(-n);
  for (const Vector &e : pa.edges)
    for (const Vector &f : pb.edges) {
      const Vector n = e.cross(f);
      if (n.norm() < 1e-6) continue;
      consider(n.normalized());
      consider(-n.normalized());
    }
  return best;
}

/* The largest gap that a search over directions finds: many starts, each improved by ever smaller steps. */
inline Axis searched_axis(const Shape &a, const Shape &b, Random &random, const Vector &hint, int starts = 24)
{
  Axis best{hint, gap_between(a, b, hint)};
  for (int start = 0; start <= starts; ++start) {
    Axis here{start == 0 ? hint : random.direction(), 0};
    here.gap = gap_between(a, b, here.normal);
    for (double step = 0.5; step > 1e-6;) {
      bool better = false;
      const Vector u = here.normal.unitOrthogonal(), v = here.normal.cross(u);
      for (int k = 0; k < 8; ++k) {
        const double angle = k * M_PI / 4;
        const Vector n = (here.normal + step * (std::cos(angle) * u + std::sin(angle) * v)).normalized();
        const double gap = gap_between(a, b, n);
        if (gap > here.gap) {
          here = {n, gap};
          better = true;
        }
      }
      if (!better) step *= 0.5;
    }
    if (here.gap > best.gap) best = here;
  }
  return best;
}

inline Vector to_vector(vec3 v) { return {v.x, v.y, v.z}; }
inline Vector to_vector(vec4 v) { return {v.x, v.y, v.z}; }

/* Random shapes, with b placed at a gap from a along a direction. */
class ShapeMaker {
public:
  explicit ShapeMaker(uint64_t seed) : random(seed)
  {
    for (uint32_t k = 0; k < 40; ++k) hulls_.push_back(random_hull(random, 4 + k % 12, Vector(1, 0.7, 1.3)));
    hulls_.push_back(box_hull({1, 0.5, 0.8}));
  }
  Shape make(uint_lanes kind, double low, double high)
  {
    Shape shape;
    shape.kind = kind;
    for (int k = 0; k < 3; ++k) shape.size[k] = float(random.logarithmic(low, high));
    const bool round = kind == SHAPE_CAPSULE || kind == SHAPE_CYLINDER;
    if (round && random.below(3)) shape.size.z() = shape.size.x();
    if (kind == SHAPE_CYLINDER && random.below(8) == 0) shape.size[random.below(2) ? 0 : 2] = 0;
    if (kind == SHAPE_SPHERE) shape.size.y() = shape.size.z() = shape.size.x();
    shape.orientation = random.orientation().cast<float>();
    if (kind == SHAPE_HULL) {
      shape.hull = hulls_[random.below(uint32_t(hulls_.size()))];
      shape.size = Eigen::Vector3f(1, 1, 1.3f);
    }
    return shape;
  }
  Shape any(double low, double high) { return make(kinds[random.below(5)], low, high); }
  static void place(const Shape &a, Shape &b, const Vector &direction, double gap)
  {
    b.center = Eigen::Vector3f(0, 0, 0);
    b.center = (direction * (gap - gap_between(a, b, direction))).cast<float>();
  }

  static constexpr uint_lanes kinds[5] = {SHAPE_SPHERE, SHAPE_BOX, SHAPE_CAPSULE, SHAPE_CYLINDER, SHAPE_HULL};
  Random random;

private:
  std::vector<std::shared_ptr<Hull>> hulls_;
};

/* The result of a method for two shapes, in world axes. */
struct Found {
  Vector normal;
  double gap, distance; /* of the whole shapes; of the closest points, where the cores are apart */
  bool overlapping;
};
inline Found find(const Shape &a, const Shape &b, uint_lanes method)
{
  const convex record_a = a.record(), record_b = b.record();
  const convex_pair pair = pair_of(&record_a, &record_b);
  const double radii = double(core_radius(&record_a)) + double(core_radius(&record_b)), sense = pair.swapped ? -1 : 1;
  const gjk_result near = closest_points(&pair.a, &pair.b, R(1e30));
  const bool by_axes = method == CONVEX_AXES && near.overlapping && is_polytope(&pair.a) && is_polytope(&pair.b);
  const core_contact contact = by_axes ? separating_hull_axis(&pair.a, &pair.b, R(0.0), R(1e30)).contact
                                       : core_meeting_of(&pair, R(1e30), R(0.0), method, 0, core_contact{}).contact;
  const vec3 normal = rotate(pair.axes, contact.normal);
  const double distance = near.overlapping ? 0 : double(length_of(subtract(near.on_b, near.on_a))) - radii;
  return {sense * Vector(normal.x, normal.y, normal.z), double(contact.gap) - radii, distance, bool(near.overlapping)};
}

/* Errors in a list, for their maximum and a quantile. */
struct Errors {
  std::vector<double> values;
  size_t worst = 0;
  double largest = -1;
  void add(double error, size_t pair)
  {
    values.push_back(error);
    if (!(error <= largest)) {
      largest = error;
      worst = pair;
    }
  }
  void add(const Errors &other)
  {
    if (!(other.largest <= largest)) {
      largest = other.largest;
      worst = other.worst;
    }
    values.insert(values.end(), other.values.begin(), other.values.end());
  }
  double quantile(double share)
  {
    std::sort(values.begin(), values.end());
    return values[std::min(values.size() - 1, size_t(share * double(values.size())))];
  }
};

} // namespace tandem::convex_tests
