/* Bodies that miss keep their motion: bodies that fly by others without touching them keep their kinetic energy, with
 * every solver.
 *
 * The lower bodies lie under the plane y = 0 and reach up to it. The flying bodies stay above y = clearance, because
 * they only turn about the vertical. None touches, however fast it is and wherever it is when a step starts.
 */
#include <tuple>

#include "tests/catch.h"
#include "tests/physics/bodies.h"
#include "tests/physics/free_fall.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

/* How far a shape that stands as `turn` says reaches along a direction, from its body's centre. */
double support(const Shape &shape, const Matrix &axes, const Vector &direction)
{
  const Vector own = axes.transpose() * direction;
  const double x = shape.size[0], y = shape.size[1], z = shape.size[2];
  switch (shape.type) {
  case ShapeType::sphere: return x;
  case ShapeType::capsule: return std::max(own.y() * y + z, -own.y() * y + x);
  case ShapeType::hull: break;
  default: return std::abs(own.x()) * x + std::abs(own.y()) * y + std::abs(own.z()) * z;
  }
  double farthest = -1e9;
  for (const Vec3 &vertex : shape.hull->vertices) farthest = std::max(farthest, own.dot(vector_of(vertex)));
  return farthest;
}

Shape roof(float half_length, float half_width, float height)
{
  const float x = half_width, z = half_length, y = height;
  const std::vector<Vec3> corners = {{-x, -y, -z}, {x, -y, -z}, {x, -y, z}, {-x, -y, z}, {0, 0, -z}, {0, 0, z}};
  const std::vector<uint32_t> triangles = {0, 1, 2, 0, 2, 3, 0, 5, 4, 0, 3, 5, 1, 4, 5, 1, 5, 2, 0, 4, 1, 3, 2, 5};
  return mesh_shape(corners, triangles, "roof");
}

enum class Obstacle { face, edge, corner, thin, mesh_edge, mesh_box, compound, flat_rotor, upright_rotor };
constexpr Obstacle all_obstacles[] = {Obstacle::face,     Obstacle::edge,       Obstacle::corner,
                                      Obstacle::thin,     Obstacle::mesh_edge,  Obstacle::mesh_box,
                                      Obstacle::compound, Obstacle::flat_rotor, Obstacle::upright_rotor};

Child child(const Shape &shape, const Vec3 &position)
{
  Child c;
  c.shape = shape;
  c.position = position;
  return c;
}

/* Its highest point is at y = 0; yaw: about the vertical. */
void add_obstacle(Scene &scene, Obstacle kind, double z, double yaw)
{
  const Eigen::Quaterniond about(Eigen::AngleAxisd(yaw, Vector::UnitY()));
  const auto stand = [&](const Shape &shape, double height, const Vector &axis = Vector::UnitX(),
                         double angle = 0) -> Body & {
    const Eigen::Quaterniond turn = about * Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized()));
    Body &body = add_body(scene, BodyType::fixed, shape, {0, height, z});
    body.orientation = {float(turn.x()), float(turn.y()), float(turn.z()), float(turn.w())};
    if (shape.type == ShapeType::box) body.position[1] = -support(shape, axes_of(body.orientation), Vector::UnitY());
    return body;
  };
  const auto rotate = [&](const Shape &shape, double height, const Vector &spin) {
    Body &body = stand(shape, height);
    body.position[1] = height;
    body.type = BodyType::kinematic;
    body.angular_velocity = vec3_of(about * spin);
  };
  switch (kind) {
  case Obstacle::face: stand(box_shape(0.3f, 0.2f, 0.25f), 0); break;
  case Obstacle::edge: stand(box_shape(0.3f, 0.2f, 0.5f), 0, Vector::UnitZ(), 0.6); break;
  case Obstacle::corner: stand(box_shape(0.3f, 0.2f, 0.25f), 0, Vector(1, 0.3, -0.4), 0.8); break;
  case Obstacle::thin: stand(box_shape(0.002f, 0.5f, 0.5f), 0); break;
  case Obstacle::mesh_edge: stand(roof(0.5f, 0.2f, 0.4f), 0); break;
  case Obstacle::mesh_box: stand(mesh_of_box(0.3f, 0.2f, 0.25f), -0.2f); break;
  case Obstacle::compound:
    stand(compound_shape({child(box_shape(0.2f, 0.2f, 0.3f), {0.21f, -0.2f, 0}),
                          child(sphere_shape(0.2f), {-0.2f, -0.2f, 0}),
                          child(cylinder_shape(0.1f, 0.3f), {0, -0.31f, 0})}),
          0);
    break;
  case Obstacle::flat_rotor: rotate(box_shape(0.5f, 0.01f, 0.05f), -0.01, {0, 100, 0}); break;
  case Obstacle::upright_rotor: rotate(box_shape(0.5f, 0.03f, 0.05f), -std::hypot(0.5f, 0.03f), {0, 0, 60}); break;
  }
}

