/* passes.h - scenes of movers that pass an obstacle with a known clearance, or overlap it by a known depth, at a known
 * time.
 *
 *        --> v        mover, lowest point  p
 *   - - - - - - - - - - - - - - - - - - - - -     clearance: p is that far above the top when it is over it
 *            /\       obstacle, all of it at or below its top
 *
 * A mover flies straight along x without rotating, and no part of an obstacle is ever above its top. The plane of the
 * top separates them, so the closest approach is the clearance, when the lowest point is over the top. Lanes are along
 * z, 20 m apart, which is farther than the fastest mover goes in three steps.
 */
#pragma once

#include "tools/stability/cases.h"

namespace tandem::stability {

enum class Obstacle { edge, corner, mesh_edge, rotor };

struct Mover {
  std::string name;
  Shape shape;
  Quat orientation;
};
const std::vector<Mover> &movers();

/* The vector from the centre of the mover to its lowest point (y). */
Vector lowest_point(const Mover &mover);

/* One mover past one obstacle. */
struct Lane {
  double clearance;       /* m; if negative, the depth of the overlap */
  double speed;           /* m/s */
  double passes;          /* s: the time at which the lowest point is over the top */
  size_t obstacle, mover; /* bodies */
};

struct Passes {
  Scene scene; /* no gravity */
  std::vector<Lane> lanes;
};

/* m/s: 1, 5, 30, 100, 300. */
const std::vector<double> &all_speeds();

/* Makes a lane for every clearance at every speed. */
Passes passes_of(const Mover &mover, Obstacle obstacle, const std::vector<double> &clearances,
                 const std::vector<double> &speeds = all_speeds());

/* Movers hit a fixed wall of 1 cm in the plane x = 0 perpendicularly; `mesh`: a sheet without thickness. */
Passes hits_on_wall(const Mover &mover, bool mesh, const std::vector<double> &speeds = all_speeds());

} // namespace tandem::stability
