/* The solvers pgs and nncg: the tests of every solver, and half the passes by conjugate gradients. */
#include "host/catalog/catalog.h"
#include "host/pipeline/solvers/solvers.h"
#include "shared/platform.h"
#include "tests/catch.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

struct SolverCase {
  Solver solver;
  uint32_t substeps, iterations; /* 0: the solver's own */
};
const std::vector<SolverCase> cases{
    {Solver::pgs, 0, 0}, {Solver::nncg, 0, 0}, {Solver::pgs, 4, 2}, {Solver::nncg, 4, 3}};

Settings settings_of(const SolverCase &c)
{
  Settings settings = settings_for(c.solver);
  if (c.substeps > 0) settings.substeps = c.substeps;
  if (c.iterations > 0) settings.iterations = c.iterations;
  return settings;
}

std::string name_of(const SolverCase &c)
{
  return std::string(name_of(c.solver)) + ", substeps " + std::to_string(c.substeps) + ", iterations " +
         std::to_string(c.iterations);
}

/* Several in one world, so that each solver's physics costs one run. */
void add_inclines(Scene &scene, const std::vector<double> &coefficients, double beside_the_cone)
{
  for (double mu : coefficients)
    for (int side : {-1, 1}) {
      const double angle = std::atan(mu) + side * beside_the_cone;
      const uint32_t material = add_material(scene, float(mu));
      const float z = 2.0f * float(scene.bodies.size());
      Body &ramp = add_body(scene, BodyType::fixed, box_shape(10, 0.5f, 0.6f), {0, 0, z});
      ramp.orientation = turn_about({0, 0, 1}, angle);
      ramp.material = material;
      Body &box = add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.15f, 0.5f),
                           point_of(0.65 * Vector(-std::sin(angle), std::cos(angle), 0) + Vector(0, 0, z)));
      box.orientation = turn_about({0, 0, 1}, angle);
      box.material = material;
    }
}