Shape mover(Random &random, int kind)
{
  const float size = float(random.uniform(0.03, 0.15));
  switch (kind) {
  case 0: return sphere_shape(size);
  case 1: return box_shape(size, 0.6f * size, 0.4f * size);
  case 2: return capsule_shape(0.4f * size, size);
  default: return random_hull_shape(random, 12, size);
  }
}

constexpr double lane_width = 4; /* m, between those that fly */

Scene bouncy_scene(const Vec3 &gravity, float restitution)
{
  Scene scene = empty_scene(gravity);
  scene.materials[0].restitution = restitution;
  return scene;
}

/* One lane for every kind of mover and phase: each flies by an obstacle of its own. */
Scene flights(Obstacle obstacle, double clearance, double speed, uint64_t seed, bool continuous = false)
{
  Random random(seed);
  Scene scene = bouncy_scene({0, 0, 0}, 0.3f);
  for (int lane = 0; lane < 24; ++lane) {
    const double z = lane_width * lane;
    add_obstacle(scene, obstacle, z, random.uniform(-0.7, 0.7));
    const Shape shape = mover(random, lane % 4);
    Body &body = add_dynamic_body(scene, shape, {0, 0, 0}, any_turn(random));
    const Vector down = -Vector::UnitY(), middle = axes_of(body.orientation) * vector_of(body.shape_position);
    const Matrix shape_axes = axes_of(body.orientation) * axes_of(body.shape_orientation);
    const double below = support(shape, shape_axes, down) + middle.dot(down);
    body.position = {-random.uniform(0.8, 0.8 + speed / 60), below + clearance, z + random.uniform(-0.2, 0.2)};
    body.linear_velocity = {float(speed), 0, 0};
    body.angular_velocity = {0, float(random.below(2) ? random.uniform(-100, 100) : 0), 0};
    if (shape.type != ShapeType::sphere)
      body.inertia = {0.001f, 0.001f, 0.001f}; /* so that it keeps turning about the vertical */
    body.continuous = continuous;
  }
  return scene;
}

/* Cubes that glide over obstacles, face to face, or fall along their sides. They start before the edge and end beyond
 * it. */
Scene glides(uint64_t seed, int lanes)
{
  Random random(seed);
  Scene scene = bouncy_scene({0, 0, 0}, 0.3f);
  for (int lane = 0; lane < lanes; ++lane) {
    const float half = lane % 2 ? 0.5f : 2, small = 0.4f * half;
    const double z = 3 * lane_width * lane, clearance = logarithmic(random, 0.0005, 0.003),
                 speed = logarithmic(random, 0.05, 0.5);
    const Shape obstacles[] = {box_shape(half, half, half), mesh_of_box(half, half, half),
                               hull_of_box(half, half, half)};
    const Shape movers[] = {box_shape(small, small, small), hull_of_box(small, small, small)};
    add_body(scene, BodyType::fixed, obstacles[lane % 3], {0, 0, z});
    const bool falls = random.below(2) == 1;
    const double before = half + small + 0.02 * speed, beside = half + small + clearance;
    const Vector start = falls ? Vector(-beside, before, z) : Vector(-before, beside, z);
    Body &body = add_dynamic_body(scene, movers[random.below(2)], start);
    body.linear_velocity = falls ? Vec3{0, float(-speed), 0} : Vec3{float(speed), 0, 0};
  }
  return scene;
}

/* Balls that fly straight past balls which turn in place: the surface moves along itself, and nothing meets it. */
Scene past_turning_balls(uint64_t seed, double step, const Vec3 &gravity = {0, 0, 0})
{
  Random random(seed);
  Scene scene = bouncy_scene(gravity, 0.3f);
  for (int lane = 0; lane < 200; ++lane) {
    const double z = 3 * lane_width * lane, standing = logarithmic(random, 0.05, 2),
                 flying = logarithmic(random, 0.05, 2);
    const double speed = logarithmic(random, 1, 300), clearance = logarithmic(random, 0.001, 0.02);
    Body &ball = add_body(scene, BodyType::kinematic, sphere_shape(float(standing)), {0, 0, z});
    const double turning = logarithmic(random, 0.3, 40) * (lane % 4 < 2 ? 1 : -1);
    ball.angular_velocity = {0, float(0.5 * turning), float(0.9 * turning)};
    const double before = standing + flying + random.uniform(0, 1) + speed * step * random.uniform(0, 3);
    Body &body = add_dynamic_body(scene, sphere_shape(float(flying)), {standing + flying + clearance, before, z});
    body.linear_velocity = {0, float(-speed), 0};
    if (lane % 2) body.angular_velocity = vec3_of(50 * direction(random));
  }
  return scene;
}

