/* call_checks.h - checks of the numbers that calls to bodies are given, before anything of a call is done. The message
 * names the call, the entry and what would be right. */
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include <tandem/world.h>

namespace tandem {

/* Throws InputError of one entry of a call. */
[[noreturn]] void refuse_entry(const char *call, size_t index, const std::string &why);

[[noreturn]] void refuse_axis(const char *call, size_t index, uint32_t axis); /* of a joint */

/* Throw InputError unless there is an entry for each of so many handles and all of its numbers can be used. */
void check_entries(const char *call, size_t ids, std::span<const BodyState> entries);
void check_entries(const char *call, size_t ids, std::span<const Velocity> entries);
void check_entries(const char *call, size_t ids, std::span<const Pose> entries);
void check_entries(const char *call, size_t ids, std::span<const Impulse> entries);
void check_entries(const char *call, size_t ids, std::span<const Force> entries);

} // namespace tandem