/* Boxes and balls thrown at each other without gravity. */
Scene collision(float restitution)
{
  Scene scene = empty_scene({0, 0, 0});
  scene.materials[0].restitution = restitution;
  scene.materials[0].rolling_friction = scene.materials[0].spinning_friction = restitution == 0 ? 0.01f : 0;
  Random random(7);
  const auto uniform3 = [&](double size) {
    return Vector(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
  };
  for (int i = 0; i < 12; ++i) {
    const Vector place(1.5 * (i % 3 - 1), 1.5 * (i / 3 % 2) - 0.75, 1.5 * (i / 6) - 0.75);
    const float size = float(random.uniform(0.2, 0.4));
    Body &body = add_body(scene, BodyType::dynamic,
                          i % 2 ? sphere_shape(size) : box_shape(size, 0.7f * size, 1.2f * size), point_of(place));
    body.orientation = random.orientation();
    body.mass = float(random.uniform(0.5, 4));
    body.linear_velocity = vec3_of(-1.5 * place + uniform3(1));
    body.angular_velocity = vec3_of(uniform3(3));
  }
  return scene;
}

/* --- the residual, in double and from the definition --- */

/* What one more projected step of each row by itself would change, squared, in joules: 0 where the impulses solve the
 * problem. Every row from the same velocities, unlike the passes of the solver. */
class Residual {
public:
  explicit Residual(World &world) : memory_(world.memory()), settings_(world.settings())
  {
    const auto counts = memory_.read<uint32_t>(Buffer::counts, COUNT_TOTAL);
    stride_ = counts[CAPACITY_PAIRS];
    count_ = counts[COUNT_CONSTRAINTS];
    velocity_ = memory_.read<float4>(Buffer::solver_velocity, 2 * counts[COUNT_BODIES]);
    a_ = memory_.read<uint32_t>(Buffer::constraint_a, count_);
    b_ = memory_.read<uint32_t>(Buffer::constraint_b, count_);
    slop_ = memory_.read_reals(Buffer::constraint_slop, count_);
    normal_ = memory_.read<float4>(Buffer::constraint_normal, count_);
    impulse_ = memory_.read<float4>(Buffer::constraint_normal_impulse, count_);
    friction_ = memory_.read<float4>(Buffer::constraint_friction_impulse, count_);
    center_ = memory_.read<float4>(Buffer::constraint_center, count_);
    offset_ = memory_.read<float4>(Buffer::constraint_offset, count_);
    points_ = memory_.read_reals(Buffer::constraint_points, 20 * size_t{stride_});
  }

  double joules() const
  {
    double sum = 0;
    for (uint32_t i = 0; i < count_; ++i) sum += of_normals(i) + of_friction(i);
    return sum;
  }
  uint32_t constraints() const { return count_; }

private:
  static Vector xyz(const float4 &r) { return {r.x, r.y, r.z}; }

  Vector slide_at(uint32_t i, const Vector &arm_a, const Vector &arm_b) const
  {
    const float4 *a = &velocity_[2 * a_[i]], *b = &velocity_[2 * b_[i]];
    return xyz(b[0]) + xyz(b[1]).cross(arm_b) - xyz(a[0]) - xyz(a[1]).cross(arm_a);
  }

  double of_normals(uint32_t i) const
  {
    const float impulses[] = {impulse_[i].x, impulse_[i].y, impulse_[i].z, impulse_[i].w};
    double sum = 0;
    for (uint32_t k = 0; k < 4; ++k) {
      const auto number = [&](uint32_t n) { return points_[size_t{stride_} * (5 * k + n) + i]; };
      const Vector arm(number(0), number(1), number(2));
      const double mass = number(4), separation = number(3), h = double(settings_.step) / settings_.substeps;
      if (mass == 0) continue;
      const double push = std::max(0.2 / h * std::min(separation + slop_[i], 0.0), -double(settings_.push_speed));
      const double speed =
          slide_at(i, arm, arm - xyz(offset_[i])).dot(xyz(normal_[i])) + (separation > 0 ? separation / h : push);
      const double change = std::max(impulses[k] - mass * speed, 0.0) - impulses[k];
      sum += change * change / mass;
    }
    return sum;
  }

  double of_friction(uint32_t i) const
  {
    const Vector arm = xyz(center_[i]);
    const double mass = center_[i].w,
                 limit = normal_[i].w * (double(impulse_[i].x) + impulse_[i].y + impulse_[i].z + impulse_[i].w);
    const Vector n = xyz(normal_[i]), slide = slide_at(i, arm, arm - xyz(offset_[i]));
    const double sign = n.z() >= 0 ? 1 : -1, a = -1 / (sign + n.z()), b = n.x() * n.y() * a;
    const Vector first(1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()),
        second(b, sign + n.y() * n.y() * a, -n.y());
    const Vector old = friction_[i].x * first + friction_[i].y * second;
    Vector wanted = old - mass * (slide - n * n.dot(slide));
    if (wanted.norm() > limit) wanted *= limit / wanted.norm();
    return (wanted - old).squaredNorm() / mass;
  }

  Memory &memory_;
  const Settings settings_;
  uint32_t stride_, count_;
  std::vector<uint32_t> a_, b_;
  std::vector<double> slop_, points_;
  std::vector<float4> velocity_, normal_, impulse_, friction_, center_, offset_;
};

/* After so many passes of the first step, which has nothing to warm start from: relative to the residual of no
 * impulse. */
double residual_after(Solver solver, uint32_t sweeps, const Scene &scene)
{
  Settings settings = settings_for(solver);
  settings.iterations = sweeps;
  World world(scene, settings, {"serial", {}, false});
  double none = 0, after = 0;
  world.set_observer([&](const Launch &launch) {
    if (launch.kernel == Kernel::integrate_velocities) none = Residual(world).joules();
    if (launch.kernel == Kernel::integrate_positions) after = Residual(world).joules();
  });
  world.step();
  REQUIRE(none > 0);
  return std::sqrt(after / none);
}

} // namespace

TEST_CASE("pgs and nncg: free fall follows the parabola", "[physics]")
{
  for (const SolverCase &c : cases) {
    Scene scene = empty_scene();
    add_body(scene, BodyType::dynamic, box_shape(0.5f, 0.5f, 0.5f), {0, 20, 0}).linear_velocity = {3, 2, 0};
    World world(scene, settings_of(c));
    run(world, 60);
    CAPTURE(name_of(c));
    CHECK(world.bodies()[0].position[0] == Approx(3).epsilon(1e-5));
    CHECK(world.bodies()[0].position[1] == Approx(20 + 2 - 5).epsilon(1e-5));
  }
}

