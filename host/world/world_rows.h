/* world_rows.h - the rows that the buffers of a batch hold for one of its worlds, as they would be in buffers of that
 * world alone: bodies and cached pairs are numbered from 0. */
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "host/runtime/memory.h"
#include "host/world/carried.h"
#include "host/world/world_joints.h"

namespace tandem {

/* One carried buffer of a world. */
struct WorldRow {
  Buffer buffer;
  std::vector<std::byte> bytes;
};

/* Where a world lies. */
struct WorldPlace {
  uint32_t first, bodies; /* in the buffers */
  bool fresh;             /* reset since the last step: it has no cached pairs, whatever the cache holds */
  JointPlaces joints;
};

class WorldReader {
public:
  /* whole: many worlds will be read, so each buffer is read at once. */
  WorldReader(Memory &memory, const std::vector<CarriedBuffer> &carried, bool whole)
      : memory_(memory), carried_(carried), whole_(whole)
  {}
  /* The rows of one buffer in the order of the batch. items: of the buffer. */
  std::vector<std::byte> items(Buffer buffer, size_t first, size_t items);
  /* The rows of all carried buffers that the batch has; none of joints that the world alone has not. */
  std::vector<WorldRow> rows_of(const WorldPlace &place);

private:
  std::vector<uint32_t> starts_of(const WorldPlace &place);
  std::vector<std::byte> rows_of_joints(Buffer buffer, const JointPlaces &joints);
  std::vector<std::byte> row_of_world(Buffer buffer, const WorldPlace &place, std::span<const uint32_t> starts);

  Memory &memory_;
  const std::vector<CarriedBuffer> &carried_;
  bool whole_;
  std::map<Buffer, std::vector<std::byte>> read_;
};

} // namespace tandem
