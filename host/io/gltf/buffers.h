/* buffers.h - the numbers of glTF accessors. Buffers are read only when a body needs them, so that those which are
 * only rendered may be missing. This is not a public header. */
#pragma once

#include <tiny_gltf.h>

#include "host/io/gltf/document.h"

namespace tandem {

/* Elements of an accessor within its buffer. */
struct GltfElements {
  tinygltf::Accessor accessor;
  const char *bytes = nullptr;
  size_t count = 0, stride = 0;

  /* Integers of normalized accessors are converted to 0 … 1 or -1 … 1 (KHR_mesh_quantization). */
  double at(size_t element, size_t component = 0) const;
};

class GltfBuffers {
public:
  explicit GltfBuffers(const GltfDocument &document) : document_(document) {}
  GltfBuffers(const GltfBuffers &) = delete;

  /* Error messages begin with `asks`, such as a geometry of a collider; `what` is what the numbers are of. */
  GltfElements elements_of(uint32_t accessor, const JsonValue &asks, const char *what = "mesh");

private:
  const std::string &buffer(size_t index, const JsonValue &view, const JsonValue &asks);
  std::string read_buffer(const JsonValue &json, size_t index, const JsonValue &view) const;

  const GltfDocument &document_;
  std::map<size_t, std::string> buffers_;
};

/* An item of one of the document's lists; error messages about it begin with `where`, the place of the item that refers
 * to it. */
JsonValue gltf_item(const GltfDocument &document, const char *list, size_t index, const std::string &where);

} // namespace tandem
