/* element.cpp - copies what tinyxml2 finds, and reads texts and numbers strictly; see element.h. */
#include "host/io/xml/element.h"

#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <tinyxml2.h>

#include "host/base/printable.h"

namespace tandem {
namespace {

constexpr double largest_number = 1e18; /* the farthest place of a body, m */

[[noreturn]] void refuse_xml(const std::string &where, int line, const std::string &why)
{
  throw InputError(fmt::format("{}: line {}: {}", printable(where), line, why));
}

/* The bytes that a character of UTF-8 has by its first one, and 0 for a byte that begins none. */
size_t length_by(unsigned char first)
{
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first < 0xe0) return 2;
  if (first >= 0xe0 && first < 0xf0) return 3;
  return first >= 0xf0 && first < 0xf5 ? 4 : 0;
}

/* Overlong forms, surrogates and numbers beyond Unicode are refused, as the writer of JSON would refuse them. */
bool is_character(const std::string &text, size_t at, size_t length)
{
  if (length == 0 || at + length > text.size()) return false;
  const auto byte = [&](size_t k) { return static_cast<unsigned char>(text[at + k]); };
  for (size_t k = 1; k < length; ++k)
    if (byte(k) < 0x80 || byte(k) >= 0xc0) return false;
  if (byte(0) == 0xe0) return byte(1) >= 0xa0;
  if (byte(0) == 0xed) return byte(1) < 0xa0;
  if (byte(0) == 0xf0) return byte(1) >= 0x90;
  return byte(0) != 0xf4 || byte(1) < 0x90;
}

/* Whether "&#" begins there what is no character of XML: no number, or 0, both of which would end a text early, or a
 * surrogate or a number beyond Unicode, of which no writer of JSON makes a text. */
bool is_wrong_reference(const std::string &text, size_t at)
{
  if (text.compare(at, 2, "&#") != 0) return false;
  const bool is_hexadecimal = text.compare(at, 3, "&#x") == 0;
  const char *first = text.data() + at + (is_hexadecimal ? 3 : 2);
  uint32_t code = 0;
  const auto [end, error] = std::from_chars(first, text.data() + text.size(), code, is_hexadecimal ? 16 : 10);
  return error != std::errc() || end == text.data() + text.size() || *end != ';' || code == 0 ||
         (code >= 0xd800 && code < 0xe000) || code > 0x10ffff;
}

void require_text(const std::string &text, const std::string &where)
{
  int line = 1;
  bool in_comment = false;
  for (size_t at = 0; at < text.size();) {
    if (text.compare(at, 4, "<!--") == 0) in_comment = true;
    if (text.compare(at, 3, "-->") == 0) in_comment = false;
    if (!in_comment && is_wrong_reference(text, at))
      refuse_xml(
          where, line,
          fmt::format("\"{}\" is no character", text.substr(at, std::min<size_t>(text.find(';', at) - at + 1, 20))));
    const size_t length = length_by(static_cast<unsigned char>(text[at]));
    if (text[at] == '\0') refuse_xml(where, line, "a byte of 0; XML is text");
    if (!is_character(text, at, length)) refuse_xml(where, line, "no UTF-8; write the file in that encoding");
    line += text[at] == '\n';
    at += length;
  }
}

std::string reason_of(const tinyxml2::XMLDocument &document)
{
  switch (document.ErrorID()) {
  case tinyxml2::XML_ERROR_EMPTY_DOCUMENT: return "no element; an XML file is needed";
  case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT: return "an element is not closed by its own end tag";
  case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED: return "elements within one another, more than some hundred deep";
  default: return fmt::format("malformed XML ({})", document.ErrorName());
  }
}

void copy(const tinyxml2::XMLElement &from, const std::shared_ptr<const std::string> &file, XmlElement &to)
{
  to.name = from.Name();
  to.file = file;
  to.line = from.GetLineNum();
  for (const tinyxml2::XMLAttribute *a = from.FirstAttribute(); a; a = a->Next())
    if (!to.attributes.emplace(a->Name(), a->Value()).second)
      to.fail(fmt::format("{} stands twice; one of them is needed", a->Name()));
  for (const auto *child = from.FirstChildElement(); child; child = child->NextSiblingElement())
    copy(*child, file, to.children.emplace_back());
}

} // namespace

