/* placement.cpp - which stage or kernel runs on which backend, as a user writes it; see <tandem/backend.h>. */
#include <algorithm>

#include <fmt/format.h>

#include <tandem/backend.h>
#include <tandem/error.h>

#include "host/runtime/backend_list.h"
#include "host/runtime/interface/kernel_list.h"
#include "host/runtime/interface/module.h"

namespace tandem {
namespace {

bool is_stage(const std::string &name)
{
  for (size_t s = 0; s < all_stages(); ++s)
    if (name == name_of(static_cast<Stage>(s))) return true;
  return false;
}

std::string stage_list()
{
  std::string list;
  for (size_t s = 0; s < all_stages(); ++s) list += fmt::format("{}{}", s ? ", " : "", name_of(static_cast<Stage>(s)));
  return list;
}

} // namespace

void validate(const Placement &placement)
{
  for (const auto &[place, backend] : placement.exceptions)
    if (!is_stage(place) && !find_kernel(place))
      throw InputError(fmt::format("placement '{}={}': no stage or kernel '{}'; the stages are {}", place, backend,
                                   place, stage_list()));
  if (placement.automatic && (placement.allow_inexact || placement.on.starts_with("reference")))
    throw InputError(fmt::format("placement auto on {}: only backends that are exact can be chosen by their times, "
                                 "because results must not depend on them",
                                 placement.on));
  if (placement.automatic && placement.start == Start::on_cpu)
    throw InputError(
        fmt::format("placement auto on {}: it starts on the CPU by itself; leave the start out", placement.on));
  if (placement.start == Start::on_cpu && placement.allow_inexact)
    throw InputError(
        fmt::format("placement on {}: only on backends that are exact can a world start on the CPU, because "
                    "results must not depend on when the kernels of the device are built",
                    placement.on));
}

std::vector<std::pair<std::string, std::string>> parse_placement(const std::string &text)
{
  std::vector<std::pair<std::string, std::string>> exceptions;
  for (const std::string &part : split_backends(text)) {
    const size_t equals = part.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == part.size())
      throw InputError(fmt::format("placement '{}' is not STAGE=BACKEND", part));
    const std::string place = part.substr(0, equals);
    if (std::any_of(exceptions.begin(), exceptions.end(), [&](const auto &given) { return given.first == place; }))
      throw InputError(fmt::format("placement '{}': {} is given twice", text, place));
    exceptions.emplace_back(place, part.substr(equals + 1));
  }
  validate({.exceptions = exceptions});
  return exceptions;
}

} // namespace tandem
