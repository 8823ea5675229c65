/* mass_properties.h - mass, centre of mass and inertia tensor of solids, exact up to the rounding of double.
 *
 * Everything is for density 1, so that mass is volume; with_mass gives another. Solids of revolution stand along Y, as
 * in KHR_implicit_shapes: radius_top at +Y, height centred on the origin.
 *
 *        _---_  radius_top           The sides of a tapered capsule are the common tangent of its two spheres, so they
 *       /     \  - - - - - +         touch each at a circle that is not its equator. Where one sphere holds the other,
 *      /       \           | height  the capsule is the larger sphere.
 *     |         |          |
 *     |         | - - - - -+
 *      \       /  radius_bottom
 *       `--_--'
 *
 * Polyhedra are sums of signed tetrahedra (Tonon, Explicit exact formulas for the 3-D tetrahedron inertia tensor, 2004)
 * with their tips at the centre of the vertices, so that nothing cancels far from the origin.
 */
#pragma once

#include <tandem/export.h>

#include "host/geometry/convex_hull.h"
#include "host/geometry/triangle_mesh.h"

namespace tandem {

/* The matrix [xx xy xz; xy yy yz; xz yz zz]; xy is the entry of the matrix: minus the integral of x y dm. */
struct SymmetricMatrix {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
};

struct MassProperties {
  double mass = 0; /* m^3 at density 1 */
  Double3 center{};
  SymmetricMatrix inertia; /* about the centre of mass, along the axes of the shape */
};

/* Radii come bottom first. Lengths must be positive and finite (validation is the caller's); of two radii one may be
 * zero. */
MassProperties sphere_mass(double radius);
MassProperties box_mass(const Double3 &half_extents);
MassProperties cylinder_mass(double radius_bottom, double radius_top,
                             double height); /* a cone where one radius is zero */
MassProperties capsule_mass(double radius_bottom, double radius_top,
                            double height); /* height: between the centres of the spheres */

TANDEM_API MassProperties hull_mass(const ConvexHull &hull);

/* Throws InputError where the mesh has no volume (flat), or a negative one (inside out). A mesh with holes counts as
 * closed by cones from them to the centre of its vertices: volume_warning(mesh) says so to the user. */
MassProperties mesh_mass(const TriangleMesh &mesh, const std::string &where);

/* Of triangles of any closed surface; of an inside-out one, the mass is negative. */
TANDEM_API MassProperties polyhedron_mass(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

/* The same shape of another density. */
MassProperties with_mass(const MassProperties &shape, double mass);

/* The shape turned by the rotation x y z w (unit length) about its origin, then moved. */
MassProperties placed(const MassProperties &shape, const std::array<double, 4> &rotation, const Double3 &position);

/* All parts as one rigid body; where parts overlap, both count. */
MassProperties compound_mass(std::span<const MassProperties> parts);

/* Of all frames in which the tensor is diagonal, the one turned least from the shape's axes: moments that floats cannot
 * tell apart (principal_tolerance, relative to the largest) are taken for equal, and leave the frame free to turn about
 * their axis. */
struct PrincipalAxes {
  Double3 moments{};                          /* about the axes x y z of the principal frame */
  std::array<double, 4> rotation{0, 0, 0, 1}; /* x y z w, w >= 0: turns the principal frame into the shape's axes */
};
constexpr double principal_tolerance = 1e-6;
PrincipalAxes principal_axes(const SymmetricMatrix &inertia);

} // namespace tandem
