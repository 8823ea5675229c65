/* Compounds behave as the bodies they are made of, joined. */
#include <algorithm>
#include <cmath>

#include "host/runtime/interface/kernel_list.h"
#include "tests/catch.h"
#include "tests/physics/bodies.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

Child child_of(const Shape &shape, const Vector &at, const Quat &turn = {0, 0, 0, 1})
{
  Child child;
  child.shape = shape;
  child.position = vec3_of(at);
  child.orientation = turn;
  return child;
}

/* A box of eight boxes. */
Shape box_of_boxes(float half)
{
  std::vector<Child> children;
  for (int k = 0; k < 8; ++k)
    children.push_back(
        child_of(box_shape(half / 2, half / 2, half / 2),
                 {k & 1 ? half / 2 : -half / 2, k & 2 ? half / 2 : -half / 2, k & 4 ? half / 2 : -half / 2}));
  return compound_shape(std::move(children));
}

Shape dumbbell()
{
  return compound_shape({child_of(sphere_shape(0.2f), {-0.4, 0, 0}), child_of(sphere_shape(0.2f), {0.4, 0, 0}),
                         child_of(box_shape(0.3f, 0.05f, 0.05f), {0, 0, 0})});
}

} // namespace

TEST_CASE("mass, centre and inertia of a compound are those of its children together", "[physics]")
{
  const MassProperties whole = mass_properties_of(box_of_boxes(0.5f)),
                       box = mass_properties_of(box_shape(0.5f, 0.5f, 0.5f));
  CHECK(whole.mass == Approx(box.mass).epsilon(1e-12));
  CHECK(whole.inertia.xx == Approx(box.inertia.xx).epsilon(1e-12));
  CHECK(std::abs(whole.inertia.xy) < 1e-12);
  Child light = child_of(sphere_shape(1), {-1, 0, 0}), heavy = child_of(sphere_shape(1), {1, 0, 0});
  heavy.density = 3;
  CHECK(mass_properties_of(compound_shape({light, heavy})).center[0] == Approx(0.5));
}

TEST_CASE("a box of boxes rests and stacks as a box, on four points a pair", "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  for (int k = 0; k < 4; ++k) add_dynamic_body(scene, box_of_boxes(0.25f), {0, 0.25 + 0.5 * k, 0});
  World world(scene);
  run(world, 300);
  const std::vector<BodyState> states = world.bodies();
  for (size_t k = 1; k < states.size(); ++k) {
    CHECK(std::abs(states[k].position[1] - (0.25 + 0.5 * (double(k) - 1))) < 0.006 * double(k));
    CHECK(std::hypot(states[k].position[0], states[k].position[2]) < 0.002);
    CHECK(vector_of(states[k].linear_velocity).norm() < 0.005);
  }
  CHECK(world.statistics().manifolds == 4);
  CHECK(world.statistics().contacts == 16);
}

TEST_CASE("compounds in free space keep their momentum", "[physics]")
{
  Scene scene = empty_scene({0, 0, 0});
  Random random(9);
  for (int k = 0; k < 20; ++k) {
    Body &body =
        add_dynamic_body(scene, k % 2 ? dumbbell() : box_of_boxes(0.2f),
                         {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}, random.orientation());
    body.linear_velocity = vec3_of(-2 * vector_of(body.position));
  }
  World world(scene);
  const Momentum before = momentum_of(world);
  run(world, 90);
  const Momentum after = momentum_of(world);
  CHECK((after.linear - before.linear).norm() < 1e-5 * before.linear_scale);
  CHECK((after.angular - before.angular).norm() < 1e-4 * before.linear_scale);
}

/* One foot slips, the other holds: the same compound stands still or slides by which foot is down. */
TEST_CASE("each child has its own material", "[physics]")
{
  const bool slippery_down = GENERATE(true, false);
  Scene scene = empty_scene();
  scene.materials[0].friction_combine = Combine::minimum;
  const uint32_t slippery = add_material(scene, 0);
  Body &ground = add_ground(scene);
  ground.orientation = turn_about({0, 0, 1}, 0.2);
  Child foot = child_of(box_shape(0.5f, 0.05f, 0.5f), {0, -0.3, 0}),
        head = child_of(box_shape(0.5f, 0.05f, 0.5f), {0, 0.3, 0});
  head.material = slippery;
  const Shape column = compound_shape({foot, head, child_of(box_shape(0.1f, 0.3f, 0.1f), {0, 0, 0})});
  const Vector up(-std::sin(0.2), std::cos(0.2), 0);
  add_dynamic_body(scene, column, 0.35 * up, turn_about({0, 0, 1}, 0.2 + (slippery_down ? pi : 0)));
  World world(scene);
  run(world, 60);
  const double speed = vector_of(world.bodies()[1].linear_velocity).norm();
  if (slippery_down) CHECK(speed == Approx(gravity * std::sin(0.2)).epsilon(0.01));
  else CHECK(speed < 0.01);
}