TEST_CASE("pgs and nncg: a stack of ten boxes stands", "[physics]")
{
  for (const SolverCase &c : cases) {
    World world(load_scene("box-stack:n=10,height=10"), settings_of(c));
    const std::vector<BodyState> start = world.bodies();
    run(world, 300);
    double sideways = 0, sunk = 0;
    for (size_t i = 0; i < start.size(); ++i) {
      const Vector moved = vector_of(world.bodies()[i].position) - vector_of(start[i].position);
      sideways = std::max(sideways, std::hypot(moved.x(), moved.z()));
      sunk = std::max(sunk, -moved.y());
    }
    const Statistics statistics = world.statistics();
    INFO(name_of(c) << ": sideways " << sideways << ", sunk " << sunk << ", deepest " << statistics.max_penetration
                    << ", energy " << statistics.kinetic_energy);
    CHECK(sideways < 0.03); /* points in order lean a stack towards the first: steady, and less with every pass */
    CHECK(sunk < 0.1);
    CHECK(statistics.max_penetration < 0.02);
    CHECK(statistics.kinetic_energy < 0.01);
  }
}

TEST_CASE("pgs and nncg: a block of boxes stays bounded", "[physics]")
{
  for (const SolverCase &c : cases) {
    World world(load_scene("box-grid:nx=4,ny=8,nz=4"), settings_of(c));
    double highest_at_start = 0;
    for (const BodyState &state : world.bodies())
      highest_at_start = std::max(highest_at_start, double(state.position[1]));
    double deepest = 0;
    for (int i = 0; i < 6; ++i) {
      run(world, 20);
      deepest = std::max(deepest, world.statistics().max_penetration);
    }
    double highest = 0, fastest = 0; /* columns of eight may fall over, nothing more */
    for (const BodyState &state : world.bodies()) {
      highest = std::max(highest, double(state.position[1]));
      fastest = std::max(fastest, vector_of(state.linear_velocity).norm());
    }
    INFO(name_of(c) << ": deepest " << deepest << ", highest " << highest << ", fastest " << fastest);
    CHECK(all_finite(world.bodies()));
    CHECK(deepest < 0.02);
    CHECK(highest < highest_at_start + 0.01);
    CHECK(fastest < 5);
  }
}

/* Planks that tumble among others: effective masses change within a step, and rows that took them from before would
 * double their error with every pass. */
TEST_CASE("pgs and nncg: a pile of all shapes gains no energy however many sweeps", "[physics]")
{
  for (const Solver solver : {Solver::pgs, Solver::nncg})
    for (uint32_t iterations : {10u, 40u}) {
      Settings settings = settings_for(solver);
      settings.iterations = iterations;
      const Scene scene = load_scene("mixed:n=60");
      World world(scene, settings);
      const auto energy = [&] {
        double sum = world.statistics().kinetic_energy;
        const std::vector<BodyState> states = world.bodies();
        for (size_t i = 0; i < states.size(); ++i)
          if (scene.bodies[i].type == BodyType::dynamic) sum += scene.bodies[i].mass * gravity * states[i].position[1];
        return sum;
      };
      const double start = energy();
      double before = start, grown = 0;
      for (int i = 0; i < 12; ++i) {
        run(world, 10);
        const double now = energy();
        grown = std::max(grown, (now - before) / start);
        before = now;
      }
      INFO(name_of(solver) << ", " << iterations << " sweeps: energy grown within ten steps " << grown
                           << " of that at the start, left " << before / start);
      CHECK(grown < 0.005);
      CHECK(before < 0.7 * start);
    }
}

TEST_CASE("pgs and nncg: boxes slip within 2 degrees of atan mu", "[physics]")
{
  for (const SolverCase &c : cases) {
    Scene scene = empty_scene();
    add_inclines(scene, {0.1, 0.3, 0.6, 1.0}, 2 * radians);
    World world(scene, settings_of(c));
    const std::vector<BodyState> start = world.bodies();
    run(world, 120);
    for (size_t i = 1; i < start.size(); i += 2) {
      const double slid = (vector_of(world.bodies()[i].position) - vector_of(start[i].position)).norm();
      INFO(name_of(c) << ", incline " << i / 2 << ": slid " << slid);
      CHECK((slid > 0.1) == (i / 2 % 2 == 1));
      if (i / 2 % 2 == 0) CHECK(slid < 0.01);
    }
  }
}

