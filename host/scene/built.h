/* built.h - refuses scenes that need what the library was built without (cmake/Features.cmake). */
#pragma once

#include <string>

#include <tandem/features.h>
#include <tandem/scene.h>

namespace tandem {

struct Settings;

/* Throws InputError unless the library has kernels for these features, which the scene needs under these settings, or a
 * world of it has needed. The message names what is missing, the body that needs it, and the option that brings it. */
void check_built(Features needed, const Scene &scene, const Settings &settings, const std::string &where);

} // namespace tandem
