/* motion.h - the motion of a glTF node: what moves a body, its mass, and where its centre and axes of
 * inertia lie.
 *
 * What the file leaves away is the shape's, of uniform density (the extension: "calculated by the simulation engine");
 * each of mass, centre of mass and moments may be given or not. A centre that is given moves no moments: they are about
 * the centre, wherever it is. Not a public header.
 */
#pragma once

#include "host/io/gltf/transform.h"

namespace tandem {

/* `world` is the transform of the node that has the motion. `body` has its shape, and stands with its frame in that
 * node's place. */
void read_gltf_motion(const JsonValue &motion, const Transform &world, const Scene &scene, Body &body);

} // namespace tandem
