/* sleepers.cpp - see sleepers.h. */
#include "host/world/sleepers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <iterator>
#include <utility>

#include "host/base/hash.h"

namespace tandem {

uint32_t Sleepers::add(SleepingIsland island)
{
  const uint32_t number = next_++;
  for (const uint32_t slot : island.bodies) island_of_[slot] = number;
  bodies_ += static_cast<uint32_t>(island.bodies.size());
  const auto at = islands_.emplace(number, std::move(island)).first;
  for (const SleepingPair &pair : at->second.pairs) note_partners(number, pair);
  return number;
}

/* An island that has several pairs with one body is mostly listed once, because its pairs are added one after another.
 * Islands that have woken are removed when they might be half of a list, so that lists do not grow for ever. */
void Sleepers::note_partners(uint32_t number, const SleepingPair &pair)
{
  for (const uint32_t slot : {pair.a, pair.b}) {
    const auto island = island_of_.find(slot);
    if (island != island_of_.end() && island->second == number) continue;
    std::vector<uint32_t> &islands = partners_[slot];
    if (!islands.empty() && islands.back() == number) continue;
    if (islands.size() == islands.capacity())
      std::erase_if(islands, [&](uint32_t island) { return !islands_.contains(island); });
    islands.push_back(number);
  }
}

SleepingIsland Sleepers::take(uint32_t number)
{
  const auto at = islands_.find(number);
  SleepingIsland island = std::move(at->second);
  islands_.erase(at);
  for (const uint32_t slot : island.bodies) island_of_.erase(slot);
  bodies_ -= static_cast<uint32_t>(island.bodies.size());
  const auto moves_on = [&](const SleepingPair &pair) { return sleeps(pair.a) || sleeps(pair.b); };
  const auto others = std::stable_partition(island.pairs.begin(), island.pairs.end(),
                                            [&](const SleepingPair &pair) { return !moves_on(pair); });
  for (auto pair = others; pair != island.pairs.end(); ++pair) {
    const uint32_t other = island_of(sleeps(pair->a) ? pair->a : pair->b);
    std::vector<SleepingPair> &pairs = islands_.at(other).pairs;
    pairs.push_back(std::move(*pair));
    note_partners(other, pairs.back());
  }
  island.pairs.erase(others, island.pairs.end());
  return island;
}

/* The lists hold islands that have woken since, which are passed over. A pair of two islands is in one of them alone,
 * which may be that of the body. */
std::vector<uint32_t> Sleepers::beside(uint32_t slot) const
{
  std::vector<uint32_t> found;
  if (const auto at = partners_.find(slot); at != partners_.end())
    std::copy_if(at->second.begin(), at->second.end(), std::back_inserter(found),
                 [&](uint32_t island) { return islands_.contains(island); });
  if (sleeps(slot))
    for (const SleepingPair &pair : islands_.at(island_of(slot)).pairs) {
      if (pair.a != slot && pair.b != slot) continue;
      const uint32_t other = pair.a == slot ? pair.b : pair.a;
      if (sleeps(other) && island_of(other) != island_of(slot)) found.push_back(island_of(other));
    }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

void Sleepers::rearrange(const std::vector<Part> &parts)
{
  for (auto &[number, island] : islands_)
    for (SleepingPair &pair : island.pairs) {
      std::vector<uint32_t> words;
      for (const Part &part : parts)
        if (part.first == no_words) words.insert(words.end(), part.words, 0u);
        else words.insert(words.end(), &pair.words[part.first], &pair.words[part.first] + part.words);
      pair.words = std::move(words);
    }
}

void Sleepers::join_impulses(size_t single, size_t rows)
{
  for (auto &[number, island] : islands_)
    for (SleepingPair &pair : island.pairs)
      if (std::bit_cast<float>(pair.words[single]) > 0) pair.words[rows] = pair.words[single];
}

uint64_t Sleepers::hash(uint64_t seed) const
{
  for (const auto &[number, island] : islands_) {
    seed = hash_bytes(island.bodies.data(), island.bodies.size() * sizeof(uint32_t), seed);
    for (const SleepingPair &pair : island.pairs) {
      const std::array<uint32_t, 2> both{pair.a, pair.b};
      seed = hash_bytes(both.data(), sizeof both, seed);
      seed = hash_bytes(pair.words.data(), pair.words.size() * sizeof(uint32_t), seed);
    }
  }
  return seed;
}

} // namespace tandem
