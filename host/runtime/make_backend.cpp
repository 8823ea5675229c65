/* make_backend.cpp - parses the text of --on and creates the backend; see make_backend.h. */
#include "host/runtime/make_backend.h"

#include <algorithm>

#include <fmt/format.h>

#include <tandem/error.h>

#include "host/runtime/opencl/device.h"
#include "minicl/dispatcher.h"
#include "minicl/kernel_table.h"

namespace tandem {
namespace {

[[noreturn]] void refuse(const std::string &text, const std::string &why)
{
  throw InputError(fmt::format("backend '{}': {}; use serial, tbb[:threads=N,lanes=1|4|8|16], cl, cl:PLATFORM.DEVICE, "
                               "cl:PART-OF-A-NAME (`tandem devices` lists them) or reference[:threads=N]",
                               text, why));
}

std::vector<std::pair<std::string, std::string>> options_of(const std::string &text, size_t colon)
{
  std::vector<std::pair<std::string, std::string>> options;
  for (size_t at = colon + 1; colon != std::string::npos && at <= text.size();) {
    const size_t comma = std::min(text.find(',', at), text.size());
    const std::string item = text.substr(at, comma - at);
    const size_t equals = item.find('=');
    if (equals == std::string::npos) refuse(text, fmt::format("'{}' is not OPTION=VALUE", item));
    const std::string name = item.substr(0, equals);
    if (std::any_of(options.begin(), options.end(), [&](const auto &given) { return given.first == name; }))
      refuse(text, fmt::format("{} is given twice", name));
    options.emplace_back(name, item.substr(equals + 1));
    at = comma + 1;
  }
  return options;
}

uint32_t number_from(const std::string &text, const std::string &name, const std::string &value, uint32_t highest)
{
  if (value.empty() || value.size() > 4 || value.find_first_not_of("0123456789") != std::string::npos ||
      std::stoul(value) < 1 || std::stoul(value) > highest)
    refuse(text, fmt::format("{} '{}' is not a whole number from 1 to {}", name, value, highest));
  return static_cast<uint32_t>(std::stoul(value));
}

Backend::Order order_from(const std::string &text, const std::string &value)
{
  if (value == "forward") return Backend::Order::forward;
  if (value == "backward") return Backend::Order::backward;
  if (value == "shuffled") return Backend::Order::shuffled;
  refuse(text, fmt::format("order '{}' is not forward, backward or shuffled", value));
}

minicl::Options cpu_options_of(const std::string &text, const std::string &kind, size_t colon)
{
  minicl::Options options;
  options.reference = kind == "reference";
  if (kind != "tbb") options.lanes = 1;
  if (kind == "serial") options.threads = 1;
  for (const auto &[name, value] : options_of(text, colon)) {
    if (kind == "serial" && name == "order") options.order = order_from(text, value);
    else if (kind != "serial" && name == "threads") options.threads = number_from(text, name, value, 1024);
    else if (kind == "tbb" && name == "lanes") {
      options.lanes = number_from(text, name, value, 16);
      if (options.lanes != 1 && !minicl::lanes_table(options.lanes))
        refuse(text, fmt::format("lanes={} is not 1, 4, 8 or 16, or wider than this processor's {}", value,
                                 minicl::widest_lanes()));
    } else refuse(text, fmt::format("'{}' is not an option of {}", name, kind));
  }
  return options;
}

} // namespace

std::optional<NamedThreads> threads_named(const std::string &text)
{
  const size_t colon = text.find(':');
  if (text.substr(0, colon) != "tbb") return std::nullopt;
  try {
    const minicl::Options options = cpu_options_of(text, "tbb", colon);
    const std::string lanes = options.lanes ? fmt::format(",lanes={}", options.lanes) : "";
    return NamedThreads{options.threads ? options.threads : minicl::threads_of_machine(), "tbb:threads=1" + lanes};
  } catch (const InputError &) {
    return std::nullopt; /* make_backend says why */
  }
}

std::unique_ptr<Backend> make_backend(const std::string &text, bool allow_inexact)
{
  const size_t colon = text.find(':');
  const std::string kind = text.substr(0, colon);
  if (kind == "serial" || kind == "tbb" || kind == "reference")
    return minicl::make_backend(text, cpu_options_of(text, kind, colon));
  if (kind == "cl")
    return opencl::make_backend(text, colon == std::string::npos ? "" : text.substr(colon + 1), allow_inexact);
  refuse(text, "unknown");
}

} // namespace tandem
