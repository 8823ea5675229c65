/* world_rows.cpp - takes the rows of one world out of the buffers of a batch; see world_rows.h. */
#include "host/world/world_rows.h"

#include <cstring>

namespace tandem {
namespace {

std::vector<uint32_t> words_of(const std::vector<std::byte> &bytes)
{
  std::vector<uint32_t> words(bytes.size() / sizeof(uint32_t));
  if (!words.empty()) std::memcpy(words.data(), bytes.data(), bytes.size());
  return words;
}

/* Words that count from the place `first` in the batch, counted from 0. */
std::vector<std::byte> counted_from(uint32_t first, std::vector<uint32_t> words)
{
  for (uint32_t &word : words) word -= first;
  std::vector<std::byte> bytes(words.size() * sizeof(uint32_t));
  if (!words.empty()) std::memcpy(bytes.data(), words.data(), bytes.size());
  return bytes;
}

} // namespace

std::vector<std::byte> WorldReader::items(Buffer buffer, size_t first, size_t items)
{
  const size_t item = item_bytes(buffer);
  if (!whole_) return memory_.read<std::byte>(buffer, items * item, first * item);
  const auto [at, is_new] = read_.try_emplace(buffer);
  if (is_new) at->second = memory_.read<std::byte>(buffer, memory_.bytes(buffer));
  const auto begin = at->second.begin() + static_cast<ptrdiff_t>(first * item);
  return {begin, begin + static_cast<ptrdiff_t>(items * item)};
}

/* The first cached pair of each body of the world, and the end. */
std::vector<uint32_t> WorldReader::starts_of(const WorldPlace &place)
{
  if (place.fresh) return std::vector<uint32_t>(place.bodies + 1);
  return words_of(items(Buffer::cached_start, place.first, place.bodies + size_t{1}));
}

std::vector<std::byte> WorldReader::rows_of_joints(Buffer buffer, const JointPlaces &joints)
{
  std::vector<std::byte> rows;
  for_each_run(items_of_joints(buffer, joints), [&](size_t, size_t first, size_t count) {
    const std::vector<std::byte> run = items(buffer, first, count);
    rows.insert(rows.end(), run.begin(), run.end());
  });
  return rows;
}

std::vector<std::byte> WorldReader::row_of_world(Buffer buffer, const WorldPlace &place,
                                                 std::span<const uint32_t> starts)
{
  if (buffer == Buffer::cached_start) return counted_from(starts.front(), {starts.begin(), starts.end()});
  const size_t pairs = starts.back() - starts.front();
  if (buffer == Buffer::cached_b) return counted_from(place.first, words_of(items(buffer, starts.front(), pairs)));
  if (row_of(buffer).capacity == Capacity::PAIRS) return items(buffer, starts.front(), pairs);
  if (has_rows_in_joints(buffer)) return rows_of_joints(buffer, place.joints);
  return items(buffer, place.first, place.bodies);
}

std::vector<WorldRow> WorldReader::rows_of(const WorldPlace &place)
{
  const std::vector<uint32_t> starts = starts_of(place);
  std::vector<WorldRow> rows;
  for (const CarriedBuffer &carried : carried_) {
    if (memory_.bytes(carried.now) == 0) continue;
    WorldRow row{carried.now, row_of_world(carried.now, place, starts)};
    if (!has_rows_in_joints(carried.now) || !row.bytes.empty()) rows.push_back(std::move(row));
  }
  return rows;
}

} // namespace tandem
