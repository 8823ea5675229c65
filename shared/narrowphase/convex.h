/* convex.h - a convex shape as the narrowphase uses it: a core given by its support map, and a radius around the core.
 *
 *      core, sharp            core + radius           A sphere's core is a point, a capsule's a segment along Y. Boxes,
 *      +---------+             .---------.            cylinders and hulls are their own core, with radius 0. The tests
 *      |    .    |            (  o-----o  )           work on the core and subtract the radius in the end, so a rounded
 *      +---------+             `---------'            shape costs no more than its core and keeps the full precision of
 *                                                     its distance.
 *
 * A pair is transformed into axes in which coordinates are most precise (pair_of): the axes of the larger shape, whose
 * faces are then exact, about the middle of the smaller one, so that the coordinates near the contact are small. The
 * support maps follow G. van den Bergen, "Collision Detection in Interactive 3D Environments", 2003.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_CONVEX_H
#define TANDEM_SHARED_NARROWPHASE_CONVEX_H

#include "shared/narrowphase/hull_support.h"
#include "shared/narrowphase/manifold.h"

/* size: of a sphere (radius, -, -); of a box its half extents; of a capsule or a cylinder along Y (bottom radius, half
 * height, top radius); of a hull the half extents of a box around it that is centred at the origin of its axes. */
typedef struct {
  uint_lanes kind;
  vec3 size;
  mat3 rotation; /* from the shape's axes to those it is seen in */
  vec3 center;   /* origin of the shape's axes */
  mask aligned;  /* the rotation is the identity */
  hull_ranges hull;
  uint triangle;      /* index of a mesh triangle; its first corner is the origin of the shape's axes */
  vec3 second, third; /* its other corners */
  hull_tables tables;
} convex;

SHARED mask is_hull(const convex *shape) { return MAY_OCCUR(HULL) && shape->kind == (uint)SHAPE_HULL; }
SHARED mask is_cylinder(const convex *shape) { return MAY_OCCUR(ROUND) && shape->kind == (uint)SHAPE_CYLINDER; }
SHARED mask is_capsule(const convex *shape) { return MAY_OCCUR(ROUND) && shape->kind == (uint)SHAPE_CAPSULE; }
SHARED mask is_triangle(const convex *shape) { return MAY_OCCUR(TREES) && shape->kind == (uint)SHAPE_TRIANGLE; }

/* offset: the body's centre seen from the centre of body a. middle: the shape's origin in the axes of its body; it is
 * not 0 where the centre of mass lies elsewhere. hull: its index, read only for SHAPE_HULL. */
SHARED convex convex_of(uint_lanes kind, vec3 size, mat3 rotation, vec3 offset, vec3 middle, uint_lanes hull,
                        hull_tables tables)
{
  convex shape;
  shape.kind = kind;
  shape.size = size;
  shape.rotation = rotation;
  shape.center = add(offset, rotate(rotation, middle));
  shape.aligned = 0;
  shape.tables = tables;
  hull_ranges none = {0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u};
  shape.hull = none;
  shape.triangle = INDEX_NONE;
  shape.second = shape.third = make_vec3(R(0.0), R(0.0), R(0.0));
  if (is_hull(&shape)) shape.hull = ranges_of_hull(&tables, hull);
  return shape;
}

SHARED vec3 mesh_vertex(hull_tables tables, uint triangle, uint corner)
{
  return xyz(load_float4(tables.mesh_vertices, tables.mesh_triangles[triangle * 6u + corner]));
}

/* A triangle of a mesh whose axes have their origin at `offset`. */
SHARED convex triangle_of(hull_tables tables, uint triangle, mat3 rotation, vec3 offset)
{
  vec3 first = mesh_vertex(tables, triangle, 0u), none = make_vec3(R(0.0), R(0.0), R(0.0));
  convex shape = convex_of((uint)SHAPE_TRIANGLE, none, rotation, offset, first, 0u, tables);
  shape.triangle = triangle;
  shape.second = subtract(mesh_vertex(tables, triangle, 1u), first);
  shape.third = subtract(mesh_vertex(tables, triangle, 2u), first);
  real longest = square_root(maximum(length_squared(shape.second), length_squared(shape.third)));
  shape.size = make_vec3(longest, longest, longest);
  return shape;
}

SHARED vec3 to_shape_axes(const convex *shape, vec3 v) { return shape->aligned ? v : rotate_back(shape->rotation, v); }
SHARED vec3 from_shape_axes(const convex *shape, vec3 v) { return shape->aligned ? v : rotate(shape->rotation, v); }
SHARED vec3 point_of_shape(const convex *shape, vec3 own) { return add(from_shape_axes(shape, own), shape->center); }

/* The radius around the core. */
SHARED real core_radius(const convex *shape)
{
  if (shape->kind == (uint)SHAPE_SPHERE) return shape->size.x;
  return is_capsule(shape) ? minimum(shape->size.x, shape->size.z) : R(0.0);
}

/* An upper bound of the distance from the origin of the shape's axes to its farthest point. */
SHARED real bounding_radius_of(const convex *shape)
{
  real widest = maximum(shape->size.x, shape->size.z);
  if (shape->kind == (uint)SHAPE_SPHERE || is_triangle(shape)) return shape->size.x;
  return is_capsule(shape) || is_cylinder(shape) ? shape->size.y + widest : length_of(shape->size);
}
SHARED real least_size(const convex *shape)
{
  real widest = maximum(shape->size.x, shape->size.z);
  if (shape->kind == (uint)SHAPE_SPHERE) return shape->size.x;
  if (is_capsule(shape)) return widest;
  if (is_cylinder(shape)) return minimum(widest, shape->size.y);
  return minimum(shape->size.x, minimum(shape->size.y, shape->size.z));
}

