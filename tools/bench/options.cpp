/* options.cpp - see options.h. */
#include "tools/bench/options.h"

namespace tandem {

std::vector<std::string> scenes_of_parts(const std::vector<std::string> &parts)
{
  std::vector<std::string> scenes;
  for (const std::string &part : parts) {
    const bool is_parameter = part.find('=') != part.npos && part.find(':') == part.npos;
    if (is_parameter && !scenes.empty()) scenes.back() += "," + part;
    else scenes.push_back(part);
  }
  return scenes;
}

} // namespace tandem
