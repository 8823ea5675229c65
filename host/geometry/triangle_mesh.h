/* triangle_mesh.h - a triangle mesh checked, welded, and with its adjacency: what internal-edge handling and masses
 * need.
 *
 * A body that slides over a mesh touches the edges between triangles, and a contact there must not point out of a
 * surface that is flat or concave (van den Bergen: Contact generation for meshes, GDC; Bullet's btInternalEdgeUtility).
 * So each edge says how the two triangles meet:
 *
 *      convex             flat                 concave           normals n0, n1:
 *         _/\_                                  \_  _/           cosine = n0 . n1
 *        /    \        _____|_____                \/
 *
 * Welded are vertices equal in every bit (zeros of either sign are equal). Left out, and counted: triangles named
 * twice, and those too thin or too small for floats to have a normal. What remains may be open, flat, or badly wound: a
 * static body can be so, a volume cannot.
 */
#pragma once

#include <tandem/export.h>

#include "host/geometry/geometry.h"

namespace tandem {

enum class EdgeKind : uint32_t {
  convex = 0,
  flat = 1, /* within flat_edge_sine */
  concave = 2,
  boundary = 3 /* one triangle; or no clear neighbour: more than two, or two that are wound against each other */
};

/* Below a thousandth of a radian a bend counts as flat: the normals of small triangles in floats are not better. */
constexpr double flat_edge_sine = 1e-3;
/* A triangle is degenerate if the sine of its widest angle is at most this: kernels cross the two sides there in
 * floats, and from this sine on the normal is right to about 3%. A long strip, however narrow, has a right angle; a
 * corner near the middle of the side beyond has none. */
constexpr double degenerate_sine = 4e-6;
/* A triangle with a smaller sine at its first corner, where kernels take the normal, begins with its widest angle
 * instead. */
constexpr double plain_sine = 1e-3;

constexpr uint32_t no_triangle = 0xffffffffu;

struct MeshEdge {
  uint32_t v0, v1;      /* v0 < v1 */
  uint32_t left, right; /* triangles; left has v0, v1 in this order, right the other. no_triangle: none */
  EdgeKind kind;
  double cosine; /* between the normals: 1 flat, 0 a right angle, -1 folded back; 1 at a boundary */
};

/* What was found in the triangles given; none of it is refused. */
struct MeshFindings {
  uint32_t welded_vertices = 0, unused_vertices = 0; /* left out */
  uint32_t degenerate_triangles = 0,
           duplicate_triangles = 0; /* left out; the first of equals stays. Opposite faces are no duplicates */
  uint32_t boundary_edges = 0;     /* of one triangle; degenerate triangles close gaps here, having no area but edges */
  uint32_t non_manifold_edges = 0; /* of more than two */
  uint32_t misoriented_edges = 0;  /* of two triangles, that both run along it the same way */
};

struct TriangleMesh {
  std::vector<Vec3> vertices; /* in the order of their first appearance */
  std::vector<Triangle> triangles;
  std::vector<std::array<uint32_t, 3>> neighbours; /* across the edges 0-1, 1-2, 2-0 of each triangle, or no_triangle */
  std::vector<std::array<uint32_t, 3>> triangle_edges; /* index into `edges`, in the same order */
  std::vector<MeshEdge> edges;                         /* sorted by v0, v1, left */
  MeshFindings findings;
  bool flat = false; /* all vertices within the rounding of floats of one plane */
};

/* Throws InputError for vertices that are not finite or beyond longest_length, used or not, indices out of range, and
 * no triangle left. */
TANDEM_API TriangleMesh triangle_mesh(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                                      const std::string &where);

/* The same from a plain list of indices, three a triangle; refuses a count that is no multiple of three. */
TANDEM_API TriangleMesh triangle_mesh(std::span<const Vec3> vertices, std::span<const uint32_t> indices,
                                      const std::string &where);

/* One line that says why the volume of the mesh is not to be trusted, or "". */
std::string volume_warning(const TriangleMesh &mesh);

/* One line about what was welded or left out, or "". */
std::string cleaning_note(const TriangleMesh &mesh);

/* The triangles turned round: needed after a mirroring scale (an odd number of negative factors). */
TANDEM_API std::vector<Triangle> turned_round(std::span<const Triangle> triangles);

/* One box a triangle, for a bvh. */
std::vector<AxisAlignedBox> triangle_bounds(const TriangleMesh &mesh);

} // namespace tandem