/* The largest share of its speed by which a moving body has changed its velocity. */
double largest_deviation(const Scene &scene, const Settings &settings, double seconds)
{
  World world(scene, settings, {"tbb", {}});
  run(world, int(seconds / double(settings.step)));
  double largest = 0;
  const std::vector<BodyState> after = world.bodies();
  for (size_t i = 0; i < after.size(); ++i) {
    const Vector before = vector_of(scene.bodies[i].linear_velocity);
    if (scene.bodies[i].type == BodyType::dynamic)
      largest = std::max(largest, (vector_of(after[i].linear_velocity) - before).norm() / before.norm());
  }
  return largest;
}

/* The largest share of its kinetic energy that a moving body has lost or won. */
double largest_change(const Scene &scene, const Settings &settings, double speed)
{
  World world(scene, settings, {"tbb", {}});
  const int steps = int(std::ceil(60 * 2.0 / speed)) + 3;
  const std::vector<BodyState> before = world.bodies();
  run(world, steps);
  const std::vector<BodyState> after = world.bodies();
  double largest = 0;
  for (size_t i = 0; i < after.size(); ++i) {
    if (scene.bodies[i].type != BodyType::dynamic) continue;
    const auto energy = [&](const BodyState &s) {
      return 0.5 * double(scene.bodies[i].mass) * vector_of(s.linear_velocity).squaredNorm() +
             0.5 * vector_of(s.angular_velocity).dot(spin_momentum(scene, scene.bodies[i], s));
    };
    REQUIRE(after[i].position[0] > before[i].position[0] + 0.5 * speed * steps / 60);
    largest = std::max(largest, std::abs(energy(after[i]) / energy(before[i]) - 1));
  }
  return largest;
}

/* Bodies without spin fall straight down beside boxes, hulls and meshes of boxes. */
Scene falls(uint64_t seed, double step)
{
  Random random(seed);
  Scene scene = bouncy_scene({0, -10, 0}, 0.3f);
  const float half = 0.5f, small = 0.05f;
  const Shape blocks[] = {box_shape(half, half, half), hull_of_box(half, half, half), mesh_of_box(half, half, half)};
  const Shape movers[] = {sphere_shape(small), box_shape(small, small, small), capsule_shape(small, 2 * small),
                          hull_of_box(small, small, small)};
  for (int lane = 0; lane < 240; ++lane) {
    const double z = lane_width * lane, speed = logarithmic(random, 1, 30);
    const double height = 0.17 + random.uniform(0, 1) * speed * step, beside = 0.55 + logarithmic(random, 0.001, 0.02);
    add_body(scene, BodyType::fixed, blocks[lane % 3], {0, 0, z});
    Body &body = add_body(scene, BodyType::dynamic, movers[lane / 3 % 4], {beside, 0.5 + height, z});
    body.linear_velocity = {0, float(-speed), 0};
  }
  return scene;
}

/* A body spins beside another that is free, too, and slides past it: the sphere around the one never touches the
 * other. */
Scene spinners(uint64_t seed)
{
  Random random(seed);
  Scene scene = bouncy_scene({0, 0, 0}, 0.5f);
  for (int lane = 0; lane < 96; ++lane) {
    const double z = 10.0 * lane;
    const float size = float(logarithmic(random, 0.03, 0.5)), thin = size * float(random.uniform(0.05, 0.3));
    const Shape shapes[] = {box_shape(size, thin, thin), hull_of_box(size, thin, thin), capsule_shape(thin, size)};
    const bool is_wall = random.uniform(0, 1) < 0.5;
    const double reach = std::hypot(size, thin * std::sqrt(2)) + thin,
                 x = (is_wall ? 0.1 : 0.2) + reach + logarithmic(random, 0.001, 0.02);
    add_dynamic_body(scene, is_wall ? box_shape(0.1f, 1, 1) : sphere_shape(0.2f), {0, 0, z});
    Body &body = add_dynamic_body(scene, shapes[lane % 3], {x, 0, z}, any_turn(random));
    body.angular_velocity = vec3_of(direction(random) * logarithmic(random, 20, 400));
    body.linear_velocity = {0, float(random.uniform(-1, 1) * logarithmic(random, 0.1, 30)), 0};
  }
  return scene;
}

