/* quickhull.cpp - see quickhull.h. All orders are fixed: of equally far points the first one given is taken, and faces
 * are visited in the order of their creation. */
#include "host/geometry/quickhull.h"

#include <algorithm>
#include <utility>

namespace tandem {
namespace {

__extension__ typedef __int128 Wide;

/* A point in units of hull_grid, at most 2^40 in size: differences take 41 bits, normals 83 and heights 126. */
using Place = std::array<int64_t, 3>;

Place place_of(const Vector &p)
{
  const auto whole = [](double x) { return static_cast<int64_t>(std::floor(x / hull_grid + 0.5)); };
  return {whole(p.x), whole(p.y), whole(p.z)};
}

struct Plane {
  Place base;
  Wide normal[3];

  Plane(const Place &a, const Place &b, const Place &c) : base(a)
  {
    for (size_t k = 0; k < 3; ++k) {
      const size_t i = (k + 1) % 3, j = (k + 2) % 3;
      normal[k] = Wide{b[i] - a[i]} * (c[j] - a[j]) - Wide{b[j] - a[j]} * (c[i] - a[i]);
    }
  }

  /* The signed distance from the plane times the length of the normal. */
  Wide height(const Place &p) const
  {
    return normal[0] * (p[0] - base[0]) + normal[1] * (p[1] - base[1]) + normal[2] * (p[2] - base[2]);
  }
  Vector vector() const
  {
    return {static_cast<double>(normal[0]), static_cast<double>(normal[1]), static_cast<double>(normal[2])};
  }
};

struct Face {
  std::array<uint32_t, 3> corners, neighbours; /* across the edges from each corner to the next */
  Plane plane;
  double normal_length;
  std::vector<uint32_t> above;
  bool removed = false;
};

class Quickhull {
public:
  Quickhull(const std::vector<Vector> &points, double within) : within_(within / hull_grid)
  {
    places_.reserve(points.size());
    for (const Vector &p : points) places_.push_back(place_of(p));
    starting_at_.resize(places_.size());
  }

  std::vector<Polygon> run()
  {
    if (!start()) return {};
    for (uint32_t face = 0; face < faces_.size(); ++face)
      if (!faces_[face].removed && !faces_[face].above.empty()) raise(face, farthest_above(faces_[face]));
    std::vector<Polygon> triangles;
    for (const Face &face : faces_)
      if (!face.removed) triangles.emplace_back(face.corners.begin(), face.corners.end());
    return triangles;
  }

private:
  using Edge = std::array<uint32_t, 3>; /* from, to, the hidden face behind it */

  template <class Measure> uint32_t largest(const Measure &measure) const
  {
    uint32_t best = 0;
    auto most = measure(places_[0]);
    for (uint32_t i = 1; i < places_.size(); ++i)
      if (const auto here = measure(places_[i]); here > most) {
        most = here;
        best = i;
      }
    return best;
  }

