/* faults.h - where tests let something fail that fails on a full machine alone: the n-th allocation, build, launch or
 * move of bytes.
 *
 * After the out-of-memory tests of SQLite. Each place asks strikes() before it does its work, and fails as if the
 * machine had refused; tests/host/runtime/interface/faults_test.cpp lets them fail one by one. Without a hook that is
 * one look at a pointer.
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