/* Balls fly by boxes that something turns, farther off than these reach. */
Scene past_turning_boxes(uint64_t seed)
{
  Random random(seed);
  Scene scene = bouncy_scene({0, 0, 0}, 0.5f);
  for (int lane = 0; lane < 400; ++lane) {
    const double z = 10.0 * lane;
    Vec3 size;
    for (float &half : size) half = float(logarithmic(random, 0.02, 0.5));
    Body &box = add_body(scene, BodyType::kinematic, box_shape(size[0], size[1], size[2]), {0, 0, z});
    box.orientation = any_turn(random);
    box.angular_velocity = vec3_of(direction(random) * logarithmic(random, 1, 30));
    const double radius = logarithmic(random, 0.02, 0.3), speed = logarithmic(random, 1, 300);
    const double beside = vector_of(size).norm() + radius + logarithmic(random, 0.001, 0.1);
    const double x = -random.uniform(0, 1) * speed / 60;
    Body &ball = add_dynamic_body(scene, sphere_shape(float(radius)), {x, beside, z});
    ball.linear_velocity = {float(speed), 0, 0};
  }
  return scene;
}

/* Balls that spin fly by round bodies that spin, too, about their axes. All can be pushed, so the arms of what is
 * between them follow half of what they slide, and turn with them. */
Scene past_round_spinners(uint64_t seed, double step)
{
  Random random(seed);
  Scene scene = bouncy_scene({0, 0, 0}, 0.5f);
  for (int lane = 0; lane < 300; ++lane) {
    const double z = 20.0 * lane, around = logarithmic(random, 0.1, 2), height = around * random.uniform(0.5, 2),
                 radius = logarithmic(random, 0.05, 1);
    const Shape shapes[] = {sphere_shape(float(around)), cylinder_shape(float(around), float(height)),
                            capsule_shape(float(around), float(height))};
    Body &round = add_dynamic_body(scene, shapes[lane % 3], {0, 0, z}, {0, 0, 0, 1}, 1000);
    round.angular_velocity = {0, float(logarithmic(random, 0.3, 30)), 0};
    const double speed = logarithmic(random, 1, 300),
                 start = speed * step * random.uniform(0, 3) + random.uniform(0, 1);
    const double y = lane % 3 == 0 ? 0 : 0.9 * height * random.uniform(-1, 1),
                 beside = around + radius + logarithmic(random, 1e-3, 2e-2);
    Body &ball = add_dynamic_body(scene, sphere_shape(float(radius)), {-start - around - radius, y, z + beside});
    ball.linear_velocity = {float(speed), 0, 0};
    ball.angular_velocity = vec3_of(direction(random) * 30.0);
  }
  return scene;
}

/* A ball flies past one that spins about the axis which turns the plane between them, met early and late in a step. */
Scene past_at_every_moment(bool driven, double spin, double speed, double clearance, double step)
{
  constexpr double standing = 1, flying = 0.5;
  Scene scene = bouncy_scene({0, 0, 0}, 0);
  for (int lane = 0; lane < 28; ++lane) {
    const double z = lane_width * lane, moment = 0.02 + 0.07 * (lane / 2), before = speed * step * (1 + moment);
    Body &ball = driven ? add_body(scene, BodyType::kinematic, sphere_shape(standing), {0, 0, z})
                        : add_dynamic_body(scene, sphere_shape(standing), {0, 0, z}, {0, 0, 0, 1}, 1000);
    ball.angular_velocity = {0, 0, float(lane % 2 ? spin : -spin)};
    Body &body = add_dynamic_body(scene, sphere_shape(flying), {-before, standing + flying + clearance, z});
    body.linear_velocity = {float(speed), 0, 0};
  }
  return scene;
}

} // namespace

TEST_CASE("what misses goes on while it falls, in every solver", "[physics]")
{
  const Solver solver = GENERATE(from_range(choices<Solver>()));
  for (uint64_t seed : {1, 2, 3})
    for (double step : {1.0 / 60, 1.0 / 30}) {
      CAPTURE(solver, seed, step);
      CHECK(farthest_from_free_fall(falls(seed, step), settings_for(solver), step, 2) < 5e-4);
    }
}

