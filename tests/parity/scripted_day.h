/* scripted_day.h - a day in the life of a world, drawn from a seed: bodies come and go, are pushed, pulled, set and
 * moved. What happens before a step follows from the world and the number of the step alone, so equal worlds stay
 * equal. */
#pragma once

#include <algorithm>
#include <vector>

#include <tandem/world.h>

#include "host/base/random.h"

namespace tandem::parity {

inline Child child_at(const Shape &shape, const Vec3 &position)
{
  Child child;
  child.shape = shape;
  child.position = position;
  return child;
}

/* A yard with a fixed floor and a kinematic sweeper, and shapes for what comes. */
inline Scene yard()
{
  Scene scene;
  scene.name = "yard";
  const std::vector<Vec3> corners = {{0, 0.5f, 0}, {0.5f, -0.3f, 0.4f}, {-0.5f, -0.3f, 0.4f}, {0, -0.3f, -0.6f}};
  scene.shapes = {box_shape(12, 1, 12),
                  box_shape(3, 0.4f, 0.2f),
                  sphere_shape(0.4f),
                  box_shape(0.4f, 0.3f, 0.5f),
                  capsule_shape(0.2f, 0.4f),
                  box_shape(2, 2, 2),
                  hull_shape(corners, "a hull"),
                  half_space_shape(),
                  compound_shape({child_at(box_shape(0.5f, 0.1f, 0.1f), {0, 0.2f, 0}),
                                  child_at(sphere_shape(0.2f), {0, -0.3f, 0})})};
  scene.bodies.resize(2);
  scene.bodies[0].type = BodyType::fixed;
  scene.bodies[0].position = {0, -1, 0};
  scene.bodies[1].type = BodyType::kinematic;
  scene.bodies[1].shape = 1;
  scene.bodies[1].position = {0, 0.5, 0};
  return scene;
}

/* The same with balls and boxes alone, of which there is one each from the start: an OpenCL compiler has to build the
 * kernels of one set of features, which takes it a minute. */
inline Scene plain_yard()
{
  Scene scene = yard();
  scene.name = "plain yard";
  scene.shapes = {half_space_shape(), sphere_shape(0.7f), sphere_shape(0.4f), box_shape(0.4f, 0.3f, 0.5f)};
  scene.bodies[0].position = {0, 0, 0};
  scene.bodies.resize(4);
  scene.bodies[2].shape = 2;
  scene.bodies[2].position = {4, 0.4, 0};
  scene.bodies[3].shape = 3;
  scene.bodies[3].position = {4.3, 1.2, 0};
  return scene;
}

class ScriptedDay {
public:
  /* most: of the bodies that exist at the same time. */
  explicit ScriptedDay(uint64_t seed, uint32_t most = 60) : seed_(seed), most_(most) {}

  void operator()(World &world, uint64_t step) const
  {
    Random random(seed_ + 7919 * step);
    create_some(world, random, step);
    destroy_some(world, random);
    push_some(world, random);
    const double angle = 0.05 * static_cast<double>(step);
    const auto half = static_cast<float>(0.5 * angle);
    world.move_to(world.id_of(1), {{2 * triangle(0.01 * angle), 0.5, 0}, unit_about_y(half)});
  }

private:
  static double triangle(double x) { return x - static_cast<double>(static_cast<int64_t>(x)); }
  /* A rational parametrisation of the circle, so that no function of the C library decides a bit. */
  static Quat unit_about_y(float t)
  {
    const float bounded = t - 2.0f * static_cast<float>(static_cast<int>(t / 2.0f)) - 1.0f, n = 1 + bounded * bounded;
    return {0, 2 * bounded / n, 0, (1 - bounded * bounded) / n};
  }
  static Vec3 vector(Random &random, double size)
  {
    Vec3 v;
    for (float &x : v) x = static_cast<float>(random.uniform(-size, size));
    return v;
  }
  static Point point(Random &random)
  {
    Point p;
    for (double &x : p) x = random.uniform(-8, 8);
    p[1] = 1 + 0.4 * (p[1] + 8);
    return p;
  }

  void create_some(World &world, Random &random, uint64_t step) const
  {
    const bool plain = world.scene().shapes.size() == 4;
    std::vector<Body> bodies(static_cast<size_t>(random.uniform(0, 4)));
    if (world.body_count() >= most_) bodies.clear();
    for (Body &body : bodies) {
      body.shape = 2 + static_cast<uint32_t>(random.uniform(0, plain ? 2 : 3));
      body.position = point(random);
      body.linear_velocity = vector(random, 2);
      body.angular_velocity = vector(random, 3);
    }
    if (plain) {
      world.create_bodies(bodies);
      return;
    }
    if (step == 20) bodies.push_back(wall());
    if (step == 25 || step == 45) bodies.push_back(block(random));
    if (step >= 30 && !bodies.empty()) {
      bodies.front().shape = step < 36 ? 6 : 8; /* hulls and compounds are new kinds of shapes */
      take_mass_properties(world.scene(), bodies.front());
    }
    world.create_bodies(bodies);
  }
  static Body wall()
  {
    Body body;
    body.type = BodyType::fixed;
    body.shape = 7;
    body.position = {0, 0, 10};
    body.orientation = {-0.70710678f, 0, 0, 0.70710678f};
    return body;
  }
  static Body block(Random &random)
  {
    Body body;
    body.shape = 5;
    body.mass = 20;
    body.position = point(random);
    return body;
  }

  static BodyId any_of(const std::vector<BodyId> &ids, Random &random)
  {
    return ids[2 + static_cast<size_t>(random.uniform(0, static_cast<double>(ids.size() - 2)))];
  }
  void destroy_some(World &world, Random &random) const
  {
    const std::vector<BodyId> ids = world.body_ids();
    std::vector<BodyId> doomed;
    const double most = ids.size() > most_ / 2 ? 5 : 2;
    for (size_t k = static_cast<size_t>(random.uniform(0, most)); k > 0 && ids.size() > 2; --k)
      if (const BodyId id = any_of(ids, random); std::find(doomed.begin(), doomed.end(), id) == doomed.end())
        doomed.push_back(id);
    world.destroy_bodies(doomed);
  }
  static void push_some(World &world, Random &random)
  {
    const std::vector<BodyId> ids = world.body_ids();
    for (int k = 0; k < 6 && ids.size() > 2; ++k) {
      const BodyId id = any_of(ids, random);
      const auto what = static_cast<int>(random.uniform(0, 6));
      if (what == 0) world.add_impulse(id, {vector(random, 2), {}, point(random)});
      if (what == 1) world.add_impulse(id, {vector(random, 2), vector(random, 1)});
      if (what == 2) world.add_force(id, {vector(random, 30), vector(random, 5)});
      if (what == 3) world.add_force(id, {vector(random, 30), {}, point(random)});
      if (what == 4) world.set_velocity(id, {vector(random, 3), vector(random, 3)});
      if (what == 5) world.set_state(id, {point(random), {0, 0.6f, 0, 0.8f}, vector(random, 2), vector(random, 2)});
    }
  }

  uint64_t seed_;
  uint32_t most_;
};

} // namespace tandem::parity
