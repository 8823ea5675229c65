/* extensions.h - which required extensions of a glTF file a simulation may ignore. This is not a public header.
 *
 *   understood        the two of physics, KHR_mesh_quantization, KHR_animation_pointer
 *   judged by use     compressed and instanced meshes: refused if a collider reads one (mesh.h)
 *   without meaning   what is seen or heard, and metadata of the file
 *   all others        refused, because they might change the motion
 */
#pragma once

#include "host/io/json/reader.h"

namespace tandem {

/* Throws InputError that names the extension. */
void check_required_extensions(const JsonValue &root);

} // namespace tandem
