/* notes.h - what a file has and a scene has not: listed with a count, so that nothing is left out in silence.
 *
 * This is not a public header.
 */
#pragma once

#include <map>
#include <span>

#include "host/io/xml/element.h"

namespace tandem {

class XmlNotes {
public:
  void add(const XmlElement &element, const std::string &what) { add(element.line, what); }
  void add(int line, const std::string &what);
  /* Children and attributes of the element that are none of these. */
  void add_other_children(const XmlElement &element, std::span<const char *const> known);
  void add_other_attributes(const XmlElement &element, std::span<const char *const> known);
  /* A line each, `file: what`, in the order in which they were first met. */
  std::vector<std::string> lines(const std::string &where) const;

private:
  struct Entry {
    std::string what;
    size_t count;
    int first_line;
  };
  std::vector<Entry> entries_;
  std::map<std::string, size_t> numbers_;
};

} // namespace tandem
