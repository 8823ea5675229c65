/* step_parts.h - how much of a buffer is in use where a launch of a step reads it on another backend.
 *
 * Buffers are sized by capacities, of which a small scene uses little. What moves is the part that the counts of the
 * step describe; the bytes behind it mean nothing, and no kernel reads them.
 */
#pragma once

#include <cstdint>
#include <optional>

#include "host/runtime/launcher.h"
#include "shared/counts.h"

namespace tandem {

class StepParts : public LaunchParts {
public:
  explicit StepParts(Memory &memory) : memory_(memory) {}
  /* bodies: those awake and those that sleep. cached_pairs: of the last step. */
  void begin_step(uint32_t bodies, uint32_t cached_pairs, Features features);
  void begin_launch(const Launch &launch) override;
  UsedPart part_of(Buffer buffer) override;

private:
  uint32_t pairs();

  Memory &memory_;
  uint32_t bodies_ = 0, cached_pairs_ = 0;
  Features features_ = 0;
  bool pairs_are_found_ = false;  /* the launch comes after those that list pairs */
  std::optional<uint32_t> pairs_; /* of the present launch, once it was asked */
};

/* The part of a buffer of so many bytes that items below `bodies` and `pairs` use; `pairs` is unknown before they are
 * found. All of it where neither tells. */
struct ItemsInUse {
  uint32_t bodies;
  std::optional<uint32_t> pairs;
  Features features; /* of the scene */
};
UsedPart part_in_use(Buffer buffer, size_t bytes, const ItemsInUse &items);

} // namespace tandem
