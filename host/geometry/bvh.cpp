/* bvh.cpp - builds the hierarchy in one pass over a stack of ranges; see bvh.h. A range of n primitives has 2 n - 1
 * nodes whatever their shape, so the skip of a node is known before its children are built. */
#include "host/geometry/bvh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include <tandem/round_to_float.h>

namespace tandem {
namespace {

constexpr uint32_t most_q = 65535;
constexpr size_t bins = 16;

void grow(AxisAlignedBox &bounds, const AxisAlignedBox &other)
{
  for (size_t axis = 0; axis < 3; ++axis) {
    bounds.lower[axis] = std::min(bounds.lower[axis], other.lower[axis]);
    bounds.upper[axis] = std::max(bounds.upper[axis], other.upper[axis]);
  }
}

double side(const AxisAlignedBox &box, size_t axis) { return double(box.upper[axis]) - box.lower[axis]; }

double half_area(const AxisAlignedBox &box)
{
  return side(box, 0) * side(box, 1) + side(box, 1) * side(box, 2) + side(box, 2) * side(box, 0);
}

double doubled_center(const AxisAlignedBox &box, size_t axis) { return double(box.lower[axis]) + box.upper[axis]; }

/* The least q in 0 .. most_q + 1 for which `reached` holds; it must hold for all larger q. */
template <class Reached> uint32_t first_q(const Reached &reached)
{
  uint32_t low = 0, high = most_q + 1;
  while (low < high) {
    const uint32_t middle = (low + high) / 2;
    if (reached(uint16_t(middle))) high = middle;
    else low = middle + 1;
  }
  return low;
}

/* The step is rounded up until the last q reaches the upper bound in the arithmetic of the kernels. */
Quantisation quantisation_of(const AxisAlignedBox &whole, const std::string &where)
{
  Quantisation result;
  for (size_t axis = 0; axis < 3; ++axis) {
    result.origin[axis] = whole.lower[axis];
    if (side(whole, axis) == 0) continue;
    result.step[axis] = std::max(round_to_float(side(whole, axis) / most_q), std::numeric_limits<float>::min());
    while (result.coordinate(axis, most_q) < whole.upper[axis])
      result.step[axis] = std::nextafter(result.step[axis], INFINITY);
    if (!std::isfinite(result.coordinate(axis, most_q)))
      throw InputError(fmt::format("{}: boxes from {} to {} are wider than floats can tell", where, whole.lower[axis],
                                   whole.upper[axis]));
  }
  return result;
}

void check(std::span<const AxisAlignedBox> boxes, const std::string &where)
{
  if (boxes.empty()) throw InputError(fmt::format("{}: a hierarchy needs at least one box", where));
  if (boxes.size() >= size_t{1} << 30)
    throw InputError(fmt::format("{}: {} boxes are more than a hierarchy can number (2^30)", where, boxes.size()));
  for (size_t i = 0; i < boxes.size(); ++i)
    for (size_t axis = 0; axis < 3; ++axis) {
      const float lower = boxes[i].lower[axis], upper = boxes[i].upper[axis];
      if (!(lower <= upper) || !std::isfinite(lower) || !std::isfinite(upper))
        throw InputError(
            fmt::format("{}: box {} runs from {} to {} along {}; finite numbers in ascending order are needed", where,
                        i, lower, upper, "xyz"[axis]));
    }
}

class HierarchyBuilder {
public:
  HierarchyBuilder(std::span<const AxisAlignedBox> boxes, const std::string &where)
      : boxes_(boxes), order_(boxes.size())
  {
    std::iota(order_.begin(), order_.end(), 0u);
    bvh_.quantisation = quantisation_of(bounds({0, boxes.size(), 0}), where);
    bvh_.nodes.reserve(2 * boxes.size() - 1);
  }

  Bvh build()
  {
    std::vector<Range> waiting{{0, boxes_.size(), 0}};
    while (!waiting.empty()) {
      const Range range = waiting.back();
      waiting.pop_back();
      bvh_.depth = std::max(bvh_.depth, range.depth);
      const QuantisedBounds box = quantised(bvh_.quantisation, bounds(range));
      if (range.count() == 1) {
        bvh_.nodes.push_back({box, int32_t(order_[range.begin])});
        continue;
      }
      bvh_.nodes.push_back({box, -int32_t(2 * range.count() - 1)});
      const size_t middle = split(range);
      waiting.push_back({middle, range.end, range.depth + 1});
      waiting.push_back({range.begin, middle, range.depth + 1});
    }
    collect_subtrees();
    return std::move(bvh_);
  }

private:
  struct Range {
    size_t begin, end;
    uint32_t depth;
    size_t count() const { return end - begin; }
  };

  struct Bin {
    AxisAlignedBox box;
    size_t count = 0;

    void add(const Bin &other)
    {
      if (other.count == 0) return;
      if (count == 0) box = other.box;
      else grow(box, other.box);
      count += other.count;
    }
    double cost() const { return count == 0 ? 0 : half_area(box) * double(count); }
  };

