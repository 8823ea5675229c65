/* structures.h - built-in scenes of structures: card house, arch, tower, dominoes, wall, tops.
 *
 * They are part of the catalogue (catalog.h), in a file of their own because each needs some geometry. Slopes are given
 * as tangents, so that only + - * / and square roots are needed and a scene has the same bits everywhere.
 */
#pragma once

#include <vector>

#include "host/catalog/catalog.h"

namespace tandem {

std::vector<BuiltInScene> structure_scenes();

/* Steady precession of the tops of `tops`: the angular speed of the axis about the vertical, rad/s. It is that of a
 * heavy symmetric top with its tip as pivot: I' W^2 cos t - I s W + m g d = 0, slower root, with I about the centre, I'
 * = I + m d^2, s the spin along the axis, d the distance from tip to centre, t the lean (Landau and Lifshitz,
 * Mechanics, section 35). The result is NaN if the spin is too slow. */
double steady_precession(double half_extent, double spin, double lean_tangent, double gravity);

} // namespace tandem
