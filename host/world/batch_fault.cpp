/* batch_fault.cpp - names the first two constraints that must not be in one batch; see batch_fault.h.
 *
 * The device only reports which constraint is the first at fault; the host searches for the one it conflicts with. */
#include "host/world/batch_fault.h"

#include <fmt/format.h>

#include "shared/records.h"

namespace tandem {
namespace {

class Finder {
public:
  Finder(Memory &memory, const std::array<uint32_t, COUNT_TOTAL> &counts, const std::vector<uint32_t> &order)
      : counts_(counts), order_(order), a_(memory.read<uint32_t>(Buffer::pair_a, counts[COUNT_PAIRS])),
        b_(memory.read<uint32_t>(Buffer::pair_b, counts[COUNT_PAIRS])),
        pair_of_(memory.read<uint32_t>(Buffer::constraint_pair, counts[COUNT_CONSTRAINTS])),
        flags_(memory.read<uint32_t>(Buffer::body_flags, counts[COUNT_BODIES]))
  {}

  BatchFault misbatched() const
  {
    BatchFault fault{};
    fault.pair = fault.other = bodies_of(counts_[COUNT_FIRST_MISBATCHED]);
    fault.constraints = counts_[COUNT_MISBATCHED];
    return fault;
  }

  BatchFault conflict() const
  {
    BatchFault fault{};
    const uint32_t first = counts_[COUNT_FIRST_CONFLICT], pair = pair_of_[first];
    fault.conflict = true;
    while (counts_[COLOR_START + fault.color + 1] <= first) ++fault.color;
    fault.pair = fault.other = bodies_of(pair);
    fault.constraints = counts_[COUNT_CONFLICTS];
    for (uint32_t i = first + 1; i < counts_[COLOR_START + fault.color + 1]; ++i)
      for (uint32_t body : {a_[pair], b_[pair]})
        if (moves(body) && (a_[pair_of_[i]] == body || b_[pair_of_[i]] == body)) {
          fault.body = order_[body];
          fault.other = bodies_of(pair_of_[i]);
          return fault;
        }
    return fault;
  }

private:
  bool moves(uint32_t body) const { return body_type_of(flags_[body]) == BODY_TYPE_DYNAMIC; }
  std::array<uint32_t, 2> bodies_of(uint32_t pair) const { return {order_[a_[pair]], order_[b_[pair]]}; }

  const std::array<uint32_t, COUNT_TOTAL> &counts_;
  const std::vector<uint32_t> &order_;
  std::vector<uint32_t> a_, b_, pair_of_, flags_;
};

} // namespace

std::optional<BatchFault> find_batch_fault(Memory &memory, const std::array<uint32_t, COUNT_TOTAL> &counts,
                                           const std::vector<uint32_t> &order, uint64_t step)
{
  if (counts[COUNT_CONFLICTS] == 0 && counts[COUNT_MISBATCHED] == 0) return {};
  const Finder finder(memory, counts, order);
  BatchFault fault = counts[COUNT_CONFLICTS] ? finder.conflict() : finder.misbatched();
  fault.step = step;
  return fault;
}

std::string describe(const BatchFault &fault)
{
  if (!fault.conflict)
    return fmt::format(
        "batches wrong in step {}: pair ({}, {}) does not stand in just as many batches as it should; {} such pairs",
        fault.step, fault.pair[0], fault.pair[1], fault.constraints);
  return fmt::format("batches wrong in step {}: colour {} touches body {} twice, in pairs ({}, {}) and ({}, {}); {} "
                     "constraints in conflict",
                     fault.step, fault.color, fault.body, fault.pair[0], fault.pair[1], fault.other[0], fault.other[1],
                     fault.constraints);
}

} // namespace tandem