TEST_CASE("pgs and nncg: a ball returns to e squared of its height", "[physics]")
{
  for (const SolverCase &c : cases)
    for (float e : {0.3f, 0.7f, 1.0f}) {
      Scene scene = empty_scene();
      add_ground(scene).material = add_material(scene, 0.5f, e);
      add_body(scene, BodyType::dynamic, sphere_shape(0.25f), {0, 2.25f, 0});
      World world(scene, settings_of(c));
      double height = 0;
      for (int i = 0; i < 60 && height == 0; ++i) {
        world.step();
        const BodyState ball = world.bodies()[1];
        const double up = ball.linear_velocity[1];
        if (up > 0.5) height = ball.position[1] - 0.25 + up * up / (2 * gravity);
      }
      INFO(name_of(c) << ", restitution " << e << ": returns to " << height / 2 << " of its height");
      CHECK(height == Approx(2 * e * e).epsilon(0.03));
    }
}

TEST_CASE("pgs and nncg: a closed system keeps its momentum and gains no energy", "[physics]")
{
  for (const SolverCase &c : cases)
    for (float e : {0.0f, 0.5f}) {
      World world(collision(e), settings_of(c));
      const Momentum start = momentum_of(world);
      double energy = world.statistics().kinetic_energy, growth = 0, linear = 0, angular = 0;
      const double first = energy;
      for (int i = 0; i < 90; ++i) {
        world.step();
        const Momentum now = momentum_of(world);
        const double energy_now = world.statistics().kinetic_energy;
        growth = std::max(growth, (energy_now - energy) / first);
        linear = std::max(linear, (now.linear - start.linear).norm() / start.linear_scale);
        angular = std::max(angular, (now.angular - start.angular).norm() / start.angular_scale);
        energy = energy_now;
      }
      INFO(name_of(c) << ", restitution " << e << ": momentum " << linear << ", angular " << angular
                      << ", energy grown " << growth << ", left " << energy / first);
      CHECK(linear < 1e-5);
      CHECK(angular < 1e-5);
      CHECK(growth < (e == 0 ? 2e-3 : 0.02));
      CHECK(energy < 0.95 * first);
    }
}

TEST_CASE("pgs and nncg: more sweeps bring the impulses nearer to the solution", "[physics]")
{
  const Scene scene = load_scene("pyramid:rows=10");
  for (const Solver solver : {Solver::pgs, Solver::nncg}) {
    const double few = residual_after(solver, 4, scene), some = residual_after(solver, 16, scene),
                 many = residual_after(solver, 64, scene);
    INFO(name_of(solver) << ": residual after 4, 16, 64 sweeps " << few << ", " << some << ", " << many);
    CHECK(some < 0.7 * few);
    CHECK(many < 0.5 * some);
  }
}

TEST_CASE("nncg needs at most half the sweeps of pgs", "[physics]")
{
  for (const char *name : {"box-stack:n=20,height=20", "pyramid:rows=12"}) {
    const Scene scene = load_scene(name);
    for (uint32_t sweeps : {20u, 40u}) {
      const double pgs = residual_after(Solver::pgs, 2 * sweeps, scene),
                   nncg = residual_after(Solver::nncg, sweeps, scene);
      INFO(name << ": residual of pgs after " << 2 * sweeps << " sweeps " << pgs << ", of nncg after " << sweeps << " "
                << nncg);
      CHECK(nncg < pgs);
    }
  }
}

/* More contacts at one body than there are colours. */
TEST_CASE("pgs and nncg: constraints without a colour are solved too", "[physics]")
{
  Scene scene = empty_scene();
  add_ground(scene);
  add_body(scene, BodyType::dynamic, box_shape(3, 0.25f, 3), {0, 0.25f, 0}).mass = 20;
  for (int i = 0; i < 81; ++i)
    add_body(scene, BodyType::dynamic, box_shape(0.2f, 0.2f, 0.2f),
             {0.5f * float(i % 9) - 2, 0.7f, 0.5f * float(i / 9) - 2})
        .mass = 0.5f;
  for (const SolverCase &c : cases) {
    World world(scene, settings_of(c));
    const std::vector<BodyState> start = world.bodies();
    run(world, 60);
    double moved = 0;
    for (size_t i = 1; i < start.size(); ++i)
      moved = std::max(moved, (vector_of(world.bodies()[i].position) - vector_of(start[i].position)).norm());
    INFO(name_of(c) << ": moved " << moved);
    CHECK(world.statistics().colors == COLOR_LIMIT + 1);
    CHECK(moved < 0.03);
  }
}
