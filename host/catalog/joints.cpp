/* joints.cpp - the scenes of joints.h, with the geometry of each at its builder. */
#include "host/catalog/joints.h"

#include <cmath>

#include <tandem/round_to_float.h>

#include "host/catalog/builders.h"
#include "host/catalog/ragdolls.h"

namespace tandem {

using namespace scene_builders;

namespace {

/* A joint at a point of each body, in its axes. */
Joint &connect(Scene &scene, JointType type, uint32_t a, const Point &at_a, uint32_t b, const Point &at_b)
{
  Joint joint;
  joint.type = type;
  joint.body_a = a;
  joint.body_b = b;
  joint.position_a = at_a;
  joint.position_b = at_b;
  return scene.joints.emplace_back(joint);
}

/* --- joint-grid: the scene of a published comparison, a net that hangs from its first row ------------------------
 *
 *     #---#---#---#     balls of 0.4 m, 1 m apart, at (column, -row, 0); the first row is fixed
 *     |   |   |   |     ball joints half-way between neighbours
 *     o---o---o---o     the balls collide with nothing
 */

uint64_t joint_grid_bodies(const SceneValues &v) { return uint64_t(whole(v, "columns") * whole(v, "rows")); }

Scene joint_grid(const SceneValues &v)
{
  const int64_t columns = whole(v, "columns"), rows = whole(v, "rows");
  const double radius = 0.4;
  Scene scene;
  scene.shapes = {sphere_shape(round_to_float(radius))};
  const float mass = round_to_float(density_of_water * 4 / 3 * M_PI * radius * radius * radius);
  for (int64_t column = 0; column < columns; ++column)
    for (int64_t row = 0; row < rows; ++row) {
      const auto index = static_cast<uint32_t>(scene.bodies.size());
      Body &body = add_body(scene, 0, {double(column), -double(row), 0}, mass);
      body.filter_group = 2;
      body.filter_mask = ~2u;
      if (row == 0) body.type = BodyType::fixed;
      else connect(scene, JointType::ball, index - 1, {0, -0.5, 0}, index, {0, 0.5, 0});
      if (column > 0 && row > 0)
        connect(scene, JointType::ball, index - static_cast<uint32_t>(rows), {0.5, 0, 0}, index, {-0.5, 0, 0});
    }
  return scene;
}

/* --- hinge-chain: flat links that hang from the world and swing about z ------------------------------------------- */

uint64_t number_of_links(const SceneValues &v) { return uint64_t(whole(v, "n")); }

/* The axis of a hinge is x of its frames; this turns it to z. */
constexpr Quat x_to_z{0, -0.70710678f, 0, 0.70710678f};

Scene hinge_chain(const SceneValues &v)
{
  const double half = 0.5 * number(v, "length");
  Scene scene;
  scene.shapes = {box_shape(round_to_float(half), round_to_float(0.2 * half), round_to_float(0.5 * half))};
  const auto mass = round_to_float(density_of_water * 8 * half * 0.2 * half * 0.5 * half);
  for (int64_t i = 0; i < whole(v, "n"); ++i) {
    const auto index = static_cast<uint32_t>(scene.bodies.size());
    add_body(scene, 0, {half * double(1 + 2 * i), 0, 0}, mass);
    Joint &joint =
        connect(scene, JointType::hinge, i == 0 ? no_body : index - 1, {i == 0 ? 0 : half, 0, 0}, index, {-half, 0, 0});
    joint.orientation_a = joint.orientation_b = x_to_z;
  }
  return scene;
}

/* --- pendulums: balls on hinges to the world, each let go at another angle ---------------------------------------
 *
 *      world o--------O   body: the ball; the joint's frame b is at its pivot
 */

Scene pendulums(const SceneValues &v)
{
  const int64_t n = whole(v, "n");
  const double length = number(v, "length"), radius = 0.1 * length;
  Scene scene;
  scene.shapes = {sphere_shape(round_to_float(radius))};
  for (int64_t i = 0; i < n; ++i) {
    const double t = number(v, "tangent") * double(i + 1) / double(n), half_cosine = 1 / std::sqrt(1 + t * t),
                 half_sine = t * half_cosine, z = 3 * radius * double(i);
    const double sine = 2 * half_sine * half_cosine, cosine = half_cosine * half_cosine - half_sine * half_sine;
    const auto index = static_cast<uint32_t>(scene.bodies.size());
    Body &ball = add_body(scene, 0, {length * sine, -length * cosine, z});
    ball.orientation = {0, 0, round_to_float(half_sine), round_to_float(half_cosine)};
    Joint &joint = connect(scene, JointType::hinge, no_body, {0, 0, z}, index, {0, length, 0});
    joint.orientation_a = joint.orientation_b = x_to_z;
  }
  return scene;
}

/* --- bridge: planks on hinges between two fixed banks, and balls that have been dropped on them -------------------
 *
 *      o   o   o
 *  |==-==-==-==-==-==|
 */

uint64_t bridge_bodies(const SceneValues &v) { return 3 + uint64_t(whole(v, "planks") + whole(v, "balls")); }

Scene bridge(const SceneValues &v)
{
  const int64_t planks = whole(v, "planks"), balls = whole(v, "balls");
  const double half = 0.25, thick = 0.05, wide = 1, end = 2 * half * double(planks);
  Scene scene;
  add_ground(scene);
  const uint32_t plank = add_shape(scene, box_shape(round_to_float(half), round_to_float(thick), round_to_float(wide))),
                 ball = add_shape(scene, sphere_shape(0.3f));
  const double height = number(v, "height");
  for (const double x : {-half, end + half}) add_body(scene, plank, {x, height, 0}).type = BodyType::fixed;
  for (int64_t i = 0; i < planks; ++i) {
    const auto index = static_cast<uint32_t>(scene.bodies.size());
    add_body(scene, plank, {half * double(1 + 2 * i), height, 0},
             round_to_float(0.5 * density_of_water * 8 * half * thick * wide));
    Joint &joint = connect(scene, JointType::hinge, i == 0 ? 1 : index - 1, {half, 0, 0}, index, {-half, 0, 0});
    joint.orientation_a = joint.orientation_b = x_to_z;
  }
  const auto last = static_cast<uint32_t>(scene.bodies.size() - 1);
  Joint &joint = connect(scene, JointType::hinge, last, {half, 0, 0}, 2, {-half, 0, 0});
  joint.orientation_a = joint.orientation_b = x_to_z;
  for (int64_t i = 0; i < balls; ++i)
    add_body(scene, ball, {end * double(i + 1) / double(balls + 1), height + 2, 0}, round_to_float(number(v, "mass")));
  return scene;
}

/* --- wrecking-ball: a heavy ball on a chain that swings into a wall ----------------------------------------------- */

uint64_t wrecking_ball_bodies(const SceneValues &v)
{
  return 2 + uint64_t(whole(v, "links") + whole(v, "rows") * whole(v, "length"));
}

Scene wrecking_ball(const SceneValues &v)
{
  const int64_t links = whole(v, "links");
  const double half = 0.25, radius = 0.8, height = 2 * half * double(links) + radius + 1;
  Scene scene;
  add_ground(scene);
  const uint32_t link = add_shape(scene, capsule_shape(0.08f, round_to_float(half - 0.08))),
                 ball = add_shape(scene, sphere_shape(round_to_float(radius))),
                 brick = add_shape(scene, box_shape(0.5f, 0.25f, 0.25f));
  uint32_t before = no_body;
  Point hook{0, height, 0};
  for (int64_t i = 0; i <= links; ++i) { /* let go from the horizontal */
    const bool is_ball = i == links;
    const double reach = is_ball ? radius : half, mass = is_ball ? number(v, "mass") : 5;
    const auto index = static_cast<uint32_t>(scene.bodies.size());
    Body &body =
        add_body(scene, is_ball ? ball : link, {-2 * half * double(i) - reach, height, 0}, round_to_float(mass));
    body.orientation = {0, 0, -0.70710678f, 0.70710678f};
    connect(scene, JointType::ball, before, hook, index, {0, reach, 0});
    before = index;
    hook = {0, -half, 0};
  }
  for (int64_t row = 0; row < whole(v, "rows"); ++row)
    for (int64_t k = 0; k < whole(v, "length"); ++k) {
      const double shift = (row % 2 == 0 ? -0.15 : 0.15) - 0.5 * double(whole(v, "length") - 1);
      Body &body = add_body(scene, brick, {0.75, 0.25 + 0.5 * double(row), 1.02 * (double(k) + shift)}, 20);
      body.orientation = {0, 0.70710678f, 0, 0.70710678f};
    }
  return scene;
}

} // namespace

std::vector<BuiltInScene> joint_scenes()
{
  return {
      {"joint-grid",
       "a net of balls on ball joints that hangs from its first row",
       {{"columns", integer, 100, 1, 100000, "balls along x"},
        {"rows", integer, 100, 2, 100000, "balls along y; the first is fixed"}},
       joint_grid_bodies,
       joint_grid},
      {"hinge-chain",
       "links on hinges that swing down from the world",
       {{"n", integer, 10, 1, 100000, "links"}, {"length", real, 1, 0.01, 100, "of a link, m"}},
       number_of_links,
       hinge_chain},
      {"pendulums",
       "balls on hinges, let go at different angles",
       {{"n", integer, 8, 1, 100000, "pendulums"},
        {"length", real, 1, 0.01, 100, "from the hinge to the centre of the ball, m"},
        {"tangent", real, 1, 0, 100, "of half the angle of the last of them from the vertical"}},
       number_of_links,
       pendulums},
      {"bridge",
       "planks on hinges between two banks, with balls on them",
       {{"planks", integer, 20, 1, 100000, "planks of half a metre"},
        {"balls", integer, 5, 0, 100000, "balls that fall on them"},
        {"mass", real, 50, 0.001, 1e9, "of a ball, kg; a plank has 25"},
        {"height", real, 5, 1, 10000, "of the banks above the ground, m"}},
       bridge_bodies,
       bridge},
      {"wrecking-ball",
       "a heavy ball on a chain that swings into a wall of bricks",
       {{"links", integer, 12, 1, 10000, "links of half a metre"},
        {"mass", real, 2000, 0.001, 1e9, "of the ball, kg; a link has 5"},
        {"rows", integer, 8, 0, 1000, "rows of bricks"},
        {"length", integer, 6, 1, 1000, "bricks in a row"}},
       wrecking_ball_bodies,
       wrecking_ball},
      ragdoll_scene(),
      humanoid_scene(),
  };
}

} // namespace tandem