std::string XmlElement::place() const
{
  const auto named = attributes.find("name");
  const std::string label = named == attributes.end() ? "" : fmt::format(" name=\"{}\"", named->second);
  return printable(fmt::format("{}: line {}: <{}{}>", *file, line, name, label));
}

void XmlElement::fail(const std::string &message) const
{
  throw InputError(fmt::format("{}: {}", place(), printable(message)));
}

const XmlElement *XmlElement::child(const char *child_name) const
{
  const std::vector<const XmlElement *> found = children_named(child_name);
  if (found.size() > 1) found[1]->fail(fmt::format("a second one in <{}>; at most one is needed", name));
  return found.empty() ? nullptr : found.front();
}

std::vector<const XmlElement *> XmlElement::children_named(const char *child_name) const
{
  std::vector<const XmlElement *> found;
  for (const XmlElement &child : children)
    if (child.name == child_name) found.push_back(&child);
  return found;
}

std::optional<std::string> XmlElement::text(const char *key) const
{
  const auto found = attributes.find(key);
  if (found == attributes.end()) return {};
  return found->second;
}

std::string XmlElement::needed_text(const char *key) const
{
  const std::optional<std::string> found = text(key);
  if (!found || found->empty()) fail(fmt::format("{} is missing; one is needed", key));
  return *found;
}

std::vector<double> XmlElement::numbers(const char *key, size_t fewest, size_t most) const
{
  const std::optional<std::string> found = text(key);
  if (!found) return {};
  constexpr const char *blanks = " \t\r\n";
  std::vector<double> result;
  for (size_t at = found->find_first_not_of(blanks); at != std::string::npos;) {
    const size_t end = std::min(found->find_first_of(blanks, at), found->size());
    const char *start = found->data() + at + ((*found)[at] == '+' && end - at > 1 && (*found)[at + 1] != '-');
    double value = 0;
    const auto [stop, error] = std::from_chars(start, found->data() + end, value);
    if (error != std::errc() || stop != found->data() + end || !std::isfinite(value))
      fail(fmt::format("{}: \"{}\" is no finite number", key, found->substr(at, std::min<size_t>(end - at, 40))));
    if (std::abs(value) > largest_number) fail(fmt::format("{}: {} is beyond 1e18 in size", key, value));
    result.push_back(value);
    at = found->find_first_not_of(blanks, end);
  }
  if (result.size() < fewest || result.size() > most)
    fail(fmt::format("{} has {} numbers; {} needed", key, result.size(),
                     fewest == most ? fmt::format("{} are", fewest) : fmt::format("{} to {} are", fewest, most)));
  return result;
}

std::optional<double> XmlElement::number(const char *key) const
{
  const std::vector<double> found = numbers(key, 1, 1);
  if (found.empty()) return {};
  return found.front();
}

double XmlElement::number_or(const char *key, double otherwise) const { return number(key).value_or(otherwise); }

double XmlElement::needed_number(const char *key) const
{
  needed_text(key);
  return *number(key);
}

std::optional<Double3> XmlElement::vector(const char *key) const
{
  const std::vector<double> found = numbers(key, 3, 3);
  if (found.empty()) return {};
  return Double3{found[0], found[1], found[2]};
}

Double3 XmlElement::vector_or(const char *key, const Double3 &otherwise) const
{
  return vector(key).value_or(otherwise);
}

double XmlElement::at_least_zero_or(const char *key, double otherwise) const
{
  const double value = number_or(key, otherwise);
  if (!(value >= 0)) fail(fmt::format("{} is {}; at least 0 is needed", key, value));
  return value;
}

bool XmlElement::boolean_or(const char *key, bool otherwise) const
{
  const std::optional<std::string> found = text(key);
  if (!found) return otherwise;
  if (*found != "true" && *found != "false") fail(fmt::format("{} is \"{}\"; true or false is needed", key, *found));
  return *found == "true";
}

XmlElement parse_xml(const std::string &text, const std::string &where)
{
  require_text(text, where);
  tinyxml2::XMLDocument document;
  document.Parse(text.data(), text.size());
  const tinyxml2::XMLElement *root = document.Error() ? nullptr : document.RootElement();
  if (document.Error()) refuse_xml(where, document.ErrorLineNum(), reason_of(document));
  if (!root) refuse_xml(where, 1, "no element; an XML file is needed");
  XmlElement result;
  copy(*root, std::make_shared<const std::string>(where), result);
  return result;
}

} // namespace tandem
