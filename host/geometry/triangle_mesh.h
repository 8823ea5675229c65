/* triangle_mesh.h - a triangle mesh that is checked, welded and has its adjacency, which internal-edge handling and
 * mass properties need.
 *
 * A body that slides over a mesh touches the edges between triangles, and a contact there must not point out of a
 * surface that is flat or concave (van den Bergen: Contact generation for meshes, GDC; Bullet's btInternalEdgeUtility).
 * Each edge therefore records how the two triangles meet:
 *
 *      convex             flat                 concave           normals n0, n1:
 *         _/\_                                  \_  _/           cosine = n0 . n1
 *        /    \        _____|_____                \/
 *
 * Vertices that are equal in every bit (zeros of either sign are equal) are welded. Duplicate triangles, and triangles
 * too thin or too small for floats to have a normal, are left out and counted. The result may be open, flat, or badly
 * wound, which a static body may be, but a solid may not.
 */
#pragma once

#include <tandem/export.h>

#include "host/geometry/geometry.h"

namespace tandem {

enum class EdgeKind : uint32_t {
  convex = 0,
  flat = 1, /* within flat_edge_sine */
  concave = 2,
  boundary = 3 /* one triangle; or no unique neighbour: more than two triangles, or two of opposite winding */
};

/* A bend below a thousandth of a radian counts as flat, because the normals of small triangles in floats are no more
 * accurate. */
constexpr double flat_edge_sine = 1e-3;
/* A triangle is degenerate if the sine of its widest angle is at most this. Kernels compute the cross product of the
 * two sides there in floats, and above this sine the normal is accurate to about 3%. A long strip, however narrow, has
 * a right angle and is not degenerate; a triangle with a corner near the middle of the opposite side is. */
constexpr double degenerate_sine = 4e-6;
/* If the sine at a triangle's first corner, where kernels compute the normal, is smaller than this, the triangle is
 * rotated to begin with its widest angle. */
constexpr double plain_sine = 1e-3;

constexpr uint32_t no_triangle = 0xffffffffu;

struct MeshEdge {
  uint32_t v0, v1;      /* v0 < v1 */
  uint32_t left, right; /* triangles; left has v0, v1 in this order, right the reverse. no_triangle: none */
  EdgeKind kind;
  double cosine; /* between the normals: 1 flat, 0 a right angle, -1 folded back; 1 at a boundary */
};

/* What was found in the triangles given; none of it is an error. */
struct MeshFindings {
  uint32_t welded_vertices = 0, unused_vertices = 0; /* left out */
  uint32_t degenerate_triangles = 0,
           duplicate_triangles = 0; /* left out; the first of equal ones stays. Opposite faces are no duplicates */
  uint32_t boundary_edges = 0;     /* of one triangle; a degenerate triangle has edges too and closes gaps */
  uint32_t non_manifold_edges = 0; /* of more than two */
  uint32_t misoriented_edges = 0;  /* of two triangles that both run along it in the same direction */
};

struct TriangleMesh {
  std::vector<Vec3> vertices; /* in the order of their first appearance */
  std::vector<Triangle> triangles;
  std::vector<std::array<uint32_t, 3>> neighbours; /* across the edges 0-1, 1-2, 2-0 of each triangle, or no_triangle */
  std::vector<std::array<uint32_t, 3>> triangle_edges; /* index into `edges`, in the same order */
  std::vector<MeshEdge> edges;                         /* sorted by v0, v1, left */
  MeshFindings findings;
  bool flat = false; /* all vertices lie within the rounding of floats of one plane */
};

/* Throws InputError if a vertex, used or not, is not finite or beyond longest_length, an index is out of range, or no
 * triangle is left. */
TANDEM_API TriangleMesh triangle_mesh(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                                      const std::string &where);

/* The same from a plain list of indices, three a triangle. Throws InputError if their number is no multiple of
 * three. */
TANDEM_API TriangleMesh triangle_mesh(std::span<const Vec3> vertices, std::span<const uint32_t> indices,
                                      const std::string &where);

/* One line that says why the volume of the mesh is not reliable, or "". */
std::string volume_warning(const TriangleMesh &mesh);

/* One line about what was welded or left out, or "". */
std::string cleaning_note(const TriangleMesh &mesh);

/* The triangles with reversed winding, which is needed after a mirroring scale (an odd number of negative factors). */
TANDEM_API std::vector<Triangle> turned_round(std::span<const Triangle> triangles);

/* One box for each triangle, for a bvh. */
std::vector<AxisAlignedBox> triangle_bounds(const TriangleMesh &mesh);

} // namespace tandem
