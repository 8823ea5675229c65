/* markup.h - text that goes into HTML and SVG. */
#pragma once

#include <string>

namespace tandem {

/* & < > " ' written so that they stand for themselves, in text and in attributes. */
std::string escaped(const std::string &text);

} // namespace tandem
