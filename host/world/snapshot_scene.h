/* snapshot_scene.h - scenes and single shapes in the bytes of snapshots and recordings, exactly: a hull or mesh is
 * stored as it was made, since making it again from its vertices could give other bits.
 *
 * Shapes share hulls, meshes and compounds by pointers. Each of them is stored once, and those who shared it share it
 * again.
 */
#pragma once

#include <span>
#include <vector>

#include <tandem/scene.h>

#include "host/base/byte_stream.h"

namespace tandem {

void put_scene(ByteWriter &writer, const Scene &scene);
/* Throws InputError unless World could simulate the scene. */
Scene get_scene(ByteReader &reader);

void put_shape(ByteWriter &writer, const Shape &shape);
Shape get_shape(ByteReader &reader); /* indices within hulls and meshes are checked; validate() checks the rest */

void put_children(ByteWriter &writer, std::span<const Child> children);
std::vector<Child> get_children(ByteReader &reader);

} // namespace tandem
