/* markup.h - escapes text for HTML and SVG; charts and pages use it. */
#pragma once

#include <string>

namespace tandem {

/* Escapes & < > " ' for text and attributes. */
std::string escaped(const std::string &text);

} // namespace tandem
