/* ragdolls.cpp - see ragdolls.h.
 *
 *        ( head )            parts are capsules along y, feet are boxes
 *          chest             cone-twist joints: spine, chest, neck, shoulders, hips, ankles
 *    arm   spine   arm       hinges: elbows and knees, which bend one way only
 *         pelvis
 *        leg  leg            Each joint resists with a little friction, as muscles at rest do. Of humanoids they are
 *                            balls and hinges with springs.
 */
#include "host/catalog/ragdolls.h"

#include <algorithm>
#include <cmath>

#include <tandem/round_to_float.h>

#include "host/catalog/builders.h"

namespace tandem {

using namespace scene_builders;

namespace {

constexpr float friction = 2; /* N m */
constexpr Quat x_up{0, 0, 0.70710678f, 0.70710678f};

struct Part {
  const char *name;
  double x, y, radius, half_height; /* m: of its centre, with the soles of the feet at 0 */
};

constexpr Part parts[] = {
    {"pelvis", 0, 0.95, 0.12, 0.03},
    {"spine", 0, 1.12, 0.11, 0.03},
    {"chest", 0, 1.33, 0.13, 0.06},
    {"head", 0, 1.68, 0.10, 0.03},
    {"left upper arm", -0.24, 1.28, 0.05, 0.10},
    {"left forearm", -0.24, 0.98, 0.045, 0.11},
    {"right upper arm", 0.24, 1.28, 0.05, 0.10},
    {"right forearm", 0.24, 0.98, 0.045, 0.11},
    {"left thigh", -0.1, 0.68, 0.07, 0.14},
    {"left shin", -0.1, 0.28, 0.055, 0.14},
    {"right thigh", 0.1, 0.68, 0.07, 0.14},
    {"right shin", 0.1, 0.28, 0.055, 0.14},
    {"left foot", -0.1, 0.04, 0, 0},
    {"right foot", 0.1, 0.04, 0, 0},
};
constexpr size_t parts_of_person = std::size(parts), capsules = 12;
constexpr double foot[3] = {0.05, 0.04, 0.12}, foot_ahead = 0.06;

/* cone: rad; 0: a hinge that bends between lower and upper. */
struct Connection {
  uint32_t a, b;
  double y; /* m */
  float cone, lower, upper;
};

constexpr Connection connections[] = {
    {0, 1, 1.04, 0.4f, -0.3f, 0.3f},   {1, 2, 1.22, 0.4f, -0.3f, 0.3f}, {2, 3, 1.53, 0.6f, -0.6f, 0.6f},
    {2, 4, 1.43, 1.2f, -0.5f, 0.5f},   {4, 5, 1.13, 0, -2.4f, 0},       {2, 6, 1.43, 1.2f, -0.5f, 0.5f},
    {6, 7, 1.13, 0, -2.4f, 0},         {0, 8, 0.88, 0.9f, -0.4f, 0.4f}, {8, 9, 0.48, 0, 0, 2.4f},
    {0, 10, 0.88, 0.9f, -0.4f, 0.4f},  {10, 11, 0.48, 0, 0, 2.4f},      {9, 12, 0.08, 0.4f, -0.2f, 0.2f},
    {11, 13, 0.08, 0.4f, -0.2f, 0.2f},
};

double mass_of_capsule(const Part &part)
{
  const double r = part.radius;
  return density_of_water * M_PI * r * r * (2 * part.half_height + 4 * r / 3);
}

Point centre_of(size_t part) { return {parts[part].x, parts[part].y, part < capsules ? 0 : foot_ahead}; }

/* A turn about y, without a library's sines, which differ from one to another. */
struct Heading {
  double sine = 0, cosine = 1;

