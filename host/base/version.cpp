/* version.cpp - the version that the library was built as, for programs that load a shared library of another version
 * at run time. */
#include <tandem/version.h>

#define TEXT_OF(number) #number
#define VERSION_TEXT(major, minor, patch) TEXT_OF(major) "." TEXT_OF(minor) "." TEXT_OF(patch)

namespace tandem {

const char *version() { return VERSION_TEXT(TANDEM_VERSION_MAJOR, TANDEM_VERSION_MINOR, TANDEM_VERSION_PATCH); }

} // namespace tandem
