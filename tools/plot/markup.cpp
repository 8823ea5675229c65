/* markup.cpp - escapes the special characters of HTML and SVG; see markup.h. */
#include "tools/plot/markup.h"

namespace tandem {

std::string escaped(const std::string &text)
{
  std::string result;
  for (const char c : text) switch (c) {
    case '&': result += "&amp;"; break;
    case '<': result += "&lt;"; break;
    case '>': result += "&gt;"; break;
    case '"': result += "&quot;"; break;
    case '\'': result += "&#39;"; break;
    default: result += c;
    }
  return result;
}

} // namespace tandem