TEST_CASE("each child has its own filter", "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene).filter_group = 2;
  Child solid = child_of(sphere_shape(0.2f), {0, 0.5, 0}), ghost = child_of(box_shape(0.4f, 0.4f, 0.4f), {0, 0, 0});
  ghost.filter_mask = ~2u;
  Body &body = add_dynamic_body(scene, compound_shape({solid, ghost}), {0, 1, 0}, turn_about({1, 0, 0}, pi));
  body.infinite_inertia = true;
  World world(scene);
  const double centre = vector_of(body.position).y() - 1; /* of mass, above the frame of the compound */
  run(world, 200);
  CHECK(world.bodies()[1].position[1] - centre == Approx(0.7).margin(0.01)); /* the ball stands, the box is passed */
}

TEST_CASE("a mesh can be a child", "[physics]")
{
  const Shape cube = mesh_of_box(0.3f, 0.3f, 0.3f);
  Scene scene = empty_scene();
  add_ground(scene);
  add_dynamic_body(scene,
                   compound_shape({child_of(cube, {0, 0, 0}), child_of(box_shape(0.2f, 0.2f, 0.2f), {0, 0.5, 0})}),
                   {0, 0.3, 0});
  add_dynamic_body(scene, box_shape(0.1f, 0.1f, 0.1f), {0, 1.11, 0});
  World world(scene);
  run(world, 200);
  const std::vector<BodyState> states = world.bodies();
  CHECK(std::abs(states[2].position[1] - 1.1) < 0.012);
  CHECK(vector_of(states[2].linear_velocity).norm() < 0.01);
}

namespace {

/* Capsules with their centres of mass beside their middles, each with one thing to hit: the ground, a box of its own,
 * or another capsule. The order of contacts then cannot matter. */
Scene falling_capsules()
{
  Scene scene = empty_scene();
  add_ground(scene);
  Random random(4);
  const auto add_capsule = [&](const Vector &at, const Vec3 &velocity) {
    const double u = random.uniform(0, 1);
    Body &body =
        add_dynamic_body(scene, capsule_shape(float(0.05 + 0.1 * u), float(0.1 + 0.2 * u)), at, random.orientation());
    body.shape_position[0] -= 0.03f;
    body.linear_velocity = velocity;
    body.angular_velocity = {0, float(random.uniform(-9, 9)), 3};
  };
  for (int k = 0; k < 24; ++k) {
    const double x = 4.0 * k;
    const float speed = k % 2 ? -30.0f : 0.0f;
    add_capsule({x, 0.6, 0}, {0, speed, 0});
    add_body(scene, BodyType::fixed, box_shape(0.9f, 1, 0.9f), {x, 1, 8});
    add_capsule({x, 2.6, 8}, {0, speed, 0});
    add_capsule({x, 20, 16}, {0, 0, 0});
    add_capsule({x + 0.1, 20.6, 16}, {0, speed - 2, 0});
  }
  return scene;
}

/* Each capsule becomes the only child of a compound, and the bodies keep their masses. */
Scene with_capsules_as_children(Scene scene)
{
  for (Body &body : scene.bodies)
    if (body.type == BodyType::dynamic) {
      body.inertia = inertia_of(scene.shapes[body.shape], body.mass);
      scene.shapes[body.shape] = compound_shape({child_of(scene.shapes[body.shape], {0, 0, 0})});
    }
  return scene;
}

bool launches(const World &world, Kernel kernel)
{
  const std::vector<Kernel> kernels = world.kernels();
  return std::find(kernels.begin(), kernels.end(), kernel) != kernels.end();
}

} // namespace

TEST_CASE("a compound of one capsule moves as a body of that capsule, to the bit", "[physics]")
{
  World bodies(falling_capsules()), compounds(with_capsules_as_children(falling_capsules()));
  CHECK(launches(compounds, Kernel::collide_box_capsule));
  CHECK_FALSE(launches(compounds, Kernel::collide_convex));
  uint32_t contacts = 0;
  for (int step = 0; step < 90; ++step) {
    bodies.step();
    compounds.step();
    contacts = std::max(contacts, compounds.statistics().contacts);
    REQUIRE(bodies.body_hash() == compounds.body_hash());
  }
  CHECK(contacts > 60);
}

