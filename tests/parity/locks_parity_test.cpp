/* Locked axes and highest speeds give the serial backend's bits on every backend. */
#include "tests/parity/parity.h"

using namespace tandem;
using namespace tandem::parity;

namespace {

/* Half of the bodies have locks or highest speeds; lanes therefore hold bodies with and without. */
Scene locked(const std::string &name)
{
  Scene scene = load_scene(name);
  Random random(23);
  const auto some = [&] { return random.below(3) == 0; };
  for (Body &body : scene.bodies) {
    if (body.type != BodyType::dynamic || random.below(2) == 0) continue;
    body.linear_locks = {some(), some(), some()};
    body.angular_locks = {some(), some(), some()};
    if (some()) body.max_linear_speed = static_cast<float>(random.uniform(0.5, 3));
    if (some()) body.max_angular_speed = static_cast<float>(random.uniform(0.5, 3));
    body.linear_velocity = {static_cast<float>(random.uniform(-2, 2)), 0, static_cast<float>(random.uniform(-2, 2))};
  }
  return scene;
}

const std::vector<std::string> &crowds()
{
  static const std::vector<std::string> scenes{"mixed:n=60", "spheres:n=60,height=0,restitution=0.5", "compounds:n=20",
                                               "rolling", "box-grid:nx=4,ny=4,nz=4"};
  return scenes;
}

} // namespace

TEST_CASE("parity on CPU: locked axes and highest speeds")
{
  for (const std::string &scene : crowds()) require_parity(locked(scene), cpu_backends(), 40);
}

TEST_CASE("parity on CPU: locked axes with every solver that has them", "[sanitizer]")
{
  for (const Solver solver : choices<Solver>()) {
    if (solver == Solver::avbd) continue;
    require_parity(locked("mixed:n=40"), {"serial", "serial:order=backward", "tbb:threads=4"}, 30,
                   settings_for(solver));
  }
}

TEST_CASE("parity on OpenCL: locked axes and highest speeds")
{
  require_pocl();
  require_parity(locked("mixed:n=40"), {"serial", "cl:pocl"}, 40, build_of_all_features());
}
