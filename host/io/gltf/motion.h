/* motion.h - the motion of a glTF node: velocities, mass, and the centre and axes of inertia.
 *
 * Mass, centre of mass and moments may each be given or not. What the file omits is that of the shape with uniform
 * density (the extension: "calculated by the simulation engine"). Given moments are about the centre of mass, and a
 * given centre does not change them. This is not a public header.
 */
#pragma once

#include "host/io/gltf/transform.h"

namespace tandem {

/* Who moves a body: physics, as the motion says, or something else of the file; then it is kinematic and stands. */
enum class GltfMover { physics, file };

/* `world` is the transform of the node that has the motion. `body` must have its shape, and its frame must be at that
 * node. */
void read_gltf_motion(const JsonValue &motion, const Transform &world, GltfMover mover, const Scene &scene, Body &body);

} // namespace tandem