  explicit Heading(Random &random)
  {
    double x = 0, z = 0, squared = 0;
    while (squared < 0.01 || squared > 1) {
      x = random.uniform(-1, 1);
      z = random.uniform(-1, 1);
      squared = x * x + z * z;
    }
    sine = x / std::sqrt(squared);
    cosine = z / std::sqrt(squared);
  }
  Point turned(const Point &p) const { return {cosine * p[0] + sine * p[2], p[1], cosine * p[2] - sine * p[0]}; }
  Quat orientation() const
  {
    const double half_cosine = std::sqrt(0.5 * (1 + std::max(cosine, -1.0)));
    const double half_sine = std::copysign(std::sqrt(0.5 * (1 - std::min(cosine, 1.0))), sine);
    return {0, round_to_float(half_sine), 0, round_to_float(half_cosine)};
  }
};

void add_part(Scene &scene, size_t part, const Point &at, const Heading &heading)
{
  const double mass =
      part < capsules ? mass_of_capsule(parts[part]) : density_of_water * 8 * foot[0] * foot[1] * foot[2];
  const Point p = heading.turned(centre_of(part));
  Body &body = add_body(scene, static_cast<uint32_t>(1 + part), {at[0] + p[0], at[1] + p[1], at[2] + p[2]},
                        round_to_float(mass));
  body.orientation = heading.orientation();
  body.name = parts[part].name;
}

/* The frames of the joint at which two parts meet. */
Joint joint_of(const Connection &connection, uint32_t first)
{
  const Part &end = parts[connection.b];
  const double x = connection.a == 0 || connection.a == 1 || connection.a == 2 ? end.x : parts[connection.a].x;
  const auto seen_from = [&](uint32_t part) {
    const Point centre = centre_of(part);
    return Point{x - centre[0], connection.y - centre[1], -centre[2]};
  };
  Joint joint;
  joint.body_a = first + connection.a;
  joint.body_b = first + connection.b;
  joint.position_a = seen_from(connection.a);
  joint.position_b = seen_from(connection.b);
  return joint;
}

void connect_limply(Scene &scene, const Connection &connection, uint32_t first)
{
  Joint joint = joint_of(connection, first);
  joint.rotations[0] = {.lower = connection.lower, .upper = connection.upper, .friction = friction};
  joint.type = connection.cone > 0 ? JointType::cone_twist : JointType::hinge;
  if (connection.cone > 0) {
    joint.orientation_a = joint.orientation_b = x_up;
    joint.rotations[1] = {.upper = connection.cone, .friction = friction};
  }
  scene.joints.push_back(joint);
}

/* Each joint is a spring towards the pose in which the person begins. */
void connect_with_drive(Scene &scene, const Connection &connection, uint32_t first, const JointAxis &drive)
{
  Joint joint = joint_of(connection, first);
  joint.type = connection.cone > 0 ? JointType::ball : JointType::hinge;
  joint.rotations.fill(drive);
  if (joint.type == JointType::hinge) {
    joint.rotations = {drive, {}, {}};
    joint.rotations[0].lower = connection.lower;
    joint.rotations[0].upper = connection.upper;
  }
  scene.joints.push_back(joint);
}

/* Rows of people on as many storeys as asked for, each turned about the vertical at random. connect: the joints of the
 * person whose parts begin with a body. */
template <class Connect> Scene people(const SceneValues &v, int64_t storeys, const Connect &connect)
{
  const int64_t n = whole(v, "n"), side = [&] {
    int64_t smallest = 1;
    while (smallest * smallest * storeys < n) ++smallest;
    return smallest;
  }();
  const double pitch = number(v, "pitch"), height = number(v, "height");
  Random random(uint64_t(whole(v, "seed")));
  Scene scene;
  add_ground(scene);
  for (size_t part = 0; part < parts_of_person; ++part)
    add_shape(scene, part < capsules
                         ? capsule_shape(round_to_float(parts[part].radius), round_to_float(parts[part].half_height))
                         : box_shape(round_to_float(foot[0]), round_to_float(foot[1]), round_to_float(foot[2])));
  for (int64_t i = 0; i < n; ++i) {
    const int64_t within = i % (side * side);
    const Heading heading(random);
    const double middle = 0.5 * double(side - 1);
    const Point at{(double(within % side) - middle) * pitch, height + double(i / (side * side)) * 2,
                   (double(within / side) - middle) * pitch};
    const auto first = static_cast<uint32_t>(scene.bodies.size());
    for (size_t part = 0; part < parts_of_person; ++part) add_part(scene, part, at, heading);
    connect(scene, first);
  }
  return scene;
}

Scene ragdolls(const SceneValues &v)
{
  return people(v, whole(v, "storeys"), [](Scene &scene, uint32_t first) {
    for (const Connection &connection : connections) connect_limply(scene, connection, first);
  });
}

Scene humanoids(const SceneValues &v)
{
  JointAxis drive;
  drive.stiffness = round_to_float(number(v, "stiffness"));
  drive.damping = round_to_float(number(v, "damping"));
  return people(v, 1, [&](Scene &scene, uint32_t first) {
    Articulation person;
    person.root = first;
    for (const Connection &connection : connections) {
      person.joints.push_back(static_cast<uint32_t>(scene.joints.size()));
      connect_with_drive(scene, connection, first, drive);
    }
    scene.articulations.push_back(std::move(person));
  });
}

uint64_t ragdoll_bodies(const SceneValues &v) { return 1 + parts_of_person * uint64_t(whole(v, "n")); }

} // namespace

BuiltInScene ragdoll_scene()
{
  return {"ragdolls",
          "people of 14 parts on joints with limits, who fall over",
          {{"n", integer, 16, 1, 1000000, "people"},
           {"storeys", integer, 1, 1, 1000, "how many stand above each other at the start"},
           {"pitch", real, 1.2, 0.8, 100, "from one to the next, m"},
           {"height", real, 0.2, 0, 1000, "of the lowest soles above the ground, m"},
           {"seed", integer, 1, 0, 4294967295.0, "of the directions in which they look"}},
          ragdoll_bodies,
          ragdolls};
}

BuiltInScene humanoid_scene()
{
  return {"humanoid",
          "people as articulations of 14 links, whose joints are springs and keep them upright",
          {{"n", integer, 1, 1, 1000000, "people"},
           {"pitch", real, 1.2, 0.8, 100, "from one to the next, m"},
           {"height", real, 0.01, 0, 1000, "of the soles above the ground at the start, m"},
           {"stiffness", real, 2000, 0, 1e9, "of each joint, N m/rad; 0: they fall over"},
           {"damping", real, 50, 0, 1e9, "of each joint, N m s/rad"},
           {"seed", integer, 1, 0, 4294967295.0, "of the directions in which they look"}},
          ragdoll_bodies,
          humanoids};
}

} // namespace tandem
