/* mass_properties.h - mass, centre of mass and inertia tensor of solids, exact up to the rounding of double.
 *
 * Everything is for density 1, so that mass is volume; with_mass converts it to another mass. Solids of revolution
 * stand along Y, as in KHR_implicit_shapes: radius_top at +Y, height centred on the origin.
 *
 *        _---_  radius_top           The sides of a tapered capsule are the common tangent of its two spheres, so they
 *       /     \  - - - - - +         touch each at a circle that is not its equator. If one sphere contains the other,
 *      /       \           | height  the capsule is the larger sphere.
 *     |         |          |
 *     |         | - - - - -+
 *      \       /  radius_bottom
 *       `--_--'
 *
 * Polyhedra are sums of signed tetrahedra (Tonon, Explicit exact formulas for the 3-D tetrahedron inertia tensor, 2004)
 * with their apexes at the centre of the vertices, so that nothing cancels far from the origin.
 */
#pragma once

#include <tandem/export.h>

#include "host/geometry/convex_hull.h"
#include "host/geometry/triangle_mesh.h"

namespace tandem {

/* The matrix [xx xy xz; xy yy yz; xz yz zz]. xy is the entry of the matrix, which is minus the integral of x y dm. */
struct SymmetricMatrix {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
};

struct MassProperties {
  double mass = 0; /* m^3 at density 1 */
  Double3 center{};
  SymmetricMatrix inertia; /* about the centre of mass, along the axes of the shape */
};

/* Radii are given bottom first. Lengths are in metres and must be positive and finite (the caller validates them); of
 * two radii one may be zero. */
MassProperties sphere_mass(double radius);
MassProperties box_mass(const Double3 &half_extents);
MassProperties cylinder_mass(double radius_bottom, double radius_top,
                             double height); /* a cone where one radius is zero */
MassProperties capsule_mass(double radius_bottom, double radius_top,
                            double height); /* height: between the centres of the spheres */

TANDEM_API MassProperties hull_mass(const ConvexHull &hull);

/* Throws InputError if the mesh has no volume (flat) or a negative one (inside out). Holes are closed by cones to the
 * centre of the vertices; volume_warning(mesh) tells the user so. */
MassProperties mesh_mass(const TriangleMesh &mesh, const std::string &where);

/* The mass properties of any closed surface of triangles; the mass of an inside-out surface is negative. */
TANDEM_API MassProperties polyhedron_mass(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

/* The same shape with another mass. */
TANDEM_API MassProperties with_mass(const MassProperties &shape, double mass);

/* The shape rotated by x y z w (unit length) about its origin, then translated. */
TANDEM_API MassProperties placed(const MassProperties &shape, const std::array<double, 4> &rotation,
                                 const Double3 &position);

/* All parts as one rigid body; overlapping parts count twice. */
TANDEM_API MassProperties compound_mass(std::span<const MassProperties> parts);

/* The principal frame that is rotated least from the shape's axes. Moments that floats cannot distinguish
 * (principal_tolerance, relative to the largest) are treated as equal, which leaves the frame free to rotate about
 * their common axis. */
struct PrincipalAxes {
  Double3 moments{};                          /* about the axes x y z of the principal frame */
  std::array<double, 4> rotation{0, 0, 0, 1}; /* x y z w, w >= 0: rotates the principal frame into the shape's axes */
};
constexpr double principal_tolerance = 1e-6;
TANDEM_API PrincipalAxes principal_axes(const SymmetricMatrix &inertia);

} // namespace tandem
