/* mesh.h - the vertices and triangles of a Wavefront OBJ file. Objects and groups become one mesh; normals, textures,
 * materials, lines and points are ignored.
 *
 * tinyobjloader triangulates polygons, but accepts any text as a number and drops faces that it cannot make. Each line
 * is therefore read here first, and tinyobjloader receives only what was found to be valid. */
#pragma once

#include "host/geometry/geometry.h"

namespace tandem {

struct ObjMesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

/* Throws InputError, one line with the file's name and the line number, if the file is not an OBJ file or names
 * vertices that it does not have. A file without faces is a point cloud, from which a hull can be made. */
ObjMesh load_obj(const std::string &file);
ObjMesh parse_obj(const std::string &text, const std::string &where);

} // namespace tandem
