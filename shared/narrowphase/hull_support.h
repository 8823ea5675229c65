/* hull_support.h - the tables of convex hulls, and three support maps of a hull.
 *
 *   SUPPORT_BRUTE_FORCE    tests all vertices, eight at once (float8.h): best up to some hundred vertices, no branches
 *   SUPPORT_HILL_CLIMBING  climbs from the vertex that a cube map names; for large hulls; finds the same vertex always
 *   SUPPORT_CUBE_MAP       takes the vertex that the map names: nearly the farthest, with the error in docs/pipeline.md
 *
 *      .---+---+---.     A cube map has cells on the six sides of a cube around the origin. Each cell names the vertex
 *      | 3 | 3 | 7 |     farthest in the direction of the cell's middle. (Talks on collision detection on GPUs: E.
 *      +---+---+---+     Coumans, 2012, 2013.)
 *      | 3 | 5 | 7 |     On a convex hull a vertex higher than all its neighbours is the highest. The neighbours here
 *      '---+---+---'     are the corners of all faces around a vertex, so that a face may be slightly uneven. Heights
 *                        within rounding of each other, as on a face or edge perpendicular to the direction, prove
 *                        nothing; all vertices are tested then.
 */
#ifndef TANDEM_SHARED_NARROWPHASE_HULL_SUPPORT_H
#define TANDEM_SHARED_NARROWPHASE_HULL_SUPPORT_H

#include "shared/argument_groups.h"
#include "shared/body_codes.h"
#include "shared/features.h"
#include "shared/float8.h"
#include "shared/math.h"

/* The tables hold all hulls and meshes of the scene, one behind the other. A hull's header: first vertex, vertices,
 * first face, faces, first edge, edges, first corner, corners, first row of chunks, first link, cells along a side of
 * the cube map of farthest vertices and of that of faces; 0 if the hull has no such map. */
#define HULL_HEADER 12u
typedef struct {
  GLOBAL const uint *headers;     /* HULL_HEADER a hull */
  GLOBAL const float4 *vertices;  /* x y z: about the origin of the shape's axes */
  GLOBAL const float4 *planes;    /* a face: outward unit normal, distance from the origin */
  GLOBAL const uint *face_starts; /* a face: its first corner; one more entry behind the last face of all */
  GLOBAL const uint *corners;     /* vertex of the hull, counter-clockwise seen from outside */
  GLOBAL const uint *edges;       /* 4 an edge: from, to, face to the left, face to the right, seen from outside */
  GLOBAL const float4
      *chunks;              /* a hull: chunks of x y z of its vertices, then of x y z distance of its planes (float8.h);
                               the middle of its vertices */
  GLOBAL const uint *links; /* a hull: its face_of_vertex starts, as many as vertices and one more; the faces of each
                               vertex, ascending; for each corner the edge to the next; the cube maps that it has: of
                               farthest vertices, and of faces seen from the middle (cube_field.h) */
  GLOBAL const float4 *mesh_vertices; /* x y z: about the origin of the mesh's axes */
  GLOBAL const uint *mesh_triangles;  /* 6 a triangle: its vertices, counter-clockwise seen from outside; its neighbours
                                        across 0-1, 1-2, 2-0 */
  uint support;                       /* SUPPORT_ */
} hull_tables;

/* support: SUPPORT_, the support map to use. */
SHARED hull_tables tables_of(read_surfaces surfaces, uint support)
{
  hull_tables tables = {surfaces.header,      surfaces.vertex,   surfaces.plane, surfaces.face_start,
                        surfaces.corner,      surfaces.edge,     surfaces.chunk, surfaces.link,
                        surfaces.mesh_vertex, surfaces.triangle, support};
  return tables;
}

typedef struct {
  uint first_vertex, vertices, first_face, faces, first_edge, edges, first_corner, corners, first_chunk, first_link,
      map_side, field_side;
} hull_ranges;

SHARED uint chunks_of(uint entries) { return (entries + CHUNK - 1u) / CHUNK; }

SHARED hull_ranges ranges_of_hull(const hull_tables *tables, uint hull)
{
  GLOBAL const uint *header = tables->headers + hull * HULL_HEADER;
  hull_ranges ranges = {header[0], header[1], header[2], header[3], header[4],  header[5],
                        header[6], header[7], header[8], header[9], header[10], header[11]};
  return ranges;
}

