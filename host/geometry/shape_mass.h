/* shape_mass.h - from a shape of a scene to the mass properties of its body.
 *
 * A body's frame has its origin at the centre of mass and its axes along the principal axes of inertia, so that the
 * tensor is three numbers and the equations of motion take their simplest form. A shape has a frame of its own (the one
 * in which its sizes or vertices are given), and the two frames differ for tapered and for irregular shapes:
 *
 *        y ^        world ---- position, orientation ----> body ---- shape_position, shape_orientation ----> shape
 *         /|\
 *        / | \      A cone of height 2h: its frame lies half way up, its centre of mass a quarter up, so
 *       /  +  \     position + (0, h/2, 0) is the shape's origin.
 *      /___x___\    + origin of the shape, x centre of mass
 *
 * inertia_of and take_mass_properties of host/include/tandem/scene.h are defined here.
 */
#pragma once

#include <tandem/export.h>

#include "host/geometry/mass_properties.h"

namespace tandem {

/* The mass properties of a solid of density 1 in the shape's own frame. Half-spaces have no mass and are not allowed.
 * Throws InputError for a mesh without volume. */
TANDEM_API MassProperties mass_properties_of(const Shape &shape);

/* False for half-spaces, and for meshes that are flat or inside out. */
TANDEM_API bool has_volume(const Shape &shape);

/* The frame that take_mass_properties gives a body, relative to that of its shape, and the moments about its axes for
 * density 1. If it differs from the shape's own frame only by rounding, it is the shape's own. */
struct PrincipalFrame {
  double mass = 0;
  Double3 center{};
  Rotation rotation{0, 0, 0, 1}; /* rotates the principal frame into the shape's axes */
  Double3 moments{};
};
PrincipalFrame principal_frame_of(const Shape &shape);

/* The pose of a body's shape in the world. */
struct ShapePlace {
  Double3 position{};
  Rotation orientation{0, 0, 0, 1};
};
ShapePlace place_of_shape(const Body &body);

/* The pose of a child of a body's compound in the frame of the body. */
ShapePlace place_of_child(const Body &body, const Child &child);

/* The points rotated about the origin, then translated. */
TANDEM_API std::vector<Vec3> placed_points(std::span<const Vec3> points, const Vec3 &position, const Quat &orientation);

/* Moves the body's frame and leaves the shape in its place in the world. */
TANDEM_API void move_frame(Body &body, const Double3 &position, const Rotation &orientation);

/* False if the moments of inertia_of about the body's axes are not those of the shape as it is placed in the body. */
bool has_principal_axes(const Body &body, const Shape &shape);

/* The rotation that applies b first, then a. */
TANDEM_API Rotation product(const Rotation &a, const Rotation &b);
TANDEM_API Double3 turned(const Rotation &rotation, const Double3 &v);

} // namespace tandem
