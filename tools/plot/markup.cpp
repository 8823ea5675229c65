/* markup.cpp - escapes the special characters of HTML and SVG; see markup.h. */
#include "tools/plot/markup.h"

#include <string_view>

namespace tandem {
namespace {

constexpr std::string_view replacement = "\xef\xbf\xbd"; /* U+FFFD */

bool is_control(char c) { return (static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n') || c == 0x7f; }

/* The bytes of the character that the text begins with, in UTF-8; 0 if there is none. Characters that are written
 * longer than they need and halves of pairs pass, as parsers of XML take bytes. */
size_t bytes_of_character(std::string_view text)
{
  const auto byte = [&](size_t k) { return static_cast<unsigned char>(text[k]); };
  const size_t bytes = byte(0) < 0x80   ? 1
                       : byte(0) < 0xc2 ? 0
                       : byte(0) < 0xe0 ? 2
                       : byte(0) < 0xf0 ? 3
                       : byte(0) < 0xf5 ? 4
                                        : 0;
  if (bytes > text.size()) return 0;
  for (size_t k = 1; k < bytes; ++k)
    if ((byte(k) & 0xc0) != 0x80) return 0;
  return bytes;
}

std::string escaped_character(std::string_view character)
{
  switch (character.front()) {
  case '&': return "&amp;";
  case '<': return "&lt;";
  case '>': return "&gt;";
  case '"': return "&quot;";
  case '\'': return "&#39;";
  default: return std::string(is_control(character.front()) ? replacement : character);
  }
}

} // namespace

/* XML holds no control characters and nothing that is not UTF-8, and names of files may. */
std::string escaped(const std::string &text)
{
  std::string result;
  for (std::string_view rest = text; !rest.empty();) {
    const size_t bytes = bytes_of_character(rest);
    result += bytes == 0 ? std::string(replacement) : escaped_character(rest.substr(0, bytes));
    rest.remove_prefix(bytes == 0 ? 1 : bytes);
  }
  return result;
}

} // namespace tandem
