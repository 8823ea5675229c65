/* animation.h - which nodes animations move, and where they stand at their first keys.
 *
 * Bodies have velocities, but no key frames. What an animation moves is therefore taken where the animation begins, and
 * stands there (scene.h). This is not a public header.
 */
#pragma once

#include "host/io/gltf/document.h"

namespace tandem {

/* Records which nodes each animation moves; the first animation of a property counts. */
void read_gltf_animations(GltfDocument &document);

/* Puts the animated nodes that have physics, and those above, at their first keys. The keys of others, which are only
 * seen, are not read and may be missing. */
void stand_at_first_keys(GltfDocument &document);

} // namespace tandem
