/* Articulations give the serial backend's bits on every backend, in batches of worlds, and from every state that was
 * kept or written down. */
#include "shared/counts.h"
#include "tests/host/runtime/opencl/pocl.h"
#include "tests/host/world/worlds.h"
#include "tests/parity/articulations.h"

namespace tandem::parity {
namespace {

using namespace physics_tests;
using tests::BatchBesideWorlds;

Settings watched()
{
  Settings settings;
  settings.events = settings.check = true;
  return settings;
}

uint64_t hash_of_trees(const Scene &scene, int steps, const Settings &settings, const Placement &placement)
{
  World world(scene, settings, placement);
  run(world, steps);
  return world.state_hash();
}

/* A chain of links that lie on the ground, with a body far away, and a stone that does not move above the chain. */
Scene lone_chain(uint32_t links, BodyType far = BodyType::fixed)
{
  Scene scene = tree_crowd(1, 0, links);
  add_body(scene, far, sphere_shape(0.1f), {1000, 1000, 0});
  add_body(scene, BodyType::fixed, sphere_shape(0.1f), {0.42 * 5 - 2, 0.6, -1.5});
  return scene;
}

/* Beside the scene, a slab with so many boxes on it that its contacts need more colours than there are; only the first
 * `boxes` lie on it. */
Scene beside_loaded_slab(Scene scene, uint32_t boxes)
{
  add_body(scene, BodyType::dynamic, box_shape(6, 0.25f, 6), {40, 0.25, 0}).mass = 20;
  for (uint32_t k = 0; k < 81; ++k)
    add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.2f, 0.2f),
             {36.0 + k % 9, k < boxes ? 0.7 : 40.0, -4.0 + k / 9});
  for (Joint &joint : scene.joints) joint.break_force = JointAxis::unlimited;
  return scene;
}

uint32_t add_link_of_row(Scene &scene, uint32_t row, uint32_t link)
{
  add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.1f, 0.1f), {0.5 * link, 0.1, 0.7 * row});
  return uint32_t(scene.bodies.size() - 1);
}

void require_equal_links(World &world, World &other, uint32_t links)
{
  const std::vector<BodyState> one = world.bodies(), two = other.bodies();
  for (uint32_t body = 0; body <= links; ++body) {
    INFO("body " << body);
    REQUIRE(one[body].position == two[body].position);
    REQUIRE(one[body].linear_velocity == two[body].linear_velocity);
    REQUIRE(one[body].angular_velocity == two[body].angular_velocity);
  }
}

} // namespace

TEST_CASE("parity on CPU: articulations in a heap, held and free, past the last colour")
{
  require_parity(tree_crowd(), cpu_backends(), 25, watched());
  Scene bouncing = tree_crowd(2, 8, 0);
  bouncing.materials[0].restitution = 0.6f;
  require_parity(bouncing, cpu_backends(), 40, watched());
  require_parity("humanoid:n=4,stiffness=0,height=0.3", cpu_backends(), 40);
  Settings in_sequence;
  in_sequence.batching = Batching::sequential;
  require_parity(tree_crowd(3, 6, 0), cpu_backends(), 10, in_sequence);
}

