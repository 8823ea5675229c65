/* cases_motion.cpp - the group of cases with closed forms (flight, bounce, sliding, rolling, conservation), and of fast
 * bodies against thin ones. */
#include <algorithm>
#include <cmath>
#include <memory>

#include "host/base/random.h"
#include "tools/stability/cases.h"

namespace tandem::stability {
namespace {

constexpr double g = 10; /* m/s^2, that of empty_scene */

Trial flight_trial(Length length)
{
  Trial trial = trial_of(empty_scene(), steps_for(length, 120, 120));
  const Vector start(0, 30, 0), speed(3, 12, -4);
  Body &body = add_body(trial.scene, BodyType::dynamic, box_shape(0.5f, 0.2f, 0.3f), point_of(start));
  body.linear_velocity = vec3_of(speed);
  body.angular_velocity = {1, 2, 3};
  trial.checks.push_back(check("distance from the parabola", "m", 3e-4, distance_from_path(0, [=](double t) -> Vector {
                                 return start + t * speed + 0.5 * t * t * Vector(0, -g, 0);
                               })));
  return trial;
}

/* The worst relative error of the height after the first bounce, over balls of several restitutions and heights. */
Figure rebound_error(const std::vector<double> &expected, double radius)
{
  auto rebound = std::make_shared<std::vector<double>>(expected.size(), 0.0);
  return [=](const Moment &moment) {
    double worst = 0;
    for (size_t i = 0; i < expected.size(); ++i) {
      const BodyState &ball = moment.bodies[i + 1];
      const double speed = ball.linear_velocity[1];
      if ((*rebound)[i] == 0 && speed > 0) (*rebound)[i] = ball.position[1] - radius + speed * speed / (2 * g);
      worst = std::max(worst, std::abs((*rebound)[i] / expected[i] - 1));
    }
    return worst; /* 1 until all balls have bounced */
  };
}

Trial restitution_trial(Length length)
{
  Trial trial = trial_of(empty_scene(), steps_for(length, 90, 90));
  const float radius = 0.25f;
  add_ground(trial.scene);
  std::vector<double> expected;
  for (float e : {0.3f, 0.5f, 0.8f, 1.0f}) {
    const uint32_t material = add_material(trial.scene, 0.5f, e);
    for (float h : {0.5f, 1.0f, 2.03f, 4.1f, 7.77f}) {
      add_body(trial.scene, BodyType::dynamic, sphere_shape(radius), {2.0f * float(expected.size()), radius + h, 0})
          .material = material;
      expected.push_back(double(e) * e * h);
    }
  }
  trial.checks.push_back(at_end(check("largest error of the height", "", 3e-5, rebound_error(expected, radius))));
  return trial;
}

Trial elastic_trial(Length length)
{
  Trial trial = trial_of(empty_scene(), steps_for(length, 1200, 1200));
  add_ground(trial.scene);
  add_body(trial.scene, BodyType::dynamic, sphere_shape(0.25f), {0, 2.25f, 0}).material =
      add_material(trial.scene, 0, 1);
  const double energy = g * 2;
  const Figure gain = energy_gain(); /* the centre lies a radius above the ground */
  trial.checks.push_back(check("drift of energy", "", 1.5e-5,
                               [gain, energy](const Moment &moment) { return std::abs(gain(moment)) / energy; }));
  return trial;
}

/* Balls and boxes thrown at one another in empty space. */
Trial closed_system_trial(Length length)
{
  Trial trial = trial_of(empty_scene({0, 0, 0}), steps_for(length, 600, 600));
  Random random(11);
  for (int i = 0; i < 64; ++i) {
    const Vector place(2.0 * (i % 4) - 3, 2.0 * (i / 4 % 4) - 3, 2.0 * (i / 16) - 3);
    const Shape shape = i % 2 ? sphere_shape(0.5f) : box_shape(0.5f, 0.3f, 0.4f);
    Body &body = add_body(trial.scene, BodyType::dynamic, shape, point_of(place), float(random.uniform(0.5, 5)));
    body.orientation = random.orientation();
    body.linear_velocity =
        vec3_of(-1.5 * place + Vector{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
    body.angular_velocity = {float(random.uniform(-3, 3)), float(random.uniform(-3, 3)), float(random.uniform(-3, 3))};
  }
  trial.checks.push_back(check("drift of momentum", "", 2e-7, linear_momentum_drift()));
  trial.checks.push_back(check("drift of angular momentum", "", 5e-7, angular_momentum_drift()));
  trial.checks.push_back(check("gain of energy", "J/kg", energy_from_rounding(trial), energy_gain()));
  return trial;
}

/* A flat box on a ramp of its own, both rotated about z. */
void add_incline(Scene &scene, uint32_t material, double angle, double z)
{
  const Quat turn = turn_about({0, 0, 1}, angle);
  Body &ramp = add_body(scene, BodyType::fixed, box_shape(20, 0.5f, 0.6f), {0, 0, float(z)});
  ramp.orientation = turn;
  ramp.material = material;
  const Vector up(-std::sin(angle), std::cos(angle), 0);
  Body &box = add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.15f, 0.5f), point_of(0.65 * up + Vector(0, 0, z)));
  box.orientation = turn;
  box.material = material;
}

const std::vector<double> &coefficients()
{
  static const std::vector<double> values{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};
  return values;
}

/* Ramps at atan mu - 4 to + 4 degrees, a quarter degree apart. A box slips if it has moved by 2 cm after 2 s. */
struct Cone {
  static constexpr int to_each_side = 16;
  static constexpr double finest = 0.25 * pi / 180;
  static constexpr double nearest =
      0.125 + 1e-9; /* degrees: the first that slips is the one at the angle, or the next */
  static double angle(double mu, int k) { return std::atan(mu) + k * finest; }
};

Figure cone_error(const Scene &scene)
{
  std::vector<Vector> start;
  for (const Body &body : scene.bodies) start.push_back(vector_of(body.position));
  return [start](const Moment &moment) {
    double worst = 0;
    size_t box = 1;
    for (size_t i = 0; i < coefficients().size(); ++i) {
      double first = Cone::to_each_side + 1;
      for (int k = -Cone::to_each_side; k <= Cone::to_each_side; ++k, box += 2)
        if (!((vector_of(moment.bodies[box].position) - start[box]).norm() < 0.02)) first = std::min<double>(first, k);
      worst = std::max(worst, std::abs(first - 0.5) * Cone::finest * 180 /
                                  pi); /* between the last that holds and the first that slips */
    }
    return worst;
  };
}

Trial cone_trial(Length length)
{
  Trial trial = trial_of(empty_scene(), steps_for(length, 120, 120));
  double z = 0;
  for (double mu : coefficients()) {
    const uint32_t material = add_material(trial.scene, float(mu));
    for (int k = -Cone::to_each_side; k <= Cone::to_each_side; ++k)
      add_incline(trial.scene, material, Cone::angle(mu, k), z += 2);
  }
  trial.checks.push_back(
      at_end(check("largest error of the angle of slip", "degrees", Cone::nearest, cone_error(trial.scene))));
  return trial;
}

/* A box slides down a ramp 10 degrees steeper than the cone: s = g (sin a - mu cos a) t^2 / 2. */
Trial incline_trial(Length length)
{
  Trial trial = trial_of(empty_scene(), steps_for(length, 120, 120));
  std::vector<double> pull;
  double z = 0;
  for (double mu : coefficients()) {
    const double angle = std::atan(mu) + 10 * pi / 180;
    add_incline(trial.scene, add_material(trial.scene, float(mu)), angle, z += 2);
    pull.push_back(g * (std::sin(angle) - mu * std::cos(angle)));
  }
  std::vector<Vector> start;
  for (const Body &body : trial.scene.bodies) start.push_back(vector_of(body.position));
  trial.checks.push_back(at_end(check("largest error of the way down", "", 0.015, [=](const Moment &moment) {
    double worst = 0;
    for (size_t i = 0; i < pull.size(); ++i) {
      const double slid = (vector_of(moment.bodies[2 * i + 1].position) - start[2 * i + 1]).norm(),
                   displacement = 0.5 * pull[i] * moment.time * moment.time;
      worst = std::max(worst, std::abs(slid - displacement) / std::max(displacement, 1e-3));
    }
    return worst;
  })));
  return trial;
}

/* Bodies in contact move by h v with the velocity at the end of the substep, which prevents penetration. A body that
 * loses a h of its speed in each substep of h = 1/240 s therefore stops before v^2 / 2a by at most v h / 2, because a
 * sum of h (v - k a h) replaces the integral. Relative to the distance this is a h / v with a = mu g; 1e-4 is for
 * rounding. */
double stopping_error(double mu, double speed)
{
  const Settings settings;
  return mu * g * double(settings.step) / settings.substeps / speed + 1e-4;
}

Trial stop_trial(Length length)
{
  Trial trial = trial_of(empty_scene(), steps_for(length, 300, 300));
  add_ground(trial.scene);
  std::vector<double> displacement;
  double bound = 0;
  for (double mu : {0.2, 0.4, 0.6, 0.8, 1.0})
    for (double speed : {2.0, 5.0}) {
      Body &box = add_body(trial.scene, BodyType::dynamic, box_shape(0.5f, 0.1f, 0.5f),
                           {0, 0.1f, 2.0f * float(displacement.size())});
      box.linear_velocity = {float(speed), 0, 0};
      displacement.push_back(speed * speed / (2 * mu * g));
      bound = std::max(bound, stopping_error(mu, speed));
      box.material = 0;
      trial.scene.bodies.back().material = add_material(trial.scene, float(mu));
    }
  trial.scene.materials[0].static_friction = trial.scene.materials[0].dynamic_friction = 1; /* geometric mean, so ... */
  for (size_t i = 1; i < trial.scene.materials.size(); ++i)
    trial.scene.materials[i].friction_combine = Combine::minimum; /* ... mu itself */
  trial.checks.push_back(
      at_end(check("largest error of the way to rest", "", bound, [displacement](const Moment &moment) {
        double worst = 0;
        for (size_t i = 0; i < displacement.size(); ++i)
          worst = std::max(worst, std::abs(double(moment.bodies[i + 1].position[0]) / displacement[i] - 1));
        return worst;
      })));
  return trial;
}

/* A ball that starts sliding finally rolls at 5/7 of its speed. */
Trial rolling_trial(Length length)
{
  Trial trial = trial_of(empty_scene(), steps_for(length, 300, 300));
  add_ground(trial.scene);
  const double v0 = 7;
  add_body(trial.scene, BodyType::dynamic, sphere_shape(0.5f), {0, 0.5f, 0}).linear_velocity = {float(v0), 0, 0};
  trial.checks.push_back(at_end(check("error of the rolling speed", "", 1e-5, [v0](const Moment &moment) {
    return std::abs(double(moment.bodies[1].linear_velocity[0]) / (5.0 / 7.0 * v0) - 1);
  })));
  trial.checks.push_back(at_end(check("slip of the contact", "m/s",
                                      Bound::from_rounding(v0 * 0x1p-23, "spacing of floats of the speed at the start"),
                                      [](const Moment &moment) {
                                        return std::abs(double(moment.bodies[1].linear_velocity[0]) +
                                                        0.5 * double(moment.bodies[1].angular_velocity[2]));
                                      })));
  return trial;
}

/* The distance of the body's centre beyond x = 0; 0 in front of the wall. */
Figure beyond(uint32_t body, double x)
{
  return [=](const Moment &moment) {
    const double at = moment.bodies[body].position[0];
    return std::isnan(at) ? at : std::max(0.0, at - x);
  };
}

Trial thin_wall_trial(const Shape &shape, double speed, Length length)
{
  Trial trial = trial_of(empty_scene({0, 0, 0}), steps_for(length, 120, 120));
  add_body(trial.scene, BodyType::fixed, box_shape(0.005f, 2, 2), {0, 0, 0});
  add_body(trial.scene, BodyType::dynamic, shape, {-7.3f, 0.1f, 0.2f}).linear_velocity = {float(speed), 0, 0};
  trial.checks.push_back(check("got beyond the wall by", "m", 0, beyond(1, 0)));
  return trial;
}

Trial bullet_trial(Length length)
{
  Trial trial = trial_of(empty_scene(), steps_for(length, 120, 120));
  add_ground(trial.scene);
  for (int i = 0; i < 5; ++i)
    add_body(trial.scene, BodyType::dynamic, box_shape(0.1f, 0.5f, 0.5f), {0, 0.5f + float(i), 0}, 10);
  add_body(trial.scene, BodyType::dynamic, sphere_shape(0.05f), {-9, 2.6f, 0}, 0.1f).linear_velocity = {300, 0, 0};
  trial.checks.push_back(check("bullet past the box it hit by", "m", 0, [](const Moment &moment) {
    return std::max(0.0, double(moment.bodies[6].position[0]) - double(moment.bodies[3].position[0]));
  }));
  trial.checks.push_back(check("gain of energy", "J/kg", energy_from_rounding(trial), energy_gain()));
  return trial;
}

} // namespace

void add_motion_cases(std::vector<Case> &cases)
{
  const char *group = "motion";
  cases.push_back({"flight", group, "a spinning box thrown upwards",
                   "within 0.3 mm of the parabola for 2 s: what float rounding adds up to", flight_trial});
  cases.push_back({"restitution", group, "20 balls of four restitutions dropped from five heights",
                   "each returns to e^2 of its height within 0.003%", restitution_trial});
  cases.push_back({"elastic", group, "a ball of restitution 1 that bounces for 20 s",
                   "its energy drifts by less than 0.5%", elastic_trial});
  cases.push_back({"closed-system", group, "64 balls and boxes collide in empty space",
                   "momentum drifts by less than 2e-7 and angular momentum by less than 5e-7 of the sum of their "
                   "lengths, energy never grows",
                   closed_system_trial});
  cases.push_back({"friction-cone", group, "boxes on ramps, ten coefficients of friction from 0.1 to 1",
                   "each slips at atan mu, as near as ramps a quarter of a degree apart tell", cone_trial});
  cases.push_back({"incline", group, "boxes slide down ramps 10 degrees steeper than their friction holds",
                   "the way after 2 s is within 1.5% of g (sin a - mu cos a) t^2 / 2", incline_trial});
  cases.push_back({"sliding-stop", group, "sliding boxes come to rest",
                   "after v^2 / (2 mu g), less the v h / 2 that a substep of h = 1/240 s falls short: a share of mu g "
                   "h / v, 2.1% at most",
                   stop_trial});
  cases.push_back({"rolling-ball", group, "a ball that starts sliding",
                   "rolls at 5/7 of its speed, within 1e-5, without slip", rolling_trial});
  cases.push_back({"bullet-thin-wall", group, "a ball of 10 cm at 300 m/s against a wall of 1 cm",
                   "its centre never gets beyond the wall's",
                   [](Length length) { return thin_wall_trial(sphere_shape(0.05f), 300, length); }});
  cases.push_back({"needle-thin-wall", group, "a needle of 1 m by 1 cm at 100 m/s, point first, against a wall of 1 cm",
                   "its centre never gets beyond the wall's",
                   [](Length length) { return thin_wall_trial(box_shape(0.5f, 0.005f, 0.005f), 100, length); }});
  cases.push_back({"bullet-against-stack", group, "a ball of 100 g at 300 m/s against a column of five boxes of 10 kg",
                   "it never passes the box it hits; energy never grows", bullet_trial});
}

} // namespace tandem::stability
