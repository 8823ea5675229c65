/* choice.h - which broadphase suits a scene and the kind of backend that runs it: what Broadphase::automatic means, and
 * why. The bits are those of every other choice. */
#pragma once

#include <string>

#include <tandem/export.h>
#include <tandem/scene.h>
#include <tandem/settings.h>

namespace tandem {

struct BroadphaseChoice {
  Broadphase broadphase; /* not automatic */
  std::string why;       /* the statistics of the scene that led there, in one line */
};

/* backend: as in --on. */
TANDEM_API BroadphaseChoice choose_broadphase(const Scene &scene, const std::string &backend);

} // namespace tandem
