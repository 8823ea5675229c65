/* version.h - the version of Tandem, for the preprocessor and at run time.
 *
 * A program that builds with version a.b.c builds with every later a.b.x, and a shared library of a.b.x serves it; the
 * file names and `find_package(Tandem a.b)` follow this rule. Another minor version may change the interface as long as
 * the major one is 0. Hashes of states may change with every version that is not a patch: they compare backends of one
 * version.
 */
#pragma once

#include <tandem/export.h>

#define TANDEM_VERSION_MAJOR 0
#define TANDEM_VERSION_MINOR 1
#define TANDEM_VERSION_PATCH 0

/* For comparisons: TANDEM_VERSION >= TANDEM_VERSION_NUMBER(0, 2, 0). */
#define TANDEM_VERSION_NUMBER(major, minor, patch) ((major)*1000000 + (minor)*1000 + (patch))
#define TANDEM_VERSION TANDEM_VERSION_NUMBER(TANDEM_VERSION_MAJOR, TANDEM_VERSION_MINOR, TANDEM_VERSION_PATCH)

namespace tandem {

/* The version of the library that is linked, such as "0.1.0"; it may be later than that of the headers. */
TANDEM_API const char *version();

} // namespace tandem