/* Ties go to the lowest vertex. */
SHARED uint_lanes highest_vertex(const hull_tables *tables, const hull_ranges *hull, vec3 direction)
{
  chunk_leader best;
  start_chunk_leader(&best);
  for (uint k = 0u; k < chunks_of(hull->vertices); ++k) {
    uint at = hull->first_chunk + k * 3u * FLOAT4S_OF_CHUNK;
    float8 x, y, z;
    load_float8(&x, tables->chunks, at);
    load_float8(&y, tables->chunks, at + FLOAT4S_OF_CHUNK);
    load_float8(&z, tables->chunks, at + 2u * FLOAT4S_OF_CHUNK);
    float8 height = x * direction.x + y * direction.y + z * direction.z;
    challenge_by_chunk(&best, &height, k * CHUNK);
  }
  return highest_of_chunk(&best).at;
}

/* The index of the cell, of `cells` along a side of the cube, that contains x; -1 <= x <= 1. */
SHARED uint cell_of_side(real x, uint cells)
{
  int cell = truncate_to_int((x + R(1.0)) * R(0.5) * to_real(cells));
  return cell < 0 ? 0u : (uint)cell < cells ? (uint)cell : cells - 1u;
}
/* A point on the cube. side: 0 1 for +x -x, 2 3 for +y -y, 4 5 for +z -z. u, v: -1 to 1 along the two axes after it in
 * cyclic order. */
typedef struct {
  uint side;
  real u, v;
} cube_place;

SHARED cube_place place_on_cube(vec3 direction)
{
  vec3 size = absolute(direction);
  mask x = size.x >= size.y && size.x >= size.z, y = !x && size.y >= size.z;
  real along = x ? direction.x : y ? direction.y : direction.z, most = x ? size.x : y ? size.y : size.z;
  real u = x ? direction.y : y ? direction.z : direction.x, v = x ? direction.z : y ? direction.x : direction.y;
  cube_place place = {(x ? 0u : y ? 2u : 4u) + (along < R(0.0) ? 1u : 0u), u / most, v / most};
  if (!(most > R(0.0))) place.side = 0u, place.u = place.v = R(0.0);
  return place;
}
/* Cells are stored row by row: along u first, then along v. */
SHARED uint cell_of_place(cube_place place, uint cells)
{
  return (place.side * cells + cell_of_side(place.v, cells)) * cells + cell_of_side(place.u, cells);
}
SHARED uint_lanes vertex_of_cube_map(const hull_tables *tables, const hull_ranges *hull, vec3 direction)
{
  return tables->links[hull->first_link + hull->vertices + 1u + 2u * hull->corners +
                       cell_of_place(place_on_cube(direction), hull->map_side)];
}

SHARED real height_of_vertex(const hull_tables *tables, const hull_ranges *hull, uint k, vec3 direction)
{
  return dot3(xyz(load_float4(tables->vertices, hull->first_vertex + k)), direction);
}

/* The highest of a vertex and the vertices that share a face with it. rival: another one is as high, to within
 * rounding. */
SHARED uint_lanes uphill(const hull_tables *tables, const hull_ranges *hull, uint from, vec3 direction, real rounding,
                         mask *rival)
{
  GLOBAL const uint *links = tables->links + hull->first_link;
  uint best = from;
  real highest = height_of_vertex(tables, hull, from, direction);
  *rival = 0;
  for (uint f = links[from]; f < links[from + 1u]; ++f) {
    GLOBAL const uint *start = tables->face_starts + hull->first_face + links[f];
    for (uint c = start[0]; c < start[1]; ++c) {
      uint k = tables->corners[c];
      real height = height_of_vertex(tables, hull, k, direction);
      if (k == best || height < highest - rounding) continue;
      *rival = height <= highest + rounding;
      if (height <= highest) continue;
      highest = height;
      best = k;
    }
  }
  return best;
}
SHARED uint_lanes climbed_vertex(const hull_tables *tables, const hull_ranges *hull, vec3 direction, vec3 size)
{
  real rounding = R(16.0) * ROUNDING * length_of(size);
  uint_lanes at = vertex_of_cube_map(tables, hull, direction);
  for (uint step = 0u; step < hull->vertices; ++step) {
    mask rival;
    uint_lanes next = uphill(tables, hull, at, direction, rounding, &rival);
    if (next == at && rival) break;
    if (next == at) return at;
    at = next;
  }
  return highest_vertex(tables, hull, direction);
}

/* size: half extents of a box around the hull that is centred at the origin of its axes. */
SHARED uint_lanes hull_support(const hull_tables *tables, const hull_ranges *hull, vec3 direction, vec3 size)
{
  if (MAY_OCCUR(HILL_CLIMBING) && tables->support == (uint)SUPPORT_HILL_CLIMBING)
    return climbed_vertex(tables, hull, direction, size);
  if (MAY_OCCUR(CUBE_MAP) && tables->support == (uint)SUPPORT_CUBE_MAP)
    return vertex_of_cube_map(tables, hull, direction);
  return highest_vertex(tables, hull, direction);
}

#endif
