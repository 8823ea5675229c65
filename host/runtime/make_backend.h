/* make_backend.h - creates backends from the texts that users give them (<tandem/backend.h>). */
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <tandem/export.h>

#include "host/runtime/interface/backend.h"

namespace tandem {

/* Throws InputError that lists what is available if the text names no backend. */
TANDEM_API std::unique_ptr<Backend> make_backend(const std::string &text, bool allow_inexact = false);

/* Threads of the CPU that a text of users names. */
struct NamedThreads {
  uint32_t count;
  std::string one; /* the text of a backend that has one of them */
};
/* Of tbb; of other backends, and of texts that name none, nothing. */
std::optional<NamedThreads> threads_named(const std::string &text);

} // namespace tandem