/* Of nine trees beside each other some motors are fast enough to take the other link past its stop in one pass. */
TEST_CASE("parity on CPU: stops that the motor of another joint brings into reach", "[articulations]")
{
  Scene scene = empty_scene({0, 0, 0});
  for (uint32_t tree = 0; tree < 18; ++tree) { /* the latter half has the motor beyond the stops */
    const Point at{0, 0, 2.0 * tree};
    for (int k = 0; k < 2; ++k) add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.05f, 0.05f), at);
    const Vector center = vector_of(at);
    const JointAxis motor = {.target_velocity = 150.0f * float(tree % 4), .motor = true},
                    stops = {.lower = -0.5f, .upper = 0.5f};
    connect(scene, JointType::hinge, no_body, 2 * tree, center, Vector::UnitZ()).rotations[0] =
        tree < 9 ? motor : stops;
    connect(scene, JointType::hinge, 2 * tree, 2 * tree + 1, center, Vector::UnitZ()).rotations[0] =
        tree < 9 ? stops : motor;
    scene.joints.back().collide = false;
    Articulation articulation;
    articulation.joints = {2 * tree, 2 * tree + 1};
    scene.articulations.push_back(articulation);
  }
  require_parity(scene, cpu_backends(), 12);
  World world(scene, {}, {"serial", {}, false});
  world.step();
  for (uint32_t tree = 0; tree < 9; ++tree) {
    const BodyState driven = world.bodies()[2 * tree], carried = world.bodies()[2 * tree + 1];
    CHECK(double(carried.angular_velocity[2]) >= 0.9 * double(driven.angular_velocity[2]));
  }
}

TEST_CASE("parity on CPU: a tree that alone moves, below the last colour and past it")
{
  for (const uint32_t links : {40u, 75u}) require_parity(lone_chain(links), cpu_backends(), 25, watched());
  require_parity("humanoid:n=1,stiffness=0,height=0.3", cpu_backends(), 60);
}

TEST_CASE("a tree that alone moves has the bits that it has while another body moves far away")
{
  for (const uint32_t links : {40u, 75u}) {
    World alone(lone_chain(links), {}, {"serial", {}, false});
    World beside(lone_chain(links, BodyType::dynamic), {}, {"serial", {}, false});
    run(alone, 40);
    run(beside, 40);
    CHECK(alone.launches() < beside.launches());
    require_equal_links(alone, beside, links);
  }
}

TEST_CASE("contacts that a tree has for itself have the bits that they have in launches by colour")
{
  constexpr uint32_t links = 40;
  const auto beside_one_that_hovers = [](BodyType type) {
    Scene scene = tree_crowd(1, 0, links);
    for (Body &body : scene.bodies)
      if (body.type == BodyType::dynamic) body.position[1] = 0.1;
    Body &hovering = add_body(scene, type, sphere_shape(0.1f), {0.42 * 5 - 2, 0.31, -1.5}); /* 1 cm above a link */
    hovering.gravity_factor = 0;
    return scene;
  };
  World own(beside_one_that_hovers(BodyType::fixed)), mixed(beside_one_that_hovers(BodyType::dynamic));
  for (World *world : {&own, &mixed}) {
    for (int step = 0; step < 40; ++step) {
      world->add_impulse(world->body_ids()[1 + step % links], {{0.05f, 0, 0.02f}});
      world->step();
    }
    CHECK(world->statistics().manifolds > links); /* the hovering one has a contact, too */
    CHECK(world->bodies().back().linear_velocity == Vec3{0, 0, 0});
  }
  require_equal_links(own, mixed, links);
}

TEST_CASE("a body that comes to move beside a tree that alone moved meets it as if others had always moved")
{
  constexpr uint32_t links = 20;
  for (const bool created : {false, true}) {
    World first_alone(lone_chain(links), {}, {"serial", {}, false}),
        never_alone(lone_chain(links, BodyType::dynamic), {}, {"tbb:threads=2", {}, false});
    for (World *world : {&first_alone, &never_alone}) {
      run(*world, 10);
      Body stone = world->scene().bodies.back();
      stone.type = BodyType::dynamic;
      stone.position[0] += 0.84; /* above another link */
      if (created) world->create_body(stone);
      else world->set_type(world->body_ids().back(), BodyType::dynamic);
      run(*world, 60);
      CHECK(world->bodies().back().position[1] > 0.25f); /* on the chain, whose links are 0.2 m high */
      CHECK(world->bodies().back().position[1] < 0.5f);
    }
    require_equal_links(first_alone, never_alone, links);
  }
}

