/* cases.cpp - see cases.h. */
#include "tools/stability/cases.h"

#include <algorithm>

namespace tandem::stability {

const std::vector<Case> &all_cases()
{
  static const std::vector<Case> cases = [] {
    std::vector<Case> all;
    for (auto *add : {add_mass_ratio_cases, add_structure_cases, add_setting_cases, add_spin_cases, add_motion_cases, add_scale_cases,
                      add_degenerate_cases})
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

Body &add_body(Scene &scene, Motion motion, const Shape &shape, const Point &position, float mass)
{
  scene.shapes.push_back(shape);
  Body body;
  body.motion = motion;
  body.shape = uint32_t(scene.shapes.size() - 1);
  body.position = position;
  body.mass = mass;
  scene.bodies.push_back(body);
  return scene.bodies.back();
}

Body &add_ground(Scene &scene) { return add_body(scene, Motion::fixed, half_space_shape(), {0, 0, 0}); }

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
    add_body(scene, Motion::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 0.5f + float(i), 0}, masses[i]);
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

Check check(std::string what, std::string unit, double bound, Figure value)
{
  Check made;
  made.what = std::move(what);
  made.unit = std::move(unit);
  made.bound = bound;
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
  trial.checks.push_back(check("deepest contact", "m", bounds.depth, penetration()));
  trial.checks.push_back(check("largest tilt", "rad", bounds.tilt, tilt(trial.scene)));
  trial.checks.push_back(check("farthest sideways", "m", bounds.sideways, sideways(trial.scene)));
  trial.checks.push_back(at_end(check("fastest at the end", "m/s", bounds.speed, speed())));
}

} // namespace tandem::stability
