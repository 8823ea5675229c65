/* face_merger.cpp - visits the edges from the flattest on and joins the faces beside them; see face_merger.h. */
#include "host/geometry/face_merger.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <unordered_map>
#include <unordered_set>

namespace tandem {
namespace {

uint64_t directed(uint32_t from, uint32_t to) { return uint64_t{from} << 32 | to; }

bool is_flat(const std::vector<Vector> &points, const Polygon &polygon, const Vector &normal, double tolerance)
{
  double lowest = INFINITY, highest = -INFINITY;
  for (uint32_t corner : polygon) {
    const double height = normal.dot(points[corner] - points[polygon[0]]);
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  return highest - lowest <= tolerance;
}

bool is_convex(const std::vector<Vector> &points, const Polygon &polygon, const Vector &normal, double tolerance)
{
  const size_t count = polygon.size();
  for (size_t i = 0; i < count; ++i) {
    const Vector &before = points[polygon[(i + count - 1) % count]], &at = points[polygon[i]],
                 &after = points[polygon[(i + 1) % count]];
    if ((at - before).cross(after - at).dot(normal) < -tolerance * (after - before).norm()) return false;
  }
  return true;
}

/* The same cycle of corners, beginning at `start`. */
Polygon started_at(const Polygon &face, uint32_t start)
{
  Polygon result = face;
  std::rotate(result.begin(), std::find(result.begin(), result.end(), start), result.end());
  return result;
}

class FaceMerger {
public:
  FaceMerger(const std::vector<Vector> &points, std::vector<Polygon> faces, double tolerance)
      : points_(points), faces_(std::move(faces)), tolerance_(tolerance)
  {
    for (uint32_t face = 0; face < faces_.size(); ++face) claim(face);
  }

  std::vector<Polygon> merge()
  {
    std::vector<Candidate> candidates = flattest_first();
    for (bool changed = true; changed;) {
      const auto kept =
          std::remove_if(candidates.begin(), candidates.end(), [this](const Candidate &c) { return join(c.v0, c.v1); });
      changed = kept != candidates.end();
      candidates.erase(kept, candidates.end());
    }
    std::erase_if(faces_, [](const Polygon &face) { return face.empty(); });
    return std::move(faces_);
  }

private:
  struct Candidate {
    double bend; /* 1 - cosine between the normals */
    uint32_t v0, v1;
    bool operator<(const Candidate &o) const { return std::tie(bend, v0, v1) < std::tie(o.bend, o.v0, o.v1); }
  };

  void claim(uint32_t face)
  {
    const Polygon &polygon = faces_[face];
    for (size_t i = 0; i < polygon.size(); ++i)
      face_left_of_[directed(polygon[i], polygon[(i + 1) % polygon.size()])] = face;
  }

  std::vector<Candidate> flattest_first() const
  {
    std::vector<Vector> normals;
    for (const Polygon &face : faces_) normals.push_back(newell_normal(points_, face).normalized());
    std::vector<Candidate> candidates;
    for (uint32_t face = 0; face < faces_.size(); ++face)
      for (size_t i = 0; i < faces_[face].size(); ++i) {
        const uint32_t v0 = faces_[face][i], v1 = faces_[face][(i + 1) % faces_[face].size()];
        if (v0 < v1) candidates.push_back({1 - normals[face].dot(normals[face_left_of_.at(directed(v1, v0))]), v0, v1});
      }
    std::sort(candidates.begin(), candidates.end());
    return candidates;
  }

  /* True if the edge was removed. */
  bool join(uint32_t v0, uint32_t v1)
  {
    const uint32_t left = face_left_of_.at(directed(v0, v1)), right = face_left_of_.at(directed(v1, v0));
    Polygon joined = started_at(faces_[left], v1);
    const Polygon other = started_at(faces_[right], v0);
    joined.insert(joined.end(), other.begin() + 1, other.end() - 1);
    if (!acceptable(joined)) return false;
    faces_[left] = std::move(joined);
    faces_[right].clear();
    claim(left);
    return true;
  }

  bool acceptable(const Polygon &polygon) const
  {
    const Vector normal = newell_normal(points_, polygon).normalized();
    if (!is_flat(points_, polygon, normal, tolerance_) || !is_convex(points_, polygon, normal, tolerance_))
      return false;
    return std::unordered_set<uint32_t>(polygon.begin(), polygon.end()).size() == polygon.size();
  }

  const std::vector<Vector> &points_;
  std::vector<Polygon> faces_;
  std::unordered_map<uint64_t, uint32_t> face_left_of_; /* never iterated over, because its order differs between
                                                           libraries */
  double tolerance_;
};

} // namespace

Vector newell_normal(const std::vector<Vector> &points, const Polygon &polygon)
{
  Vector sum;
  const Vector &base = points[polygon[0]];
  for (size_t i = 2; i < polygon.size(); ++i) sum += (points[polygon[i - 1]] - base).cross(points[polygon[i]] - base);
  return sum;
}

void start_at_smallest(Polygon &polygon)
{
  std::rotate(polygon.begin(), std::min_element(polygon.begin(), polygon.end()), polygon.end());
}

bool is_closed_surface(const std::vector<Polygon> &faces)
{
  std::unordered_set<uint64_t> sides;
  std::unordered_set<uint32_t> vertices;
  size_t corners = 0;
  for (const Polygon &face : faces) {
    if (face.size() < 3) return false;
    corners += face.size();
    vertices.insert(face.begin(), face.end());
    for (size_t i = 0; i < face.size(); ++i) sides.insert(directed(face[i], face[(i + 1) % face.size()]));
  }
  if (sides.size() != corners || corners % 2 != 0) return false;
  for (uint64_t side : sides)
    if (!sides.contains(side >> 32 | side << 32)) return false;
  return vertices.size() + faces.size() == corners / 2 + 2;
}

std::vector<Polygon> merged_faces(const std::vector<Vector> &points, std::vector<Polygon> faces, double tolerance)
{
  for (Polygon &face : faces) start_at_smallest(face);
  std::sort(faces.begin(), faces.end());
  return FaceMerger(points, std::move(faces), tolerance).merge();
}

} // namespace tandem
