/* element.h - elements of an XML file with their lines, so that every message of the readers of robots names its place.
 *
 * tinyxml2 parses; what it finds is copied into this tree, which readers may change: default classes add attributes,
 * and `replicate` repeats elements. Wrong numbers become one line such as
 *   arm.urdf: line 12: <joint name="elbow">: axis: "0 nan 1" has "nan", which is no finite number
 * This is not a public header.
 */
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tandem/scene.h>

#include "host/geometry/geometry.h"

namespace tandem {

class XmlElement {
public:
  std::string name;
  std::map<std::string, std::string> attributes;
  std::vector<XmlElement> children;
  std::shared_ptr<const std::string> file;
  int line = 0;

  std::string place() const; /* file: line 12: <joint name="elbow"> */
  [[noreturn]] void fail(const std::string &message) const;

  /* The only child of that name, or nullptr. Fails if there are several. */
  const XmlElement *child(const char *child_name) const;
  std::vector<const XmlElement *> children_named(const char *child_name) const;

  bool has(const char *key) const { return attributes.count(key) != 0; }
  std::optional<std::string> text(const char *key) const;
  std::string needed_text(const char *key) const; /* fails if it is absent or empty */

  /* Finite numbers of at most 10^18 in size, separated by blanks. Each fails for a wrong text or a wrong count;
   * `numbers` gives none if the attribute is absent. */
  std::vector<double> numbers(const char *key, size_t fewest, size_t most) const;
  std::optional<double> number(const char *key) const;
  double number_or(const char *key, double otherwise) const;
  double needed_number(const char *key) const;
  std::optional<Double3> vector(const char *key) const;
  Double3 vector_or(const char *key, const Double3 &otherwise) const;
  double at_least_zero_or(const char *key, double otherwise) const;
  bool boolean_or(const char *key, bool otherwise) const; /* true or false */
};

/* The root of a document. Throws InputError, one line with file and line, for malformed XML, for text that is not
 * UTF-8 or has a byte of 0, and for more levels than tinyxml2 follows (some hundred). */
XmlElement parse_xml(const std::string &text, const std::string &where);

} // namespace tandem
