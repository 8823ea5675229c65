/* mesh.h - the vertices and triangles of a Wavefront OBJ file: objects and groups are one mesh, everything that is no
 * surface (normals, textures, materials, lines, points) is passed over.
 *
 * tinyobjloader cuts polygons into triangles, but takes any text for a number and drops faces that it cannot make; so
 * each line is read here, and it is given what was found to be right. */
#pragma once

#include "host/geometry/geometry.h"

namespace tandem {

struct ObjMesh {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

/* Throws InputError, one line with the file's name and the number of the line in it, for what is no OBJ file or names
 * vertices that it has not. Without faces it is a cloud of points, good for a hull. */
ObjMesh load_obj(const std::string &file);
ObjMesh parse_obj(const std::string &text, const std::string &where);

} // namespace tandem
