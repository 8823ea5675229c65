/* cases.cpp - the list of all cases, scenes that several groups use, and bounds derived from rounding; see cases.h. */
#include "tools/stability/cases.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tandem::stability {

const std::vector<Case> &all_cases()
{
  static const std::vector<Case> cases = [] {
    std::vector<Case> all;
    for (auto *add : {add_mass_ratio_cases, add_structure_cases, add_setting_cases, add_spin_cases, add_motion_cases,
                      add_scale_cases, add_degenerate_cases, add_misses_cases, add_chain_cases, add_machine_cases,
                      add_conflict_cases})
      add(all);
    return all;
  }();
  return cases;
}

Scene empty_scene(const Vec3 &gravity)
{
  Scene scene;
  scene.name = "stability";
  scene.gravity = gravity;
  return scene;
}

Body &add_body(Scene &scene, BodyType motion, const Shape &shape, const Point &position, float mass)
{
  scene.shapes.push_back(shape);
  Body body;
  body.type = motion;
  body.shape = uint32_t(scene.shapes.size() - 1);
  body.position = position;
  body.mass = mass;
  scene.bodies.push_back(body);
  return scene.bodies.back();
}

Body &add_ground(Scene &scene) { return add_body(scene, BodyType::fixed, half_space_shape(), {0, 0, 0}); }

uint32_t add_material(Scene &scene, float friction, float restitution)
{
  Material material;
  material.static_friction = material.dynamic_friction = friction;
  material.restitution = restitution;
  scene.materials.push_back(material);
  return uint32_t(scene.materials.size() - 1);
}

Scene column_of(const std::vector<float> &masses)
{
  Scene scene = empty_scene();
  add_ground(scene);
  for (size_t i = 0; i < masses.size(); ++i)
    add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 0.5f + float(i), 0}, masses[i]);
  return scene;
}

Trial trial_of(Scene scene, uint64_t steps)
{
  Trial trial;
  trial.scene = std::move(scene);
  trial.steps = steps;
  return trial;
}

uint64_t steps_for(Length length, uint64_t full, uint64_t quick)
{
  return length == Length::full ? full : length == Length::quick ? quick : std::min<uint64_t>(quick, 20);
}

Settings with_substeps(uint32_t substeps)
{
  Settings settings;
  settings.substeps = substeps;
  settings.contact_hertz = 12.0f * float(substeps);
  return settings;
}

Check check(std::string what, std::string unit, Bound bound, Figure value)
{
  Check made;
  made.what = std::move(what);
  made.unit = std::move(unit);
  made.bound = std::move(bound);
  made.value = std::move(value);
  return made;
}

Check at_end(Check check)
{
  check.over = Check::Over::last;
  return check;
}

void add_standing(Trial &trial, const Standing &bounds)
{
  const auto bound = [&](const std::optional<double> &given, auto from_rounding) {
    return given ? Bound(*given) : from_rounding(trial);
  };
  trial.checks.push_back(check("deepest contact", "m", bound(bounds.depth, depth_from_rounding), penetration()));
  trial.checks.push_back(check("largest tilt", "rad", bound(bounds.tilt, turn_from_rounding), tilt(trial.scene)));
  trial.checks.push_back(
      check("farthest sideways", "m", bound(bounds.sideways, distance_from_rounding), sideways(trial.scene)));
  trial.checks.push_back(at_end(check("fastest at the end", "m/s", bound(bounds.speed, speed_from_rounding), speed())));
}

namespace {

constexpr double float_spacing = 0x1p-23; /* the largest relative spacing of floats */

const Settings &settings_used(const Trial &trial) { return trial.documented ? *trial.documented : trial.settings; }
double substep_of(const Trial &trial) { return double(settings_used(trial).step) / settings_used(trial).substeps; }
double substeps_of(const Trial &trial) { return double(trial.steps) * settings_used(trial).substeps; }

double half_extent(const Scene &scene, const Body &body, bool largest)
{
  const Vec3 &size = scene.shapes[body.shape].size;
  return largest ? std::max({size[0], size[1], size[2]}) : std::min({size[0], size[1], size[2]});
}

double reach_of(const Scene &scene)
{
  double reach = 0;
  for (const Body &body : scene.bodies)
    if (body.type == BodyType::dynamic)
      reach = std::max(reach, vector_of(body.position).lpNorm<Eigen::Infinity>() + half_extent(scene, body, true));
  return reach;
}

double smallest_half_extent(const Scene &scene)
{
  double smallest = HUGE_VAL;
  for (const Body &body : scene.bodies)
    if (body.type == BodyType::dynamic) smallest = std::min(smallest, half_extent(scene, body, false));
  return smallest;
}

double turn_by_rounding(const Trial &trial)
{
  return substeps_of(trial) * reach_of(trial.scene) * float_spacing / smallest_half_extent(trial.scene);
}

constexpr double stands = 0.05; /* rad or m: a pile that leans more does not stand, whatever the reason */

} // namespace

Bound depth_from_rounding(const Trial &trial)
{
  const double reach = reach_of(trial.scene);
  return Bound::from_rounding(reach * float_spacing, fmt::format("spacing of floats at {:.3g} m", reach));
}

Bound turn_from_rounding(const Trial &trial)
{
  return Bound::from_rounding(
      std::min(stands, turn_by_rounding(trial)),
      fmt::format(
          "{:.0f} substeps, in each the spacing of floats at {:.3g} m over half an edge of {:.3g} m; at most {} rad",
          substeps_of(trial), reach_of(trial.scene), smallest_half_extent(trial.scene), stands));
}

Bound distance_from_rounding(const Trial &trial)
{
  const double reach = reach_of(trial.scene);
  return Bound::from_rounding(std::min(stands, turn_by_rounding(trial) * reach),
                              fmt::format("the turn by rounding, at {:.3g} m; at most {} m", reach, stands));
}

Bound speed_from_rounding(const Trial &trial)
{
  const double reach = reach_of(trial.scene);
  return Bound::from_rounding(
      reach * float_spacing / substep_of(trial),
      fmt::format("spacing of floats at {:.3g} m in a substep of {:.3g} s", reach, substep_of(trial)));
}

Bound energy_from_rounding(const Trial &trial)
{
  double mass = 0, energy = 0;
  for (const Body &body : trial.scene.bodies) {
    if (body.type != BodyType::dynamic) continue;
    const BodyState state{body.position, body.orientation, body.linear_velocity, body.angular_velocity};
    mass += double(body.mass);
    energy += kinetic_energy(trial.scene, body, state) +
              double(body.mass) * std::abs(vector_of(trial.scene.gravity).dot(vector_of(body.position)));
  }
  return Bound::from_rounding(
      substeps_of(trial) * float_spacing * energy / mass,
      fmt::format("{:.0f} substeps, in each the spacing of floats of {:.3g} J/kg", substeps_of(trial), energy / mass));
}

double sink_under(double load, double hertz) { return load * 10 / ((2 * pi * hertz) * (2 * pi * hertz)); }
double stiffest(const Settings &settings) { return 0.2 * settings.substeps / double(settings.step); }

} // namespace tandem::stability
