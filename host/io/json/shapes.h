/* shapes.h - the shapes of a scene file: docs/scene-format.md. This is not a public header. */
#pragma once

#include "host/io/input_file.h"
#include "host/io/json/reader.h"

namespace tandem {

/* Reads {"type": "sphere", "radius": r} and so on. Files that a shape names are relative to the scene file. */
Shape read_shape(const JsonValue &json, OutsideFiles outside);

/* The text from which read_shape makes the same shape, to the bit. */
std::string written_shape(const Shape &shape);

} // namespace tandem
