/* parameters.h - converts settings into the numbers that kernels read (shared/parameters.h). */
#pragma once

#include <tandem/scene.h>
#include <tandem/features.h>
#include <tandem/settings.h>

#include "shared/parameters.h"
#include "shared/platform.h"

namespace tandem {

/* median: Specialisation::median. */
Parameters parameters_of(const Scene &scene, const Settings &settings, Features features, float median);

} // namespace tandem
