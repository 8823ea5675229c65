/* mesh.h - the triangles of an STL file, binary or ASCII.
 *
 * Both forms repeat each vertex in every triangle; triangle_mesh welds them. Normals are not read, because the order of
 * the vertices says the same. This is not a public header.
 */
#pragma once

#include "host/io/obj/mesh.h"

namespace tandem {

/* Throws InputError, one line with the file's name, if the text is neither form, if the count of a binary file does not
 * fit its size, or if a number is not finite. */
ObjMesh parse_stl(const std::string &text, const std::string &where);

} // namespace tandem
