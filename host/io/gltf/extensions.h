/* extensions.h - which required extensions of a glTF file a simulation may pass over. Not a public header.
 *
 *   understood        the two of physics, KHR_mesh_quantization, KHR_animation_pointer
 *   judged by use     compressed and instanced meshes: refused where a collider reads one (mesh.h)
 *   without meaning   what is seen, heard, or said about the file
 *   all others        refused: nobody knows whether they would change the motion
 */
#pragma once

#include "host/io/json/reader.h"

namespace tandem {

/* InputError names the extension. */
void check_required_extensions(const JsonValue &root);

} // namespace tandem
