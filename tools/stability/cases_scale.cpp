/* cases_scale.cpp - the group of cases with sizes and masses many decades apart in one scene, and with scenes far from
 * the origin. */
#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "tools/stability/cases.h"

namespace tandem::stability {
namespace {

Trial sizes_trial(Length length)
{
  Trial trial = trial_of(empty_scene(), steps_for(length, 300, 300));
  add_ground(trial.scene);
  trial.documented = with_substeps(32);
  add_body(trial.scene, BodyType::dynamic, box_shape(500, 500, 500), {-600, 500, 0}, 1e9f);
  for (int i = 0; i < 3; ++i)
    add_body(trial.scene, BodyType::dynamic, box_shape(5e-4f, 5e-4f, 5e-4f), {0, 5e-4f + 1e-3f * float(i), 0}, 1e-6f);
  trial.checks.push_back(check("small cubes moved by", "m", 3e-5, [start = trial.scene.bodies](const Moment &moment) {
    double worst = 0;
    for (size_t i = 2; i < start.size(); ++i) {
      const double displacement = (vector_of(moment.bodies[i].position) - vector_of(start[i].position)).norm();
      worst = displacement > worst || std::isnan(displacement) ? displacement : worst;
    }
    return worst;
  }));
  trial.checks.push_back(check("large cube moved by", "m", depth_from_rounding(trial),
                               [start = trial.scene.bodies[1]](const Moment &moment) {
                                 return (vector_of(moment.bodies[1].position) - vector_of(start.position)).norm();
                               }));
  return trial;
}

/* m: how far the top of a column of five sinks, summed over the contacts: loads of 5 on the ground, and of 4, 3, 2, 1
 * on effective masses of 1/2. */
double sink_of_five(const Settings &settings) { return sink_under(5 + 2 * (4 + 3 + 2 + 1), stiffest(settings)); }

/* A column of five cubes at a scale of its own. */
Case size_case(const std::string &name, double edge, double gravity)
{
  return {name, "scale", fmt::format("a column of five cubes of {} m", edge),
          "no cube moves farther than the springs of the column sink under it, or than a fifth of its edge, in 5 s; "
          "none turns but for rounding",
          [edge, gravity](Length length) {
            Trial trial = trial_of(empty_scene({0, float(-gravity), 0}), steps_for(length, 300, 300));
            add_ground(trial.scene);
            if (edge < 0.01) trial.documented = with_substeps(32);
            for (int i = 0; i < 5; ++i)
              add_body(trial.scene, BodyType::dynamic, box_shape(float(edge / 2), float(edge / 2), float(edge / 2)),
                       {0, float(edge * (i + 0.5)), 0}, float(1000 * edge * edge * edge));
            const double sink = sink_of_five(trial.documented.value_or(trial.settings));
            trial.checks.push_back(
                check("farthest from the start", "m", std::min(edge / 5, sink), displacement(trial.scene)));
            trial.checks.push_back(check("largest tilt", "rad", turn_from_rounding(trial), tilt(trial.scene)));
            return trial;
          }};
}

Trial masses_trial(Length length)
{
  Trial trial = trial_of(empty_scene(), steps_for(length, 600, 600));
  add_ground(trial.scene);
  add_body(trial.scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 0.5f, 0}, 1e9f);
  add_body(trial.scene, BodyType::dynamic, box_shape(0.1f, 0.1f, 0.1f), {0, 1.1f, 0}, 1e-6f);
  add_body(trial.scene, BodyType::dynamic, box_shape(0.1f, 0.1f, 0.1f), {0.6f, 0.1f, 0}, 1e-6f);
  add_body(trial.scene, BodyType::dynamic, box_shape(0.1f, 0.1f, 0.1f), {0.8f, 0.1f, 0}, 1e-6f);
  add_standing(trial, {});
  return trial;
}

/* A scene that must behave far from the origin exactly as near it: a column, a sliding box, a rolling ball, on a static
 * block. All positions are multiples of 1/16 m, which floats represent exactly at 1,000 km. */
Scene yard(double x)
{
  Scene scene = empty_scene();
  const auto at = [x](double dx, double y, double z) { return Point{x + dx, y, z}; };
  add_body(scene, BodyType::fixed, box_shape(32, 1, 8), at(0, -1, 0));
  for (int i = 0; i < 5; ++i) add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), at(0, 0.5 + i, 0));
  add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.25f, 0.5f), at(-8, 0.25, 3)).linear_velocity = {5, 0, 0};
  add_body(scene, BodyType::dynamic, sphere_shape(0.5f), at(-8, 0.5, -3)).linear_velocity = {3, 0, 0};
  add_body(scene, BodyType::dynamic, sphere_shape(0.5f), at(4, 3.5, -3));
  return scene;
}