  /* A tetrahedron of points far from each other. Only its first three are chosen by numbers that round. */
  bool start()
  {
    if (places_.size() < 4) return false;
    const auto away = [&](uint32_t from, const Place &p) {
      const Place &a = places_[from];
      return Vector(static_cast<double>(p[0] - a[0]), static_cast<double>(p[1] - a[1]),
                    static_cast<double>(p[2] - a[2]));
    };
    const uint32_t a = largest([](const Place &p) { return p; });
    const uint32_t b = largest([&](const Place &p) { return away(a, p).squared_norm(); });
    const Vector along = away(a, places_[b]);
    const uint32_t c = largest([&](const Place &p) { return along.cross(away(a, p)).squared_norm(); });
    const Plane plane(places_[a], places_[b], places_[c]);
    const uint32_t d = largest([&](const Place &p) { return std::max(plane.height(p), -plane.height(p)); });
    const Wide height = plane.height(places_[d]);
    if (height == 0) return false;
    add_tetrahedron(height > 0 ? std::array{a, c, b, d} : std::array{a, b, c, d});
    std::vector<uint32_t> all(places_.size());
    for (uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    share_out(all, 0);
    return true;
  }

  /* The first three vertices must be counter-clockwise seen from outside. */
  void add_tetrahedron(const std::array<uint32_t, 4> &v)
  {
    add_face({v[0], v[1], v[2]}, {1, 2, 3});
    add_face({v[1], v[0], v[3]}, {0, 3, 2});
    add_face({v[2], v[1], v[3]}, {0, 1, 3});
    add_face({v[0], v[2], v[3]}, {0, 2, 1});
  }

  uint32_t add_face(const std::array<uint32_t, 3> &corners, const std::array<uint32_t, 3> &neighbours)
  {
    const Plane plane(places_[corners[0]], places_[corners[1]], places_[corners[2]]);
    faces_.push_back({corners, neighbours, plane, plane.vector().norm(), {}});
    return static_cast<uint32_t>(faces_.size() - 1);
  }

  /* By more than `within`. The distance is rounded, but positive exactly if the point is above the plane. */
  bool is_above(const Face &face, uint32_t point) const
  {
    const Wide height = face.plane.height(places_[point]);
    return height > 0 && static_cast<double>(height) / face.normal_length > within_;
  }

  /* Assigns each point to the first face from `first` on that it is above. A point that is above no face is
   * discarded. */
  void share_out(const std::vector<uint32_t> &points, size_t first)
  {
    for (const uint32_t point : points)
      for (size_t face = first; face < faces_.size(); ++face)
        if (is_above(faces_[face], point)) {
          faces_[face].above.push_back(point);
          break;
        }
  }

  uint32_t farthest_above(const Face &face) const
  {
    return *std::max_element(face.above.begin(), face.above.end(), [&](uint32_t p, uint32_t q) {
      const Wide hp = face.plane.height(places_[p]), hq = face.plane.height(places_[q]);
      return hp != hq ? hp < hq : p > q;
    });
  }

  /* Removes the faces that are visible from the point, gathers their points, and returns the border of the visible
   * region. */
  std::vector<Edge> remove_seen(uint32_t first, uint32_t point, std::vector<uint32_t> &points)
  {
    std::vector<Edge> border;
    std::vector<uint32_t> waiting{first};
    faces_[first].removed = true;
    while (!waiting.empty()) {
      Face &face = faces_[waiting.back()];
      waiting.pop_back();
      points.insert(points.end(), face.above.begin(), face.above.end());
      face.above = {};
      for (size_t i = 0; i < 3; ++i) {
        Face &other = faces_[face.neighbours[i]];
        if (other.removed) continue; /* already removed; faces that were removed earlier have no neighbours left */
        if (other.plane.height(places_[point]) > 0) {
          other.removed = true;
          waiting.push_back(face.neighbours[i]);
        } else border.push_back({face.corners[i], face.corners[(i + 1) % 3], face.neighbours[i]});
      }
    }
    return border;
  }

  void set_neighbour(uint32_t face, uint32_t from, uint32_t neighbour)
  {
    for (size_t i = 0; i < 3; ++i)
      if (faces_[face].corners[i] == from) faces_[face].neighbours[i] = neighbour;
  }

  /* Makes the point a corner, with a cone of faces to the border of the region that is visible from it. */
  void raise(uint32_t seen, uint32_t point)
  {
    std::vector<uint32_t> points;
    const std::vector<Edge> border = remove_seen(seen, point, points);
    const size_t first = faces_.size();
    for (const auto &[from, to, hidden] : border) {
      starting_at_[from] = add_face({from, to, point}, {hidden, 0, 0});
      set_neighbour(hidden, to, starting_at_[from]);
    }
    for (size_t face = first; face < faces_.size(); ++face) {
      const uint32_t next = starting_at_[faces_[face].corners[1]];
      faces_[face].neighbours[1] = next;
      faces_[next].neighbours[2] = static_cast<uint32_t>(face);
    }
    std::erase(points, point);
    share_out(points, first);
  }

  double within_; /* in units of the grid */
  std::vector<Place> places_;
  std::vector<Face> faces_;
  std::vector<uint32_t> starting_at_; /* by corner of the last border: the new face of the edge that begins there */
};

} // namespace

Vector on_hull_grid(const Vector &point)
{
  const Place p = place_of(point);
  return Vector(static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])) * hull_grid;
}

std::vector<Polygon> hull_triangles(const std::vector<Vector> &points, double within)
{
  return Quickhull(points, within).run();
}

} // namespace tandem
