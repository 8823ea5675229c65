/* shapes.h - the shapes of a scene file: docs/scene-format.md. Not a public header. */
#pragma once

#include "host/io/input_file.h"
#include "host/io/json/reader.h"

namespace tandem {

/* {"type": "sphere", "radius": r} and so on. Files that a shape names are sought beside the scene file. */
Shape read_shape(const JsonValue &json, OutsideFiles outside);

/* The same shape again when read, to the bit. */
std::string written_shape(const Shape &shape);

} // namespace tandem
