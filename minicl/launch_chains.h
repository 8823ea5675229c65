/* launch_chains.h - launches of which each item is one tree, run block by block of trees in place of one after another.
 *
 *   launch by launch    accelerate 0 .. 2047   contacts 0 .. 2047   rows 0 .. 2047   ..
 *   block by block      accelerate, contacts, rows 0 .. 31          accelerate, contacts, rows 32 .. 63   ..
 *
 * A kernel over articulations touches one tree an item, so launches of such kernels that follow each other need no
 * order among trees, and the bits are the same. The numbers of thousands of robots are more than the caches hold:
 * launch by launch, each kernel fetches all of them from memory again.
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/runtime/interface/backend.h"
#include "shared/articulations/joint_types.h"

namespace tandem::minicl {

/* As many as lie beside each other (host/scene/tree_places.h); with their contacts they take some half a megabyte. */
constexpr uint32_t trees_of_block = TREES_BESIDE;

/* Whether each item is one tree, and the kernel touches nothing that others of this kind touch for another tree. */
inline bool is_of_whole_trees(Kernel kernel)
{
  const KernelRow &row = row_of(kernel);
  return row.stage == Stage::articulations && row.items == COUNT_ARTICULATIONS && row.execution == Execution::lanes;
}

/* The launches of a series as chains: each is one launch, or several that may run block by block. */
class LaunchChains {
public:
  struct Chain {
    size_t first, last; /* launches of the series */
    size_t launches() const { return last - first; }
  };

  /* So that series of so many launches allocate nothing. */
  void reserve(size_t launches) { ends_.reserve(launches); }
  void find(std::span<const BoundLaunch> series)
  {
    ends_.clear();
    for (size_t k = 0; k < series.size(); ++k)
      if (k > 0 && follows_in_chain(series[k - 1].launch, series[k].launch)) ends_.back() = k + 1;
      else ends_.push_back(k + 1);
  }
  size_t count() const { return ends_.size(); }
  Chain at(size_t chain) const { return {chain == 0 ? 0 : ends_[chain - 1], ends_[chain]}; }

private:
  static bool follows_in_chain(const Launch &before, const Launch &next)
  {
    return is_of_whole_trees(before.kernel) && is_of_whole_trees(next.kernel) && before.first == next.first &&
           before.last == next.last;
  }

  std::vector<size_t> ends_;
};

/* Calls work(first, last) for each block of the trees. */
template <class Work> void for_each_block_of_trees(uint32_t first, uint32_t last, const Work &work)
{
  for (uint32_t end = first; first < last; first = end) {
    const uint32_t left = trees_of_block - first % trees_of_block;
    end = last - first < left ? last : first + left;
    work(first, end);
  }
}

} // namespace tandem::minicl