namespace {

/* Three balls, and one that lies on them; all touch at one point each. */
Scene tripod(bool continuous)
{
  std::vector<Child> feet;
  for (int k = 0; k < 3; ++k)
    feet.push_back(child_of(sphere_shape(0.1f), {0.4 * std::cos(2 * pi * k / 3), 0, 0.4 * std::sin(2 * pi * k / 3)}));
  Scene scene = empty_scene();
  add_ground(scene);
  add_dynamic_body(scene, compound_shape(feet), {0, 0.15, 0}).continuous = continuous;
  add_dynamic_body(scene, sphere_shape(0.5f), {0, 0.9, 0});
  return scene;
}

} // namespace

/* Balls of compounds are capsules without length. */
TEST_CASE("a tripod of three balls stands on them, and a ball on it", "[physics]")
{
  World world(tripod(false));
  CHECK(launches(world, Kernel::collide_sphere_capsule));
  CHECK(launches(world, Kernel::collide_capsule_half_space));
  CHECK_FALSE(launches(world, Kernel::collide_convex));
  run(world, 300);
  const std::vector<BodyState> states = world.bodies();
  CHECK(world.statistics().contacts == 6);
  CHECK(std::abs(states[1].position[1] - 0.1) < 0.006);
  /* Its middle is sqrt(0.6^2 - 0.4^2) above theirs. */
  CHECK(std::abs(states[2].position[1] - (0.1 + std::sqrt(0.36 - 0.16))) < 0.012);
  CHECK(vector_of(states[2].linear_velocity).norm() < 0.005);
}

TEST_CASE("children of a compound that ceases to be continuous have the tests of their shapes", "[physics]")
{
  World always(tripod(false)), before(tripod(true));
  CHECK(launches(before, Kernel::collide_convex));
  before.set_continuous(before.id_of(1), false);
  for (int step = 0; step < 60; ++step) {
    always.step();
    before.step();
    REQUIRE(always.body_hash() == before.body_hash());
  }
  CHECK(launches(before, Kernel::collide_sphere_capsule));
  before.set_continuous(before.id_of(1), true);
  run(before, 60);
  CHECK(before.statistics().contacts == 6);
}

/* The two balls share a manifold, of which both points count though only balls touch in this scene. */
TEST_CASE("a ball lies still between two balls of a compound", "[physics]")
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::fixed,
           compound_shape({child_of(sphere_shape(0.2f), {-0.05, 0, 0}), child_of(sphere_shape(0.2f), {0.05, 0, 0})}),
           {0, 0, 0});
  add_dynamic_body(scene, sphere_shape(1), {0.002, std::sqrt(1.2 * 1.2 - 0.05 * 0.05), 0});
  Settings general;
  general.specialise = false;
  World world(scene), whole(scene, general);
  for (int step = 0; step < 120; ++step) {
    world.step();
    whole.step();
    REQUIRE(world.body_hash() == whole.body_hash());
  }
  CHECK(world.statistics().contacts == 2);
  CHECK(std::abs(world.bodies()[1].position[0]) < 0.004);
  CHECK(vector_of(world.bodies()[1].linear_velocity).norm() < 0.005);
}

/* A rod on a box gets a part that touches the side of the box, and so a second manifold. They are known again by
 * normals, which a world without compounds has not kept. */
TEST_CASE("a world whose first compound comes while it runs goes on as one with all features", "[physics]")
{
  Scene scene = empty_scene();
  add_body(scene, BodyType::fixed, box_shape(9, 0.5f, 1), {0, -0.5, 0});
  for (int k = 0; k < 4; ++k)
    add_dynamic_body(scene, capsule_shape(0.1f, 0.4f), {2.0 * k - 4, 0.1, 0.88 + 0.02 * k},
                     turn_about({0, 0, 1}, pi / 2));
  Settings general;
  general.specialise = false;
  World world(scene), whole(scene, general);
  const auto step_both = [&](int steps) {
    for (int step = 0; step < steps; ++step) {
      world.step();
      whole.step();
      REQUIRE(world.body_hash() == whole.body_hash());
    }
  };
  step_both(30);
  for (World *one : {&world, &whole})
    for (uint32_t body = 1; body < 5; ++body)
      one->add_shape_to(one->id_of(body), child_of(capsule_shape(0.15f, 0.2f), {-0.2, 0, 0.28 - 0.02 * body}));
  step_both(90);
  CHECK((world.features() & FEATURE_TREES) != 0);
}
