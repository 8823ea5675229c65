/* pareto.cpp - the front, by a sort and one pass; see pareto.h. */
#include "tools/report/pareto.h"

#include <algorithm>
#include <cmath>

namespace tandem {
namespace {

bool finite(const Tradeoff &point) { return std::isfinite(point.cost) && std::isfinite(point.error); }

std::vector<size_t> finite_by_cost(const std::vector<Tradeoff> &points)
{
  std::vector<size_t> order;
  for (size_t i = 0; i < points.size(); ++i)
    if (finite(points[i])) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return points[a].cost != points[b].cost ? points[a].cost < points[b].cost : points[a].error < points[b].error;
  });
  return order;
}

} // namespace

std::vector<size_t> pareto_front(const std::vector<Tradeoff> &points)
{
  std::vector<size_t> front;
  for (const size_t i : finite_by_cost(points))
    if (front.empty() || points[i].error < points[front.back()].error) front.push_back(i);
  return front;
}

std::optional<size_t> cheapest_within(const std::vector<Tradeoff> &points, double target_error)
{
  for (const size_t i : pareto_front(points))
    if (points[i].error <= target_error) return i;
  return std::nullopt;
}

std::vector<double> sensible_wishes(const std::vector<Tradeoff> &points, size_t most)
{
  const std::vector<size_t> front = pareto_front(points);
  std::vector<double> wishes;
  if (front.empty()) return wishes;
  const double worst = points[front.front()].error, smallest = 1e-15;
  const int first = static_cast<int>(std::ceil(std::log10(std::max(worst, smallest)) - 1e-9));
  for (int k = first; wishes.size() < most; --k) {
    const double wish = std::pow(10.0, k);
    if (wish < points[front.back()].error || wish < smallest) break;
    wishes.push_back(wish);
  }
  return wishes;
}

} // namespace tandem