TEST_CASE("parity on CPU: joints that hold links, whose trees have loops and hang on each other")
{
  for (const uint64_t seed : {1, 2}) require_parity(joined_trees(seed), cpu_backends(), 25, watched());
  Scene hub = tree_crowd(1, 4, 0); /* past the last colour */
  for (uint32_t k = 0; k < 70; ++k) {
    const auto body = uint32_t(hub.bodies.size());
    add_body(hub, BodyType::dynamic, sphere_shape(0.05f), {0.02 * k, 1.2, 0.1}).mass = 0.1f;
    const JointType type = k % 3 == 0 ? JointType::ball : k % 3 == 1 ? JointType::hinge : JointType::distance;
    connect(hub, type, hub.articulations[0].root, body, {0.02 * k, 1.2, 0.1}).directions[0].upper = 0.01f;
    if (type != JointType::distance) hub.joints.back().directions[0] = {};
  }
  require_parity(hub, cpu_backends(), 10, watched());
}

TEST_CASE("parity on CPU: coupled joints of articulations, alone and with couplings of bodies", "[articulations]")
{
  const Scene coupled = coupled_trees(2);
  REQUIRE(coupled.couplings.size() > 5);
  require_parity(coupled, cpu_backends(), 20, watched());
  Scene both = coupled_trees(3, 6);
  for (int k = 0; k < 2; ++k) {
    add_body(both, BodyType::dynamic, box_shape(0.1f, 0.1f, 0.1f), {5.0 + k, 3, 0});
    connect(both, JointType::hinge, no_body, uint32_t(both.bodies.size() - 1), {5.0 + k, 3.2, 0});
  }
  Coupling &gear = both.couplings.emplace_back();
  gear.joint_a = uint32_t(both.joints.size() - 2);
  gear.joint_b = uint32_t(both.joints.size() - 1);
  gear.teeth_a = 3, gear.teeth_b = 5;
  require_parity(both, cpu_backends(), 20, watched());
}

/* Of 24 trees of one shape beside each other some have fallen asleep while others are driven. */
TEST_CASE("parity on CPU: trees of one shape of which some sleep", "[articulations]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  for (uint32_t tree = 0; tree < 24; ++tree) {
    Articulation articulation;
    articulation.root = add_link_of_row(scene, tree, 0);
    for (uint32_t link = 1; link < 4; ++link) {
      const uint32_t body = add_link_of_row(scene, tree, link);
      Joint &joint = connect(scene, JointType::hinge, body - 1, body, {0.5 * link - 0.25, 0.1, 0.7 * tree});
      if (tree % 3 == 1) joint.rotations[0] = {.target_velocity = 1, .motor = true, .max_force = 3};
      articulation.joints.push_back(uint32_t(scene.joints.size() - 1));
    }
    scene.articulations.push_back(articulation);
  }
  Random random(7);
  couple_trees(scene, random);
  Settings settings = watched();
  settings.sleeping = true;
  World world(scene, settings, {"serial", {}, false});
  run(world, 150);
  const uint32_t asleep = world.statistics().asleep;
  CHECK((asleep >= 40 && asleep <= 80)); /* of 96 links */
  require_parity(scene, {"serial", "tbb:threads=2,lanes=8"}, 150, settings);
}

Settings with_forces(Settings settings)
{
  settings.tree_joint_forces = true;
  return settings;
}

TEST_CASE("parity on CPU: forces of the joints of articulations, with contacts, bounces, loops and couplings",
          "[articulations]")
{
  Scene bouncing = tree_crowd(8, 8, 70);
  bouncing.materials[0].restitution = 0.6f;
  require_parity(bouncing, cpu_backends(), 25, with_forces(watched()));
  require_parity(joined_trees(6), cpu_backends(), 20, with_forces({}));
  require_parity(coupled_trees(9, 6), cpu_backends(), 10, with_forces({}));
  require_parity("humanoid:n=20,stiffness=0,height=0.3", cpu_backends(), 20, with_forces({}));
}

