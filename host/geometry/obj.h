/* obj.h - the vertices and triangles of a Wavefront OBJ file, read by tinyobjloader, which cuts polygons into triangles:
 * objects and groups are one mesh, everything else (normals, textures, materials, lines) is passed over. */
#pragma once

#include "host/geometry/geometry.h"

namespace tandem {

struct ObjMesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

/* Throws InputError, one line with the file's name, where the file cannot be read or has no vertices. Without faces it is a cloud
 * of points, good for a hull. */
ObjMesh load_obj(const std::string &file);
ObjMesh parse_obj(const std::string &text, const std::string &where);

} // namespace tandem