/* The yard in a world of its own at the origin, with the settings of the trial (including the solver's substeps), and
 * stepped along with it. */
class Twin {
public:
  const std::vector<BodyState> &at(const Moment &moment)
  {
    if (!world_) world_ = std::make_unique<World>(yard(0), moment.world.settings(), Placement{});
    if (done_ == moment.step && !bodies_.empty()) return bodies_;
    for (; done_ < moment.step; ++done_) world_->step();
    return bodies_ = world_->bodies();
  }

private:
  std::unique_ptr<World> world_;
  uint64_t done_ = 0;
  std::vector<BodyState> bodies_;
};

Figure largest_difference(const std::shared_ptr<Twin> &twin,
                          std::function<double(const BodyState &far, const BodyState &near)> difference)
{
  return [=](const Moment &moment) {
    const std::vector<BodyState> &near = twin->at(moment);
    double worst = 0;
    for (size_t i = 0; i < near.size(); ++i) {
      const double apart = difference(moment.bodies[i], near[i]);
      if (std::isnan(apart) || apart > worst) worst = apart;
    }
    return worst;
  };
}

double turn_between(const BodyState &far, const BodyState &near)
{
  const auto quaternion = [](const Quat &q) { return Eigen::Quaterniond(q[3], q[0], q[1], q[2]); };
  return 2 * (quaternion(far.orientation) * quaternion(near.orientation).conjugate()).vec().norm();
}

/* A position is stored in two floats, with a spacing of x 2^-48, and is rounded in every substep. The rounding may
 * change the last bit of a velocity, 5 m/s at most, with which the body moves to the end. */
Bound place_from_rounding(const Trial &trial, double x)
{
  const double substeps = double(trial.steps) * trial.settings.substeps,
               seconds = double(trial.steps) * double(trial.settings.step);
  return Bound::from_rounding(substeps * x * 0x1p-48 + 5 * 0x1p-23 * seconds,
                              fmt::format("{:.0f} substeps, in each the spacing of pairs of floats at {:.0f} km, and "
                                          "that of a speed of 5 m/s for {:.0f} s",
                                          substeps, x / 1000, seconds));
}

Bound turn_of_far_from_rounding(const Trial &trial)
{
  const double substeps = double(trial.steps) * trial.settings.substeps;
  return Bound::from_rounding(substeps * 0x1p-23,
                              fmt::format("{:.0f} substeps, in each the spacing of floats of 1", substeps));
}

/* The spacing of floats at x. */
double spacing(double x) { return std::nextafter(float(x), HUGE_VALF) - float(x); }

Case far_case(double kilometres)
{
  const double x = 1000 * kilometres;
  return {fmt::format("far-{:.0f}-km", kilometres), "scale",
          fmt::format("{:.0f} km from the origin, where floats are {:.2g} m apart: a column, a sliding box, a rolling "
                      "and a falling ball",
                      kilometres, spacing(x)),
          "everything where it is at the origin, and turned as there, but for the rounding of its place, for 3 s",
          [=](Length length) {
            Trial trial = trial_of(yard(x), steps_for(length, 180, 180));
            const auto twin = std::make_shared<Twin>();
            trial.checks.push_back(
                check("difference from the origin", "m", place_from_rounding(trial, x),
                      largest_difference(twin, [x](const BodyState &far, const BodyState &near) {
                        return (vector_of(far.position) - vector_of(near.position) - Vector(x, 0, 0)).norm();
                      })));
            trial.checks.push_back(check("turned otherwise than at the origin", "rad", turn_of_far_from_rounding(trial),
                                         largest_difference(twin, turn_between)));
            return trial;
          }};
}

} // namespace

void add_scale_cases(std::vector<Case> &cases)
{
  cases.push_back(
      {"1mm-beside-1km", "scale", "three cubes of 1 mm, 1 mg each, on one another, beside a cube of 1 km",
       "the small ones move by less than 3% of their edge in 5 s, the large one not at all but for rounding",
       sizes_trial});
  cases.push_back(size_case("edge-1-mm", 1e-3, 10));
  cases.push_back(size_case("edge-1-cm", 1e-2, 10));
  cases.push_back(size_case("edge-100-m", 100, 10));
  cases.push_back(size_case("edge-1-km", 1000, 10));
  cases.push_back({"masses-1e-6-beside-1e9", "scale", "cubes of 1 mg on and against a cube of a million tonnes",
                   "stands 10 s: no contact deepens, nothing turns, leaves or moves at the end, but for rounding",
                   masses_trial});
  for (double kilometres : {1.0, 20.0, 1000.0}) cases.push_back(far_case(kilometres));
}

} // namespace tandem::stability