TEST_CASE("parity on OpenCL: forces of the joints of articulations")
{
  require_pocl();
  Scene bouncing = joined_trees(7, 6);
  bouncing.materials[0].restitution = 0.6f;
  require_parity(bouncing, {"serial", "cl:pocl"}, 6, with_forces(build_of_all_features()));
}

TEST_CASE("a world that tells the forces of its trees goes on from its snapshot with the same bits, anywhere")
{
  require_goes_on(joined_trees(8, 6), with_forces(watched()), [](const World &world, const World &original) {
    CHECK(world.settings().tree_joint_forces == original.settings().tree_joint_forces);
  });
}

TEST_CASE("parity on CPU: worlds of a batch tell the forces of their trees with the bits of worlds alone")
{
  BatchBesideWorlds(tests::seeded_scenes("humanoid:n=2,stiffness=0,height=0.3", 4), "tbb:threads=3", with_forces({}))
      .step(30);
}

TEST_CASE("parity on OpenCL: coupled joints of articulations")
{
  require_pocl();
  require_parity(coupled_trees(4, 6, 0, sphere_shape(0.2f)), {"serial", "cl:pocl"}, 6, build_of_all_features());
}

TEST_CASE("parity on OpenCL: joints that hold links")
{
  require_pocl();
  require_parity(joined_trees(3, 6), {"serial", "cl:pocl"}, 6, build_of_all_features());
}

TEST_CASE("parity on OpenCL: articulations")
{
  require_pocl();
  require_parity(tree_crowd(4, 5, 66, sphere_shape(0.2f)), {"serial", "cl:pocl"}, 6);
}

TEST_CASE("articulations in their own place, and with every feature built, have the same bits")
{
  const Scene scene = tree_crowd(5, 8, 0);
  const uint64_t expected = hash_of_trees(scene, 20, {}, {"serial", {}, false});
  Settings whole;
  whole.specialise = false;
  CHECK(hash_of_trees(scene, 20, whole, {"tbb", {}, false}) == expected);
  for (const char *exceptions : {"articulations=serial", "articulations=serial:order=backward,solve=tbb"})
    CHECK(hash_of_trees(scene, 20, {}, Placement{"tbb", parse_placement(exceptions), false}) == expected);
}

TEST_CASE("a world whose joints hold links goes on from its snapshot with the same bits, anywhere")
{
  require_goes_on(joined_trees(4, 8), watched(), [](const World &world, const World &original) {
    CHECK(world.scene().joints.size() == original.scene().joints.size());
  });
}

TEST_CASE("a world with articulations goes on from its snapshot with the same bits, anywhere")
{
  require_goes_on(tree_crowd(6, 8, 0), watched(), [](const World &world, const World &original) {
    CHECK(world.scene().articulations.size() == original.scene().articulations.size());
  });
}

TEST_CASE("a world whose articulations are coupled goes on from its snapshot with the same bits, anywhere")
{
  require_goes_on(coupled_trees(6, 8), watched(), [](const World &world, const World &original) {
    CHECK(world.scene().couplings == original.scene().couplings);
  });
}

TEST_CASE("parity on CPU: worlds of a batch whose articulations are coupled have the bits of worlds alone")
{
  std::vector<Scene> scenes;
  for (uint32_t world = 0; world < 11; ++world) {
    scenes.push_back(coupled_trees(7, 4));
    for (Body &body : scenes.back().bodies) body.linear_velocity = {0.1f * float(world), -0.5f, 0};
  }
  BatchBesideWorlds(scenes, "tbb:threads=3", {}).step(30);
}

TEST_CASE("parity on CPU: worlds of a batch with articulations have the bits of worlds alone")
{
  BatchBesideWorlds(tests::seeded_scenes("humanoid:n=2,stiffness=0,height=0.3", 4), "tbb:threads=3", {}).step(30);
}

