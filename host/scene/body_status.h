/* body_status.h - whether a body of a scene takes part in the simulation. */
#pragma once

#include <cstdint>
#include <vector>

namespace tandem {

/* free: a slot without a body, because the one that it had was destroyed. */
enum class BodyStatus : uint8_t { present, quarantined, free };

/* status: by body of the scene; empty: all are present. */
inline BodyStatus status_of(const std::vector<BodyStatus> &status, uint32_t body)
{
  return status.empty() ? BodyStatus::present : status[body];
}

} // namespace tandem
