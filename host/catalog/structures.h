/* structures.h - built-in scenes that are built things: card house, arch, tower, dominoes, wall, tops.
 *
 * Part of the catalogue (catalog.h), in a file of its own because each takes some geometry. Slopes are given
 * as tangents, so that only + - * / and square roots are needed and a scene has the same bits everywhere.
 */
#pragma once

#include <vector>

#include "host/catalog/catalog.h"

namespace tandem {

std::vector<BuiltInScene> structure_scenes();

/* Steady precession of the tops of `tops`: angular speed of the axis about the vertical, rad/s. Heavy symmetric top
 * with its tip as pivot: I' W^2 cos t - I s W + m g d = 0, slower root; I about the centre, I' = I + m d^2, s the spin
 * along the axis, d from tip to centre, t the lean (Landau and Lifshitz, Mechanics, section 35). NaN if the spin is too
 * slow for it. */
double steady_precession(double half_extent, double spin, double lean_tangent, double gravity);

} // namespace tandem
