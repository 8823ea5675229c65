/* sleepers.h - the islands that sleep: their bodies, and the cached contacts with which they will wake.
 *
 * The rows of sleeping bodies stay in the buffers, behind those of the bodies that are awake. Their cached pairs leave
 * the buffers, so that a step pays only for pairs of bodies that are awake, and are kept here: as words, those of each
 * carried buffer that has a row for each pair, one buffer after another.
 *
 * Bodies are named by their slot (host/world/body_slots.h), which does not change when bodies move in the buffers.
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <vector>

namespace tandem {

struct SleepingPair {
  uint32_t a, b; /* slots; a had the higher index in the buffers */
  std::vector<uint32_t> words;
};

struct SleepingIsland {
  std::vector<uint32_t> bodies; /* slots, in the order of their indices */
  std::vector<SleepingPair> pairs;
};

class Sleepers {
public:
  /* Islands are numbered in the order in which they fell asleep. */
  uint32_t add(SleepingIsland island);
  /* Removes an island and returns it. Pairs of it with another sleeping island become that one's. */
  SleepingIsland take(uint32_t island);

  bool empty() const { return islands_.empty(); }
  uint32_t count() const { return bodies_; }
  size_t islands() const { return islands_.size(); }
  const std::map<uint32_t, SleepingIsland> &all() const { return islands_; }
  bool sleeps(uint32_t slot) const { return island_of_.contains(slot); }
  uint32_t island_of(uint32_t slot) const { return island_of_.at(slot); }
  /* Other islands with a cached pair with this body, which may be awake, in ascending order. */
  std::vector<uint32_t> beside(uint32_t slot) const;
  /* The words of one buffer within those of a pair. */
  static constexpr size_t no_words = static_cast<size_t>(-1);
  struct Part {
    size_t first; /* among the present words; no_words: zeros */
    size_t words;
  };
  /* Puts single impulses into the rows that pairs of several points have, as impulse_rows (carried.h) does. Each is the
   * first of its words. */
  void join_impulses(size_t single, size_t rows);
  /* Gives all pairs these parts, one after another, in place of their words. */
  void rearrange(const std::vector<Part> &parts);
  uint64_t hash(uint64_t seed) const; /* the seed if nobody sleeps */

private:
  void note_partners(uint32_t number, const SleepingPair &pair);

  std::map<uint32_t, SleepingIsland> islands_;
  std::unordered_map<uint32_t, uint32_t> island_of_; /* by slot */
  /* Islands by the slot of a body outside of them; some have woken since. */
  std::unordered_map<uint32_t, std::vector<uint32_t>> partners_;
  uint32_t next_ = 0, bodies_ = 0;
};

} // namespace tandem
