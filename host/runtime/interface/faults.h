/* faults.h - places where tests simulate failures that otherwise occur only on a full machine: of the n-th allocation,
 * build, launch or transfer.
 *
 * It follows the out-of-memory tests of SQLite. Each place calls strikes() before it does its work, and fails as if the
 * machine had refused; tests/host/runtime/interface/faults_test.cpp makes the places fail one by one. Without a hook
 * the cost is one load of a pointer.
 */
#pragma once

#include <atomic>
#include <cstdint>

namespace tandem::faults {

enum class Site : uint8_t { allocation, build, launch, transfer };

using Hook = bool (*)(Site);
inline std::atomic<Hook> hook{nullptr};

inline bool strikes(Site site)
{
  const Hook asked = hook.load(std::memory_order_relaxed);
  return asked && asked(site);
}

} // namespace tandem::faults
