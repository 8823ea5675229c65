/* pareto.h - which settings are worth taking: none is both faster and better. */
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace tandem {

struct Tradeoff {
  double cost, error;
};

/* Indices of the points that no other beats or equals in both and beats in one, by ascending cost; of equal points the
 * first. Points that are not finite never stand on the front. */
std::vector<size_t> pareto_front(const std::vector<Tradeoff> &points);

/* The cheapest point whose error is at most `target_error`; nothing if none is. */
std::optional<size_t> cheapest_within(const std::vector<Tradeoff> &points, double target_error);

/* Errors that a reader may wish for: powers of ten that the points can keep, from the coarsest that still needs a
 * choice to the finest, at most `most` of them. Empty if no point is finite. */
std::vector<double> sensible_wishes(const std::vector<Tradeoff> &points, size_t most);

} // namespace tandem