/* The unit direction of the horizontal part of v; x if v is vertical. */
SHARED vec3 around_axis(vec3 v)
{
  real across = square_root(v.x * v.x + v.z * v.z);
  if (across <= R(0.0)) return make_vec3(R(1.0), R(0.0), R(0.0));
  return make_vec3(v.x / across, R(0.0), v.z / across);
}

/* The support maps below take a unit direction in the shape's axes. Ties go to +x, +y, +z of a box, to the bottom of a
 * cylinder or capsule, to the lowest vertex of a hull, and to the first corner of a triangle. */
SHARED vec3 support_of_box(vec3 extent, vec3 direction)
{
  return make_vec3(extent.x * sign_of(direction.x), extent.y * sign_of(direction.y), extent.z * sign_of(direction.z));
}
SHARED vec3 support_of_cylinder(vec3 size, vec3 direction)
{
  vec3 outward = around_axis(direction);
  real across = outward.x * direction.x + outward.z * direction.z, up = direction.y * size.y;
  mask top = size.z * across + up > size.x * across - up;
  real radius = choose(top, size.z, size.x);
  return make_vec3(outward.x * radius, choose(top, size.y, -size.y), outward.z * radius);
}
/* The ends of a tapered capsule are spheres of two radii: the part of the larger radius beyond the smaller one belongs
 * to the core. */
SHARED vec3 support_of_capsule_core(vec3 size, vec3 direction)
{
  real least = minimum(size.x, size.z), up = direction.y * size.y;
  mask top = (size.z - least) + up > (size.x - least) - up;
  vec3 end = make_vec3(R(0.0), choose(top, size.y, -size.y), R(0.0));
  return add_scaled(end, direction, choose(top, size.z, size.x) - least);
}
SHARED uint_lanes support_vertex(const convex *shape, vec3 direction)
{
  return hull_support(&shape->tables, &shape->hull, direction, shape->size);
}
SHARED vec3 hull_vertex(const convex *shape, uint_lanes k)
{
  return xyz(load_float4(shape->tables.vertices, shape->hull.first_vertex + k));
}

SHARED vec3 support_of_triangle(const convex *shape, vec3 direction)
{
  real second = dot3(shape->second, direction), third = dot3(shape->third, direction);
  vec3 none = make_vec3(R(0.0), R(0.0), R(0.0));
  if (second > R(0.0) && second >= third) return shape->second;
  return third > R(0.0) ? shape->third : none;
}

/* The point of the core farthest in a unit direction. */
SHARED vec3 support_of(const convex *shape, vec3 direction)
{
  vec3 own = to_shape_axes(shape, direction), point = make_vec3(R(0.0), R(0.0), R(0.0));
  if (shape->kind == (uint)SHAPE_BOX) point = support_of_box(shape->size, own);
  else if (is_hull(shape)) point = hull_vertex(shape, support_vertex(shape, own));
  else if (is_cylinder(shape)) point = support_of_cylinder(shape->size, own);
  else if (is_capsule(shape)) point = support_of_capsule_core(shape->size, own);
  else if (is_triangle(shape)) point = support_of_triangle(shape, own);
  return point_of_shape(shape, point);
}

/* Two shapes in the axes of the larger one, about the centre of the smaller one. */
typedef struct {
  convex a, b;  /* a: the larger */
  mat3 axes;    /* from these axes to the world's */
  vec3 origin;  /* of these axes, seen from the centre of body a, world axes */
  vec3 up;      /* the direction in which shapes part that have no other: body b goes up in the world */
  mask swapped; /* a here is b of the caller */
} convex_pair;

SHARED convex_pair pair_of(const convex *a, const convex *b)
{
  convex_pair pair;
  pair.swapped = bounding_radius_of(b) > bounding_radius_of(a);
  pair.a = pair.swapped ? *b : *a;
  pair.b = pair.swapped ? *a : *b;
  pair.axes = pair.a.rotation;
  pair.origin = pair.b.center;
  pair.a.center = rotate_back(pair.axes, subtract(pair.a.center, pair.b.center));
  pair.a.aligned = 1;
  pair.b.rotation = relative_rotation(pair.axes, pair.b.rotation);
  pair.b.center = make_vec3(R(0.0), R(0.0), R(0.0));
  vec3 up = rotate_back(pair.axes, make_vec3(R(0.0), R(1.0), R(0.0)));
  pair.up = pair.swapped ? negate(up) : up;
  return pair;
}

/* The point of the Minkowski difference a - b farthest in a unit direction. Shapes overlap if and only if the
 * difference contains the origin. */
SHARED vec3 support_of_difference(const convex *a, const convex *b, vec3 direction)
{
  return subtract(support_of(a, direction), support_of(b, negate(direction)));
}

/* The gap between the cores along a unit normal from a to b; it is negative where they overlap. No normal shows a
 * larger gap than the distance of the cores, and none a smaller overlap than their penetration depth, so a slightly
 * wrong normal costs little. */
SHARED real gap_along(const convex *a, const convex *b, vec3 normal)
{
  return -dot3(support_of_difference(a, b, normal), normal);
}

/* The result of any of the tests between two cores. */
typedef struct {
  vec3 normal; /* unit, from a to b */
  real gap;    /* between the cores along it, negative where they overlap */
} core_contact;

#endif