  /* The bins of the centres along one axis. */
  struct Binning {
    size_t axis;
    double lower, scale;

    size_t bin(const AxisAlignedBox &box) const
    {
      return std::min(bins - 1, size_t((doubled_center(box, axis) - lower) * scale));
    }
  };

  AxisAlignedBox bounds(const Range &range) const
  {
    AxisAlignedBox result = boxes_[order_[range.begin]];
    for (size_t i = range.begin + 1; i < range.end; ++i) grow(result, boxes_[order_[i]]);
    return result;
  }

  /* Bins along the axis on which the centres spread most. */
  Binning binning(const Range &range) const
  {
    Binning best{0, 0, 0};
    double widest = -1;
    for (size_t axis = 0; axis < 3; ++axis) {
      double lower = INFINITY, upper = -INFINITY;
      for (size_t i = range.begin; i < range.end; ++i) {
        lower = std::min(lower, doubled_center(boxes_[order_[i]], axis));
        upper = std::max(upper, doubled_center(boxes_[order_[i]], axis));
      }
      if (upper - lower > widest) {
        widest = upper - lower;
        best = {axis, lower, widest > 0 ? double(bins) / widest : 0};
      }
    }
    return best;
  }

  /* The first bin of the right side for which the sum of areas times counts is least; 0 if there is none, because all
   * centres are in one bin or have no area. */
  size_t best_bin(const Range &range, const Binning &binning) const
  {
    std::array<Bin, bins> content;
    for (size_t i = range.begin; i < range.end; ++i)
      content[binning.bin(boxes_[order_[i]])].add({boxes_[order_[i]], 1});
    std::array<double, bins> cost_from{};
    Bin sum;
    for (size_t i = bins; i-- > 1;) {
      sum.add(content[i]);
      cost_from[i] = sum.count == 0 ? INFINITY : sum.cost();
    }
    size_t best = 0;
    double least = INFINITY;
    sum = {};
    for (size_t i = 1; i < bins; ++i) {
      sum.add(content[i - 1]);
      if (sum.count == 0 || sum.cost() + cost_from[i] >= least) continue;
      least = sum.cost() + cost_from[i];
      best = i;
    }
    return least > 0 ? best : 0;
  }

  size_t split(const Range &range)
  {
    const Binning along = binning(range);
    const auto begin = order_.begin() + ptrdiff_t(range.begin), end = order_.begin() + ptrdiff_t(range.end);
    if (range.count() > 2 && along.scale > 0 && range.depth < depth_bound(boxes_.size()) / 2)
      if (const size_t best = best_bin(range, along))
        return size_t(std::stable_partition(begin, end, [&](uint32_t i) { return along.bin(boxes_[i]) < best; }) -
                      order_.begin());
    const auto middle = begin + ptrdiff_t(range.count() / 2);
    std::nth_element(begin, middle, end, [&](uint32_t i, uint32_t j) {
      const double a = doubled_center(boxes_[i], along.axis), b = doubled_center(boxes_[j], along.axis);
      return a < b || (a == b && i < j);
    });
    std::sort(begin, middle); /* the order that nth_element leaves differs between libraries */
    std::sort(middle, end);
    return size_t(middle - order_.begin());
  }

  void collect_subtrees()
  {
    for (size_t i = 0; i < bvh_.nodes.size();) {
      const uint32_t size = nodes_below(bvh_.nodes[i]);
      const bool fits = size <= most_subtree_nodes;
      if (fits) bvh_.subtrees.push_back({bvh_.nodes[i].bounds, uint32_t(i), size});
      i += fits ? size : 1;
    }
  }

  std::span<const AxisAlignedBox> boxes_;
  std::vector<uint32_t> order_;
  Bvh bvh_;
};

} // namespace

uint32_t depth_bound(size_t primitives) { return 2 * uint32_t(std::bit_width(primitives - 1)) + 8; }

Bvh build_bvh(std::span<const AxisAlignedBox> boxes, const std::string &where)
{
  check(boxes, where);
  return HierarchyBuilder(boxes, where).build();
}

QuantisedBounds quantised(const Quantisation &quantisation, const AxisAlignedBox &box)
{
  QuantisedBounds result;
  for (size_t axis = 0; axis < 3; ++axis) {
    const uint32_t above = first_q([&](uint16_t q) { return quantisation.coordinate(axis, q) > box.lower[axis]; });
    result.lower[axis] = uint16_t(above == 0 ? 0 : above - 1);
    result.upper[axis] = uint16_t(
        std::min(most_q, first_q([&](uint16_t q) { return quantisation.coordinate(axis, q) >= box.upper[axis]; })));
  }
  return result;
}

AxisAlignedBox dequantised(const Quantisation &quantisation, const QuantisedBounds &bounds)
{
  AxisAlignedBox result;
  for (size_t axis = 0; axis < 3; ++axis) {
    result.lower[axis] = quantisation.coordinate(axis, bounds.lower[axis]);
    result.upper[axis] = quantisation.coordinate(axis, bounds.upper[axis]);
  }
  return result;
}

} // namespace tandem
