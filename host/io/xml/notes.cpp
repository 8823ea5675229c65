/* notes.cpp - counts what could not be held; see notes.h. */
#include "host/io/xml/notes.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "host/base/printable.h"

namespace tandem {
namespace {

bool is_listed(const std::string &word, std::span<const char *const> list)
{
  return std::any_of(list.begin(), list.end(), [&](const char *known) { return word == known; });
}

} // namespace

void XmlNotes::add(int line, const std::string &what)
{
  const auto [at, is_new] = numbers_.emplace(what, entries_.size());
  if (is_new) entries_.push_back({what, 0, line});
  ++entries_[at->second].count;
}

void XmlNotes::add_other_children(const XmlElement &element, std::span<const char *const> known)
{
  for (const XmlElement &child : element.children)
    if (!is_listed(child.name, known)) add(child, fmt::format("<{}> of <{}> is not held", child.name, element.name));
}

void XmlNotes::add_other_attributes(const XmlElement &element, std::span<const char *const> known)
{
  for (const auto &[key, value] : element.attributes)
    if (!is_listed(key, known)) add(element, fmt::format("{} of <{}> is not held", key, element.name));
}

std::vector<std::string> XmlNotes::lines(const std::string &where) const
{
  std::vector<std::string> result;
  for (const Entry &entry : entries_) {
    const std::string count = entry.count == 1
                                  ? fmt::format("line {}", entry.first_line)
                                  : fmt::format("{} times, the first in line {}", entry.count, entry.first_line);
    result.push_back(printable(fmt::format("{}: {} ({})", where, entry.what, count)));
  }
  return result;
}

} // namespace tandem
