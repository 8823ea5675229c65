/* geometry.h - triangle meshes of the shapes and a palette for host/io/glb/animation.cpp, and outlines for pictures. */
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <tandem/scene.h>

namespace tandem {

struct DisplayMesh {
  std::vector<Vec3> positions, normals; /* same count; a vertex is repeated for each of its normals */
  std::vector<uint32_t> indices;        /* three per triangle, counter-clockwise seen from outside */
};

/* Spheres, boxes and half-spaces share one scaled mesh for each type; other shapes have one mesh each. */
bool has_unit_mesh(ShapeType type);

/* A unit mesh has half extent or radius 1; that of the half space is a quad of half extent 1 in y = 0 that faces +Y.
 * The mesh of another shape is in the shape's own frame: round shapes with vertices on their surface, hulls with flat
 * faces. */
DisplayMesh display_mesh(const Shape &shape);

/* Points whose convex hull is the shape, approximately for round ones, in the shape's frame; none for a half-space. */
std::vector<Vec3> outline_points(const Shape &shape);

/* Linear RGB. The first is for bodies that never move, the second for kinematic ones. */
inline constexpr std::array<std::array<float, 3>, 8> palette{{{0.30f, 0.30f, 0.32f},
                                                              {0.05f, 0.05f, 0.06f},
                                                              {0.80f, 0.25f, 0.02f},
                                                              {0.02f, 0.35f, 0.70f},
                                                              {0.10f, 0.50f, 0.12f},
                                                              {0.75f, 0.55f, 0.03f},
                                                              {0.45f, 0.08f, 0.42f},
                                                              {0.60f, 0.58f, 0.52f}}};
inline constexpr uint32_t first_moving_color = 2;

} // namespace tandem