TEST_CASE("what misses goes on: bodies that spin beside free ones, and past what turns", "[physics]")
{
  const Solver solver = GENERATE(from_range(choices<Solver>()));
  for (uint64_t seed : {1, 2, 3}) {
    CAPTURE(solver, seed);
    Settings coarse = settings_for(solver);
    coarse.substeps = 1;
    CHECK(farthest_from_free_fall(spinners(seed), settings_for(solver), 1.0 / 60, 30) < 5e-4);
    CHECK(farthest_from_free_fall(spinners(seed), coarse, 1.0 / 30, 30) < 5e-4);
    CHECK(farthest_from_free_fall(past_turning_boxes(seed), settings_for(solver), 1.0 / 60, 4) < 5e-4);
  }
}

TEST_CASE("what misses goes on: energy is kept beside faces, edges, corners, meshes, compounds and rotors", "[physics]")
{
  for (Obstacle obstacle : all_obstacles)
    for (double clearance : {0.001, 0.01, 0.02})
      for (double speed : {1.0, 5.0, 30.0, 100.0, 300.0}) {
        CAPTURE(int(obstacle), clearance, speed);
        CHECK(largest_change(flights(obstacle, clearance, speed, 7), {}, speed) < 1e-3);
      }
}

/* A step brings them nearer by less than the slop, as it does what lies and jitters. */
TEST_CASE("what misses goes on: slow cubes, face to face with what they pass", "[physics]")
{
  for (double step : {1.0 / 60, 1.0 / 240}) {
    CAPTURE(step);
    CHECK(largest_deviation(glides(3, 300), settings_with(step), 0.25) < 1e-3);
  }
}

TEST_CASE("what misses goes on: balls past balls that turn in place, in every solver", "[physics]")
{
  const Solver solver = GENERATE(from_range(choices<Solver>()));
  for (double step : {1.0 / 30, 1.0 / 60, 1.0 / 240}) {
    Settings settings = settings_for(solver);
    settings.step = float(step);
    CAPTURE(solver, step);
    CHECK(largest_deviation(past_turning_balls(7, step), settings, 6.5 * step) < 1e-3);
    CHECK(farthest_from_free_fall(past_turning_balls(7, step, {0, -10, 0}), settings, step, 6) < 5e-4);
  }
}

TEST_CASE("what misses goes on: balls past balls that spin, at every moment of a step, in every solver", "[physics]")
{
  const Solver solver = GENERATE(from_range(choices<Solver>()));
  for (const auto &[driven, spin, speed, clearance, hertz] :
       {std::tuple(true, 2.0, 100.0, 0.005, 60), std::tuple(false, 20.0, 100.0, 0.005, 60),
        std::tuple(true, 150.0, 30.0, 0.01, 60), std::tuple(false, 150.0, 30.0, 0.01, 60),
        std::tuple(false, 30.0, 10.0, 0.001, 60), std::tuple(true, 5.0, 10.0, 0.001, 60),
        std::tuple(false, 10.0, 3.0, 0.002, 60), std::tuple(false, 30.0, 300.0, 0.01, 240)}) {
    CAPTURE(solver, driven, spin, speed, clearance, hertz);
    CHECK(farthest_from_free_fall(past_at_every_moment(driven, spin, speed, clearance, 1.0 / hertz),
                                  settings_for(solver), 1.0 / hertz, 4) < 5e-4);
  }
}

TEST_CASE("what misses goes on: balls that spin past round bodies that spin, all free, in every solver", "[physics]")
{
  const Solver solver = GENERATE(from_range(choices<Solver>()));
  for (double step : {1.0 / 60, 1.0 / 240}) {
    CAPTURE(solver, step);
    CHECK(farthest_from_free_fall(past_round_spinners(7, step), settings_for(solver), step, 12) < 5e-4);
  }
}

TEST_CASE("what misses goes on in every solver, and with continuous collision", "[physics]")
{
  const Solver solver = GENERATE(from_range(choices<Solver>()));
  for (Obstacle obstacle : all_obstacles)
    for (double speed : {5.0, 100.0}) {
      CAPTURE(solver, int(obstacle), speed);
      CHECK(largest_change(flights(obstacle, 0.001, speed, 3), settings_for(solver), speed) < 1e-3);
      CHECK(largest_change(flights(obstacle, 0.001, speed, 4, true), settings_for(solver), speed) < 1e-3);
    }
}
