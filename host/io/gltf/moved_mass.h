/* moved_mass.h - the mass that a drive of a joint moves: kg along an axis, kg m² about one.
 *
 * A drive in the mode "acceleration" is scaled by it. It is that of both bodies where the file has them, and of all
 * that the joint holds: a hinge away from the centre of mass turns the body about the hinge, a slider moves it without
 * turning. Other joints and contacts do not count. This is not a public header.
 */
#pragma once

#include <optional>

#include <tandem/scene.h>

namespace tandem {

/* A placed joint, and what it holds. */
struct HoldingJoint {
  Joint joint;
  Axes directions, rotations;
};

/* Of two placed joints of the same bodies one drives and one holds, or one does both. axis: 0 to 2 the directions, 3 to
 * 5 the rotations of the driving one's frame a. Nothing if what is held leaves the axis no motion. */
std::optional<double> moved_mass(const Scene &scene, const Joint &drives, const HoldingJoint &holds, size_t axis);

} // namespace tandem
