/* passes.h - scenes of movers that pass an obstacle by a known clearance, or overlap it by a known depth, at a known
 * time.
 *
 *        --> v        mover, lowest point  p
 *   - - - - - - - - - - - - - - - - - - - - -     clearance: p is that far above the top when it is over it
 *            /\       obstacle, all of it at or below its top
 *
 * A mover flies straight along x without turning, and nothing of an obstacle is ever above its top: the plane of the
 * top parts them, so that the closest approach is the clearance, at the moment when the lowest point is over the top.
 * Lanes lie along z, 20 m apart: farther than the fastest goes in three steps.
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

/* From the centre of the mover to its lowest point (y). */
Vector lowest_point(const Mover &mover);

/* One mover past one obstacle. */
struct Lane {
  double clearance;       /* m; below 0 by how much they overlap */
  double speed;           /* m/s */
  double passes;          /* s: when the lowest point is over the top */
  size_t obstacle, mover; /* bodies */
};

struct Passes {
  Scene scene; /* no gravity */
  std::vector<Lane> lanes;
};

/* m/s: 1, 5, 30, 100, 300. */
const std::vector<double> &all_speeds();

/* Every clearance at every speed. */
Passes passes_of(const Mover &mover, Obstacle obstacle, const std::vector<double> &clearances,
                 const std::vector<double> &speeds = all_speeds());

/* Squarely against a fixed wall of 1 cm in the plane x = 0; `mesh`: against a sheet without thickness. */
Passes hits_on_wall(const Mover &mover, bool mesh, const std::vector<double> &speeds = all_speeds());

} // namespace tandem::stability
