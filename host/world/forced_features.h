/* forced_features.h - a world that builds and runs features which its scene lacks, so that a benchmark can tell what is
 * saved by leaving them out. Its bits are those of the world without them. */
#pragma once

#include <memory>

#include <tandem/world.h>

namespace tandem {

/* The scene and the settings must be valid. A feature that others need must come with those. */
std::unique_ptr<World> world_with_features(const Scene &scene, const Settings &settings, const Placement &placement,
                                           Features forced);

} // namespace tandem
