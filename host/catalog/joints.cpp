/* joints.cpp - the scenes of joints.h, with the geometry of each at its builder. */
#include "host/catalog/joints.h"

#include <cmath>

#include <tandem/round_to_float.h>

#include "host/catalog/builders.h"

namespace tandem {

using namespace scene_builders;

namespace {

constexpr double density = 1000; /* kg/m^3 */

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
  const float mass = round_to_float(density * 4 / 3 * M_PI * radius * radius * radius);
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
  const auto mass = round_to_float(density * 8 * half * 0.2 * half * 0.5 * half);
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
    const double angle = number(v, "angle") * double(i + 1) / double(n), z = 3 * radius * double(i);
    const auto index = static_cast<uint32_t>(scene.bodies.size());
    Body &ball = add_body(scene, 0, {length * std::sin(angle), -length * std::cos(angle), z});
    ball.orientation = {0, 0, round_to_float(std::sin(0.5 * angle)), round_to_float(std::cos(0.5 * angle))};
    Joint &joint = connect(scene, JointType::hinge, no_body, {0, 0, z}, index, {0, length, 0});
    joint.orientation_a = joint.orientation_b = x_to_z;
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
        {"angle", real, 1.5, 0, 3.1, "of the last of them from the vertical, rad"}},
       number_of_links,
       pendulums},
  };
}

} // namespace tandem
