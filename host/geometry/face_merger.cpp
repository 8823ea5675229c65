/* face_merger.cpp - visits the edges from the flattest on and joins the faces beside them; see face_merger.h. */
#include "host/geometry/face_merger.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <unordered_set>
#include <utility>

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

/* Appends all corners of the cycle but `start`, beginning with the next one. */
void append_after(Polygon &to, const Polygon &face, uint32_t start)
{
  const auto at = std::find(face.begin(), face.end(), start);
  to.insert(to.end(), at + 1, face.end());
  to.insert(to.end(), face.begin(), at);
}

class FaceMerger {
public:
  FaceMerger(const std::vector<Vector> &points, std::vector<Polygon> faces, double tolerance)
      : points_(points), faces_(std::move(faces)), part_of_(faces_.size()), joins_(faces_.size()), tolerance_(tolerance)
  {
    std::iota(part_of_.begin(), part_of_.end(), 0u);
  }

  std::vector<Polygon> merge()
  {
    std::vector<Candidate> candidates = flattest_first();
    for (bool changed = true; changed;) {
      auto kept = candidates.begin();
      for (Candidate &edge : candidates)
        if (!join(edge)) *kept++ = edge;
      changed = kept != candidates.end();
      candidates.erase(kept, candidates.end());
    }
    std::erase_if(faces_, [](const Polygon &face) { return face.empty(); });
    return std::move(faces_);
  }

private:
  /* An edge from v0 to v1, with the faces that had it at first. */
  struct Candidate {
    double bend; /* 1 - cosine between the normals */
    uint32_t v0, v1, left, right;
    uint64_t joins = no_try; /* of both faces when it was tried */
    bool operator<(const Candidate &o) const { return std::tie(bend, v0, v1) < std::tie(o.bend, o.v0, o.v1); }
  };
  static constexpr uint64_t no_try = UINT64_MAX;

  std::vector<Candidate> flattest_first() const
  {
    struct Side {
      uint32_t low, high;
      bool downward; /* a face has it from high to low */
      uint32_t face;
      auto operator<=>(const Side &) const = default;
    };
    std::vector<Vector> normals;
    std::vector<Side> sides;
    for (uint32_t face = 0; face < faces_.size(); ++face) {
      normals.push_back(newell_normal(points_, faces_[face]).normalized());
      for (size_t i = 0; i < faces_[face].size(); ++i) {
        const uint32_t v0 = faces_[face][i], v1 = faces_[face][(i + 1) % faces_[face].size()];
        sides.push_back({std::min(v0, v1), std::max(v0, v1), v0 > v1, face});
      }
    }
    std::sort(sides.begin(), sides.end());
    std::vector<Candidate> candidates;
    for (size_t side = 0; side + 1 < sides.size(); side += 2) {
      const uint32_t left = sides[side].face, right = sides[side + 1].face;
      candidates.push_back({1 - normals[left].dot(normals[right]), sides[side].low, sides[side].high, left, right});
    }
    std::sort(candidates.begin(), candidates.end());
    return candidates;
  }

  /* The face of which the given one is a part by now. */
  uint32_t present(uint32_t face)
  {
    while (part_of_[face] != face) face = part_of_[face] = part_of_[part_of_[face]];
    return face;
  }

  /* True if the edge was removed. Two faces that could not be joined still cannot while they are the same. */
  bool join(Candidate &edge)
  {
    const uint32_t left = present(edge.left), right = present(edge.right);
    const uint64_t joins = uint64_t{joins_[left]} + joins_[right];
    if (std::exchange(edge.joins, joins) == joins) return false;
    joined_.assign(1, edge.v1);
    append_after(joined_, faces_[left], edge.v1);
    append_after(joined_, faces_[right], edge.v0);
    joined_.pop_back(); /* v1 again */
    if (!acceptable(joined_)) return false;
    faces_[left].assign(joined_.begin(), joined_.end());
    faces_[right] = {};
    part_of_[right] = left;
    joins_[left] += joins_[right] + 1;
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
  std::vector<uint32_t> part_of_; /* by face: one that it was joined to, or itself */
  std::vector<uint32_t> joins_;   /* by face: how many it has come from */
  Polygon joined_;                /* the last one tried */
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
