/* counts.h - counts the cases that a solver passes, separately by what they needed: a case that needs a setting of its
 * own does not count as passed by default. */
#pragma once

#include <string>
#include <vector>

#include "tools/stability/results.h"

namespace tandem::stability {

struct Counts {
  size_t by_default = 0, with_setting = 0, with_solver = 0, failed = 0, refused = 0;
  size_t all() const { return by_default + with_setting + with_solver + failed + refused; }
};

Counts counts_of(const Results &results, const std::string &solver);

/* Text such as "59 pass by default, 11 only with a documented setting, 1 with a documented solver, 0 fail", and what is
 * refused, if anything. */
std::string text_of(const Counts &counts);

/* "pass", "with substeps 16", "with solver direct", "FAIL" or "refused". */
std::string verdict_of(const Outcome &outcome);

/* What a case needed and which check failed without it, such as "contact_hertz 600; by default 0.02 m (deepest
 * contact)"; empty if it passes by default. */
std::string with_what(const Outcome &outcome);

/* Figure, bound and ratio of every check of every run, one line each, in the order of the results; loose bounds are
 * marked. */
std::string bounds_text(const Results &results);

/* The number of checks of this solver with a bound of more than ten times their figure and without a derivation. */
size_t loose_bounds(const Results &results, const std::string &solver);

} // namespace tandem::stability
