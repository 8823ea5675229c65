/* cases.h - the catalogue of stability cases, one file for each group; docs/stability.md has their table.
 *
 * To add a case, push a Case in the file of its group (name, sentence, criterion, build). build() is called once for
 * each run, because figures store what they observe at the start. Functions that several groups need to build scenes
 * are declared here.
 */
#pragma once

#include <vector>

#include "tools/stability/figures.h"
#include "tools/stability/trial.h"

namespace tandem::stability {

/* All cases, in the order of the groups. */
const std::vector<Case> &all_cases();

void add_mass_ratio_cases(std::vector<Case> &cases);
void add_structure_cases(std::vector<Case> &cases);
void add_setting_cases(std::vector<Case> &cases);
void add_spin_cases(std::vector<Case> &cases);
void add_motion_cases(std::vector<Case> &cases);
void add_scale_cases(std::vector<Case> &cases);
void add_degenerate_cases(std::vector<Case> &cases);
void add_misses_cases(std::vector<Case> &cases);
void add_chain_cases(std::vector<Case> &cases);
void add_machine_cases(std::vector<Case> &cases);
void add_conflict_cases(std::vector<Case> &cases);

/* --- scenes ----------------------------------------------------------------------------------------------- */

Scene empty_scene(const Vec3 &gravity = {0, -10, 0});
/* Adds a body with a shape of its own; other fields are set on the reference, before the next body is added. */
Body &add_body(Scene &scene, BodyType motion, const Shape &shape, const Point &position, float mass = 1);
Body &add_ground(Scene &scene); /* all points with y <= 0 */
uint32_t add_material(Scene &scene, float friction, float restitution = 0);

/* Cubes of half extent 0.5 m on a ground, one on top of another, with the given masses from the bottom up. */
Scene column_of(const std::vector<float> &masses);

Trial trial_of(Scene scene, uint64_t steps);
uint64_t steps_for(Length length, uint64_t full, uint64_t quick); /* brief: at most 20 */

/* --- checks ------------------------------------------------------------------------------------------------ */

/* "It stands": rotations, sideways displacements and final speeds stay below the bounds, and no contact is deeper than
 * `depth`. A bound that is not given is derived from rounding, because a symmetric pile has no reason to turn, and a
 * body at rest none to move. */
struct Standing {
  std::optional<double> depth;    /* m */
  std::optional<double> tilt;     /* rad */
  std::optional<double> sideways; /* m */
  std::optional<double> speed;    /* m/s, at the end */
};
void add_standing(Trial &trial, const Standing &bounds);

/* --- bounds from rounding ----------------------------------------------------------------------------------
 *
 * Floats of a length L are L 2^-23 apart, so a separation may be wrong by that much in each of the N substeps. These
 * functions must be called when scene, steps and settings are set: L is the largest distance of a body from the origin;
 * N and the substep h are those of the documented settings, if any. */

Bound depth_from_rounding(const Trial &trial);    /* m: L 2^-23 */
Bound turn_from_rounding(const Trial &trial);     /* rad: N L 2^-23 over the smallest half extent, and at most 0.05 */
Bound distance_from_rounding(const Trial &trial); /* m: that turn at a height of L, and at most 0.05 */
Bound speed_from_rounding(const Trial &trial);    /* m/s: L 2^-23 in a substep */
/* J/kg: N 2^-23 of the initial energy of the scene, with the potential energy of its bodies relative to y = 0. */
Bound energy_from_rounding(const Trial &trial);

/* m, in addition to the slop: the depth at which springs hold a contact that carries `load` times its effective mass
 * under g = 10 m/s^2. */
double sink_under(double load, double hertz);
/* Hz: the stiffest contact that a substep allows, a fifth of the substep rate. */
double stiffest(const Settings &settings);

/* The setting that heavy loads and tall stacks need: more substeps, and contacts as stiff as these allow (h w <= sqrt 2
 * is the limit of stability of a soft contact, and 0.2 / h hertz is below it). docs/stability.md derives both. */
Settings with_substeps(uint32_t substeps);

Check check(std::string what, std::string unit, Bound bound, Figure value);
Check at_end(Check check);

} // namespace tandem::stability
