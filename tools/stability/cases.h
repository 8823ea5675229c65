/* cases.h - the catalogue of stability cases, one file for each group; docs/stability.md is its table.
 *
 * To add a case: push a Case in the file of its group (name, sentence, criterion, build). build() is called once
 * for each run, since figures keep what they saw at the start. What several groups need to build scenes is here.
 */
#pragma once

#include <vector>

#include "tools/stability/figures.h"
#include "tools/stability/trial.h"

namespace tandem::stability {

/* All, in the order of the groups. */
const std::vector<Case> &all_cases();

void add_mass_ratio_cases(std::vector<Case> &cases);
void add_structure_cases(std::vector<Case> &cases);
void add_setting_cases(std::vector<Case> &cases);
void add_spin_cases(std::vector<Case> &cases);
void add_motion_cases(std::vector<Case> &cases);
void add_scale_cases(std::vector<Case> &cases);
void add_degenerate_cases(std::vector<Case> &cases);

/* --- scenes ----------------------------------------------------------------------------------------------- */

Scene empty_scene(const Vec3 &gravity = {0, -10, 0});
/* A body with a shape of its own; what else it needs is set on the reference, before the next is added. */
Body &add_body(Scene &scene, Motion motion, const Shape &shape, const Point &position, float mass = 1);
Body &add_ground(Scene &scene); /* all points with y <= 0 */
uint32_t add_material(Scene &scene, float friction, float restitution = 0);

/* Cubes of half extent 0.5 m on a ground, one on another, of the given masses from below. */
Scene column_of(const std::vector<float> &masses);

Trial trial_of(Scene scene, uint64_t steps);
uint64_t steps_for(Length length, uint64_t full, uint64_t quick); /* brief: at most 20 */

/* --- checks ------------------------------------------------------------------------------------------------ */

/* "It stands": turns, sideways ways and, in the end, speeds stay below the bounds; no contact is deeper than `depth`. */
struct Standing {
  double tilt = 0.05;      /* rad */
  double sideways = 0.05;  /* m */
  double depth = 0.02;     /* m: four times the slop */
  double speed = 0.05;     /* m/s, at the end */
};
void add_standing(Trial &trial, const Standing &bounds);

/* The setting that heavy loads and tall stacks need: more substeps, and contacts as stiff as those allow (h w <= sqrt 2 is the
 * limit of stability of a soft contact, 0.2 / h hertz is below it). docs/stability.md derives both. */
Settings with_substeps(uint32_t substeps);

Check check(std::string what, std::string unit, double bound, Figure value);
Check at_end(Check check);

} // namespace tandem::stability
