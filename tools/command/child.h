/* child.h - work in a child process, for what a process can do only once: a driver keeps what it has compiled. */
#pragma once

#include <functional>

#include "tools/command/output.h"

namespace tandem {

/* Runs `work` in a child and returns its answer. What it throws is thrown here: InputError as such, all else as
 * std::runtime_error, and so is the end of a child without an answer. The caller must have started no threads. */
Json answer_of_child(const std::function<Json()> &work);

} // namespace tandem