TEST_CASE("parity on CPU: worlds of a batch in which a tree alone moves have the bits of worlds alone")
{
  std::vector<Scene> scenes;
  for (uint32_t world = 0; world < 19; ++world) {
    scenes.push_back(lone_chain(6));
    for (Body &body : scenes.back().bodies) body.linear_velocity = {0.1f * float(world), -0.5f, 0};
  }
  BatchBesideWorlds(scenes, "tbb:threads=3", {}).step(40);
}

TEST_CASE("parity on CPU: a world of two trees that touch, in a batch with as many worlds as trees")
{
  Scene touching = empty_scene(), parked;
  add_ground(touching);
  for (const double height : {0.5, 1.6}) {
    add_body(touching, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0.1 * height, height, 0});
    touching.articulations.emplace_back().root = uint32_t(touching.bodies.size() - 1);
  }
  parked = touching;
  parked.articulations.clear();
  for (Body &body : parked.bodies) body.type = BodyType::fixed;
  BatchBesideWorlds batch({touching, parked}, "tbb:threads=2", {});
  batch.step(60);
  World alone(touching);
  run(alone, 60);
  CHECK(alone.bodies()[1].position[1] == Approx(0.5).margin(0.02));
  CHECK(alone.bodies()[2].position[1] == Approx(1.5).margin(0.02));
}

/* An impulse on a link is a force until the next step, which only a world that has been given one keeps. */
TEST_CASE("parity on CPU: worlds of a batch of which some links are pushed have the bits of worlds alone")
{
  std::vector<Scene> scenes(3, lone_chain(6));
  BatchBesideWorlds both(scenes, "tbb:threads=2");
  both.step(3);
  const Impulse push{{0.5f, 1, 0}, {}, {}};
  both.batch.add_impulses(std::vector<WorldBody>{{1, 2}, {2, 8}}, std::vector<Impulse>{push, push});
  both.alone[1]->add_impulse(both.alone[1]->id_of(2), push);
  both.alone[2]->add_impulse(both.alone[2]->id_of(8), push); /* a stone */
  both.require_equal();
  const std::unique_ptr<World> goes_on = both.batch.alone(1, {"serial", {}, false});
  both.step(3);
  run(*goes_on, 3);
  CHECK(goes_on->state_hash() == both.alone[1]->state_hash());
  both.reset({1});
  both.step(3);
}

/* A world with overflow constraints takes further passes, in which its trees, its links' joints and its couplings take
 * part, and those of the other worlds do not. */
TEST_CASE("parity on CPU: worlds of a batch with trees, of which some have more contacts at a body than colours")
{
  Scene joined = joined_trees(5, 6), chain = tree_crowd(7, 4, 70);
  Random random(3);
  couple_trees(joined, random);
  for (const Scene &trees : {joined, chain})
    for (const std::string backend : {"serial", "tbb:threads=2,lanes=8"}) {
      CAPTURE(backend);
      std::vector<Scene> scenes;
      for (const uint32_t boxes : {81, 9, 75}) scenes.push_back(beside_loaded_slab(trees, boxes));
      BatchBesideWorlds both(scenes, backend);
      both.step(20);
      CHECK(both.alone[0]->statistics().colors > COLOR_LIMIT);
      CHECK(both.alone[1]->statistics().colors <= COLOR_LIMIT);
      both.reset({0});
      both.step(5);
    }
}

TEST_CASE("parity on CPU: worlds of a batch whose joints hold links have the bits of worlds alone")
{
  std::vector<Scene> scenes;
  for (const uint64_t seed : {1, 2, 3}) {
    scenes.push_back(joined_trees(5, 6));
    for (Body &body : scenes.back().bodies) body.linear_velocity = {0.1f * float(seed), 0, 0};
    for (Joint &joint : scenes.back().joints) joint.break_force = JointAxis::unlimited;
  }
  BatchBesideWorlds(scenes, "tbb:threads=3", {}).step(30);
}

} // namespace tandem::parity
