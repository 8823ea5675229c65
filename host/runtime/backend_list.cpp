/* backend_list.cpp - splits lists of backends, recognising options by their names; see backend_list.h. */
#include "host/runtime/backend_list.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include <tandem/error.h>

namespace tandem {
namespace {

bool is_backend_option(std::string_view part)
{
  constexpr std::array<std::string_view, 3> names = {"threads", "lanes", "order"};
  const size_t equals = part.find('=');
  return equals != std::string_view::npos &&
         std::find(names.begin(), names.end(), part.substr(0, equals)) != names.end();
}

} // namespace

std::vector<std::string> split_backends(const std::string &text)
{
  std::vector<std::string> parts;
  for (size_t at = 0; at <= text.size();) {
    const size_t comma = std::min(text.find(',', at), text.size());
    const std::string part = text.substr(at, comma - at);
    if (part.empty()) throw InputError(fmt::format("'{}': nothing between two commas, or at an end of the list", text));
    if (!parts.empty() && is_backend_option(part)) parts.back() += "," + part;
    else parts.push_back(part);
    at = comma + 1;
  }
  return parts;
}

} // namespace tandem
