/* shared_data.h - finds collections of scenes and problems by others, which are never part of the source. */
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/catch.h"

namespace tandem {

/* A folder of TANDEM_SHARED_DATA or ../shared/data; without it the test is skipped. */
inline std::filesystem::path shared_data(const std::string &name)
{
  const char *given = std::getenv("TANDEM_SHARED_DATA");
  const std::filesystem::path folder =
      std::filesystem::path(given ? given : TANDEM_SOURCE_DIR "/../shared/data") / name;
  if (!std::filesystem::is_directory(folder)) ::tests::skip("no data in " + folder.string());
  return folder;
}

} // namespace tandem
