/* Worlds that choose their substeps choose alike on all backends. */
#include "tests/parity/parity.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

void require_same_choice(const Scene &scene, const std::vector<std::string> &backends, uint64_t steps,
                         const Settings &settings = {})
{
  ComparisonRequest request;
  request.settings = settings;
  request.settings.substeps = automatic_substeps;
  request.backends = backends;
  request.steps = steps;
  const Comparison comparison = compare_backends(scene, request);
  CAPTURE(scene.name);
  if (comparison.first_difference) FAIL(describe(*comparison.first_difference));
  CHECK(comparison.steps == steps);
}

/* Adds the bodies of another scene, on the ground that is there, so far away. */
void add_beside(Scene &scene, const Scene &other, double z)
{
  const auto shapes = uint32_t(scene.shapes.size()), materials = uint32_t(scene.materials.size()),
             joints = uint32_t(scene.joints.size());
  scene.shapes.insert(scene.shapes.end(), other.shapes.begin(), other.shapes.end());
  scene.materials.insert(scene.materials.end(), other.materials.begin(), other.materials.end());
  std::vector<uint32_t> place;
  for (Body body : other.bodies) {
    const bool is_ground = other.shapes[body.shape].type == ShapeType::half_space;
    place.push_back(is_ground ? 0 : uint32_t(scene.bodies.size()));
    if (is_ground) continue;
    body.shape += shapes;
    body.material += materials;
    body.position[2] += z;
    scene.bodies.push_back(body);
  }
  for (Joint joint : other.joints) {
    for (uint32_t *body : {&joint.body_a, &joint.body_b})
      if (*body != no_body) *body = place[*body];
    if (joint.body_a == no_body) joint.position_a[2] += z;
    if (joint.body_b == no_body) joint.position_b[2] += z;
    scene.joints.push_back(joint);
  }
  for (Coupling coupling : other.couplings) {
    coupling.joint_a += joints;
    coupling.joint_b += joints;
    scene.couplings.push_back(coupling);
  }
}

void add_box(Scene &scene, const Point &position, const Vec3 &half_extents, float mass)
{
  scene.shapes.push_back(box_shape(half_extents[0], half_extents[1], half_extents[2]));
  Body body;
  body.shape = uint32_t(scene.shapes.size() - 1);
  body.position = position;
  body.mass = mass;
  scene.bodies.push_back(body);
}

/* Islands of both classes, with all that the solver moves apart: balls that bounce and roll, ropes, gears, a pulley, a
 * platform that moves and loads beside it, and a slab on more bodies than there are colours. */
Scene both_classes()
{
  Scene scene = load_scene("spheres:n=27,restitution=0.5,height=0");
  scene.name = "islands of both classes";
  scene.materials[0].rolling_friction = 0.02f;
  double z = 0;
  for (const char *name : {"tower:levels=12", "crane:rows=2,length=2", "motor-mill:stones=12", "wrecking-ball:rows=2"})
    add_beside(scene, load_scene(name), z += 40);
  add_box(scene, {-30, 2, 0}, {2, 0.2f, 2}, 1);
  scene.bodies.back().type = BodyType::kinematic;
  scene.bodies.back().linear_velocity = {0.5, 0, 0.2f};
  scene.bodies.back().angular_velocity = {0, 0.4f, 0};
  add_box(scene, {-30, 2.6, 0.5}, {0.4f, 0.4f, 0.4f}, 1);
  add_box(scene, {-30, 3.4, 0.5}, {0.4f, 0.4f, 0.4f}, 3000);
  add_box(scene, {-30, 2.6, -1}, {0.4f, 0.4f, 0.4f}, 1);
  scene.bodies.back().max_linear_speed = 3;
  for (const float load : {81.0f, 200000.0f}) {
    const double x = load > 100 ? 60 : 40;
    for (int i = 0; i < 81; ++i) add_box(scene, {x + 1.5 * (i % 9), 0.5, 1.5 * (i / 9)}, {0.5f, 0.5f, 0.5f}, 1);
    add_box(scene, {x + 6, 1.5, 6}, {7, 0.5f, 7}, load);
  }
  return scene;
}

} // namespace

TEST_CASE("parity on CPU: automatic substeps")
{
  for (const char *name : {"mass-ratio", "mixed:n=100", "pyramid:rows=8", "compounds:n=40", "tower", "tops",
                           "wrecking-ball", "ragdolls:n=2", "vehicle", "crane"})
    require_same_choice(load_scene(name), cpu_backends(), 10);
}

TEST_CASE("parity on CPU: islands of few and of many substeps")
{
  Settings settings;
  settings.events = true;
  require_same_choice(both_classes(),
                      {"serial", "serial:order=backward", "serial:order=shuffled", "tbb:threads=2,lanes=1",
                       "tbb:threads=2,lanes=4", "tbb:threads=7,lanes=8", "tbb:threads=1,lanes=16"},
                      4, settings);
}

TEST_CASE("parity on OpenCL: automatic substeps", "[opencl]")
{
  require_pocl();
  for (const char *name : {"mass-ratio", "mixed:n=60", "tower:levels=12", "tops", "wrecking-ball", "crane"})
    require_same_choice(load_scene(name), {"serial", "cl:pocl"}, 6, build_of_all_features());
}

TEST_CASE("parity on OpenCL: islands of few and of many substeps", "[opencl]")
{
  require_pocl();
  require_same_choice(both_classes(), {"serial", "cl:pocl"}, 2);
}
