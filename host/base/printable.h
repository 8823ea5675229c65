/* printable.h - makes text from a file fit into one line of a message: names of bodies may hold line ends, zeros or
 * sequences that move a terminal's cursor. */
#pragma once

#include <string>

#include <fmt/format.h>

namespace tandem {

/* Escapes control characters as \
 * , \\x00 or \\u2028: Unicode's below the blank, delete, those from 80 to 9f, and the separators of lines and
 * paragraphs. */
inline std::string printable(const std::string &text)
{
  std::string result;
  for (size_t i = 0; i < text.size(); ++i) {
    const auto byte = [&](size_t k) { return i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0u; };
    if (byte(0) == '\n') result += "\\n";
    else if (byte(0) < 0x20 || byte(0) == 0x7f) result += fmt::format("\\x{:02x}", byte(0));
    else if (byte(0) == 0xc2 && byte(1) >= 0x80 && byte(1) < 0xa0) {
      result += fmt::format("\\x{:02x}", byte(1));
      ++i;
    } else if (byte(0) == 0xe2 && byte(1) == 0x80 && (byte(2) == 0xa8 || byte(2) == 0xa9)) {
      result += byte(2) == 0xa8 ? "\\u2028" : "\\u2029";
      i += 2;
    } else result += text[i];
  }
  return result;
}

} // namespace tandem
