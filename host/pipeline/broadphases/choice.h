/* choice.h - chooses the broadphase that suits a scene and the kind of backend that runs it: the meaning of
 * Broadphase::automatic. The choice changes no bit of a result. */
#pragma once

#include <string>

#include <tandem/export.h>
#include <tandem/scene.h>
#include <tandem/settings.h>

namespace tandem {

struct BroadphaseChoice {
  Broadphase broadphase; /* not automatic */
  std::string why;       /* the statistics of the scene that decided it, in one line */
};

/* backend: as in --on. */
TANDEM_API BroadphaseChoice choose_broadphase(const Scene &scene, const std::string &backend);

} // namespace tandem
