/* pareto.h - the Pareto front of settings: those to which no other is both faster and more accurate. */
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace tandem {

struct Tradeoff {
  double cost, error;
};

/* Indices of the points that no other point dominates (at least equal in both and better in one), by ascending cost; of
 * equal points the first. Points that are not finite are never on the front. */
std::vector<size_t> pareto_front(const std::vector<Tradeoff> &points);

/* The cheapest point whose error is at most `target_error`; nothing if there is none. */
std::optional<size_t> cheapest_within(const std::vector<Tradeoff> &points, double target_error);

/* Useful target errors: powers of ten that some points reach, from the coarsest for which there is still a choice to
 * the finest, at most `most` of them. Empty if no point is finite. */
std::vector<double> sensible_wishes(const std::vector<Tradeoff> &points, size_t most);

} // namespace tandem
