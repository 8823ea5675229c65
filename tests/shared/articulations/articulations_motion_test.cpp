/* The motion of trees, in double precision: against a fine integrator of dense matrices, closed forms, and what is
 * conserved. */
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "tests/catch.h"
#include "tests/shared/articulations/tree_model.h"

#define TANDEM_REFERENCE
namespace tandem::reference_trees {
#include "tests/shared/articulations/tree_in_memory.h"
} // namespace tandem::reference_trees

using namespace tandem::tree_tests;
using namespace tandem::reference_trees;
using tandem::Random;

namespace {

constexpr double pi = 3.14159265358979323846;

/* --- the fine integrator: the rule of Runge and Kutta of fourth order ------------------------------------------- */
struct Rate {
  std::vector<Eigen::Vector4d> q;
  Vector root;
  Column v;
};

Rate rate_of(const TreeModel &model, const TreeState &s)
{
  Rate r{{},
         Vector::Zero(),
         DenseTree(model, s).acceleration(Column::Zero(model.size()), Column::Zero(6 * int(model.links.size())))};
  for (size_t k = 0; k < s.q.size(); ++k) {
    const int first = model.first(k), n = model.freedoms(k);
    Eigen::Vector4d q = Eigen::Vector4d::Zero();
    if (n == 1) q[0] = s.v[first];
    if (n >= 3) q = 0.5 * (Turn(0, s.v[first], s.v[first + 1], s.v[first + 2]) * turn_of(s.q[k])).coeffs();
    if (n == 6) r.root = s.v.segment<3>(first + 3);
    r.q.push_back(q);
  }
  return r;
}
TreeState along(TreeState s, const Rate &r, double h)
{
  for (size_t k = 0; k < s.q.size(); ++k) s.q[k] += h * r.q[k];
  s.root += h * r.root;
  s.v += h * r.v;
  return s;
}
TreeState integrated(const TreeModel &model, TreeState s, double time, int steps)
{
  const double h = time / steps;
  for (int i = 0; i < steps; ++i) {
    const Rate a = rate_of(model, s), b = rate_of(model, along(s, a, h / 2)), c = rate_of(model, along(s, b, h / 2)),
               d = rate_of(model, along(s, c, h));
    s = along(along(along(along(s, a, h / 6), b, h / 3), c, h / 3), d, h / 6);
    for (size_t k = 0; k < s.q.size(); ++k)
      if (model.freedoms(k) >= 3) s.q[k].normalize();
  }
  return s;
}

/* How far apart the centres of the links are, m. */
double distance(const TreeModel &model, const TreeState &a, const TreeState &b)
{
  const DenseTree of_a(model, a), of_b(model, b);
  double most = 0;
  for (size_t k = 0; k < a.q.size(); ++k)
    most = std::max(most, (of_a.poses()[k].center - of_b.poses()[k].center).norm());
  return most;
}

TreeState after(const TreeModel &model, const TreeState &s, double time, int steps)
{
  Tree tree(model);
  tree.set(s);
  tree.run(time, steps);
  return tree.get();
}

/* The errors of runs with steps each half as long. */
std::vector<double> errors_of(const TreeModel &model, const TreeState &s, const TreeState &truth, double time,
                              int steps)
{
  std::vector<double> errors;
  for (const int n : {steps, 2 * steps, 4 * steps}) errors.push_back(distance(model, after(model, s, time, n), truth));
  return errors;
}
bool falls(const std::vector<double> &errors, double factor)
{
  for (size_t k = 1; k < errors.size(); ++k)
    if (!(errors[k] < factor * errors[k - 1])) return false;
  return true;
}

/* A rod of length 1 m and mass 1 kg on a hinge about z at its end, which lies along x. */
LinkModel rod(int parent)
{
  LinkModel l;
  l.parent = parent;
  l.joint = TREE_JOINT_HINGE;
  if (parent >= 0) l.from_parent = Vector(0.5, 0, 0);
  l.from_center = Vector(-0.5, 0, 0);
  l.moments = Vector(0.001, 1.0 / 12, 1.0 / 12);
  l.axes_in_parent = l.axes_in_link = Turn::FromTwoVectors(Vector::UnitX(), Vector::UnitZ());
  return l;
}
TreeModel rods(int count)
{
  TreeModel model;
  for (int k = 0; k < count; ++k) model.links.push_back(rod(k - 1));
  return model;
}

double energy(const TreeModel &model, const TreeState &s)
{
  const DenseTree d(model, s);
  return d.kinetic_energy() + d.potential_energy();
}

/* The complete elliptic integral of the first kind, by the arithmetic-geometric mean. */
double elliptic_k(double modulus)
{
  double a = 1, b = std::sqrt(1 - modulus * modulus);
  for (int i = 0; i < 20; ++i) {
    const double next = (a + b) / 2;
    b = std::sqrt(a * b);
    a = next;
  }
  return pi / (2 * a);
}

double period_of_pendulum(double amplitude, int steps_per_second)
{
  const TreeModel model = rods(1);
  TreeState s = rest_of(model);
  s.q[0][0] = -pi / 2 + amplitude;
  Tree tree(model);
  tree.set(s);
  tree.prepare(1.0 / steps_per_second);
  std::vector<double> crossings;
  double before = amplitude;
  for (int k = 1; crossings.size() < 2; ++k) {
    tree.advance(1.0 / steps_per_second);
    const double now = tree.get().q[0][0] + pi / 2;
    if (before < 0 && now >= 0) crossings.push_back((k - now / (now - before)) / steps_per_second);
    before = now;
  }
  return crossings[1] - crossings[0];
}

} // namespace

TEST_CASE("articulations: a pendulum at large angles has the period of the elliptic integral", "[articulations]")
{
  const double slow = std::sqrt(10 * 0.5 / (1.0 / 3));
  for (const double amplitude : {0.1, 1.0, 2.0, 3.0}) {
    const double exact = 4 * elliptic_k(std::sin(amplitude / 2)) / slow;
    std::vector<double> errors;
    for (const int rate : {240, 480, 960}) errors.push_back(std::abs(period_of_pendulum(amplitude, rate) - exact));
    CAPTURE(amplitude, errors);
    CHECK(errors.front() < 1e-3 * exact);
    CHECK(falls(errors, 0.55));
  }
}

TEST_CASE("articulations: a double pendulum and a tree of 20 links converge to a fine integrator", "[articulations]")
{
  const TreeModel pendulum = rods(2);
  const TreeState from = rest_of(pendulum), truth = integrated(pendulum, from, 1, 2000);
  REQUIRE(distance(pendulum, truth, integrated(pendulum, from, 1, 1000)) < 1e-8);
  const std::vector<double> errors = errors_of(pendulum, from, truth, 1, 240);
  CAPTURE(errors);
  CHECK(errors.front() < 0.05);
  CHECK(falls(errors, 0.55));

  Random random(3);
  for (const int root : {TREE_JOINT_BALL, TREE_JOINT_FREE}) {
    TreeModel tree = random_tree(random, 20, root);
    for (LinkModel &l : tree.links) l.damping = l.joint == TREE_JOINT_SLIDER ? 5 : 0; /* or the links fly away */
    for (LinkModel &l : tree.links) l.stiffness = l.joint == TREE_JOINT_SLIDER ? 100 : 0;
    const TreeState start = random_state(random, tree, 0.5);
    const auto forced = [&](const TreeState &s) { return after(tree, s, 0.25, 6400); };
    const TreeState fine = forced(start);
    const std::vector<double> of_tree = errors_of(tree, start, fine, 0.25, 100);
    CAPTURE(root, of_tree);
    CHECK(of_tree.front() < 0.05);
    CHECK(falls(of_tree, 0.6));
    for (LinkModel &l : tree.links) l.damping = l.stiffness = 0;
    const TreeState dense = integrated(tree, start, 0.25, 100);
    const std::vector<double> without_springs = errors_of(tree, start, dense, 0.25, 100);
    CAPTURE(without_springs);
    CHECK(without_springs.front() < 0.05);
    CHECK(falls(without_springs, 0.55));
  }
}

TEST_CASE("articulations: trees that nothing pushes keep momentum, and energy with the second order", "[articulations]")
{
  Random random(1);
  for (int n = 0; n < 4; ++n) {
    TreeModel model = random_tree(random, 12, TREE_JOINT_FREE);
    model.gravity.setZero();
    const TreeState s = random_state(random, model, 3);
    const DenseTree before(model, s);
    std::vector<double> errors;
    for (const int steps : {240, 480, 960}) {
      const DenseTree now(model, after(model, s, 1, steps));
      errors.push_back(std::abs(now.kinetic_energy() / before.kinetic_energy() - 1));
      for (int i = 0; i < 2; ++i)
        CHECK((now.momentum()[size_t(i)] - before.momentum()[size_t(i)]).norm() <
              1e-12 * (1 + before.momentum()[size_t(i)].norm()));
    }
    CAPTURE(n, errors);
    CHECK(errors.front() < 0.01);
    CHECK(falls(errors, 0.35));
  }
}

TEST_CASE("articulations: a single free link moves as a free body", "[articulations]")
{
  TreeModel model;
  LinkModel l;
  l.joint = TREE_JOINT_FREE;
  l.mass = 2;
  l.moments = Vector(0.1, 0.2, 0.25);
  model.links = {l};
  TreeState s = rest_of(model);
  s.v << 1, 5, 0.5, 1, 2, 3;
  const TreeState truth = integrated(model, s, 1, 4000);
  const TreeState found = after(model, s, 1, 960);
  CHECK(turn_of(found.q[0]).angularDistance(turn_of(truth.q[0])) < 1e-3);
  CHECK((found.v - truth.v).norm() < 1e-3 * truth.v.norm());
  /* Symplectic Euler falls by half a substep of velocity more than the parabola. */
  CHECK((found.root - truth.root - Vector(0, -0.5 * 10 / 960, 0)).norm() < 1e-10);
}

TEST_CASE("articulations: a fast gyroscope on a ball joint precesses as m g r / (I w)", "[articulations]")
{
  for (const double spin : {100.0, 200.0, 400.0}) {
    TreeModel model;
    LinkModel l;
    l.joint = TREE_JOINT_BALL;
    l.moments = Vector(0.1, 0.06, 0.06);
    l.from_center = Vector(-0.3, 0, 0);
    model.links = {l};
    TreeState s = rest_of(model);
    const double precession = 10 * 0.3 / (0.1 * spin);
    s.v << spin, precession, 0;
    const TreeState now = after(model, s, 2, 1920);
    const Vector center = DenseTree(model, now).poses()[0].center;
    CAPTURE(spin, center.transpose());
    CHECK(std::atan2(-center.z(), center.x()) == Approx(2 * precession).epsilon(0.02));
    CHECK(std::abs(center.y()) < 2e-3);
    CHECK(energy(model, now) == Approx(energy(model, s)).epsilon(1e-5));
  }
}

TEST_CASE("articulations: gains of 1e6 hold a tree where they shall", "[articulations]")
{
  Random random(5);
  for (const double damping : {0.0, 1e3, 1e6}) {
    TreeModel model = random_tree(random, 20, TREE_JOINT_HINGE);
    for (LinkModel &l : model.links) {
      l.stiffness = 1e6;
      l.damping = damping;
      l.target = l.joint == TREE_JOINT_BALL ? 0 : 0.3;
    }
    TreeState s = rest_of(model);
    for (size_t k = 0; k < s.q.size(); ++k)
      if (model.freedoms(k) == 1) s.q[k][0] = 0.3;
    const TreeState now = after(model, s, 2, 120);
    /* 50 kg m at 3 m: the springs give way by less than 2 mm. */
    CAPTURE(damping, distance(model, now, s));
    CHECK(distance(model, now, s) < 0.03);
    CHECK(now.v.norm() < 0.1);
  }
}

TEST_CASE("articulations: a link without inertia moves by its armature alone", "[articulations]")
{
  TreeModel model = rods(3);
  model.links[2].mass = 0;
  model.links[2].moments.setZero();
  model.links[2].armature = 0.1;
  const TreeState from = rest_of(model), truth = integrated(model, from, 0.5, 1000);
  const std::vector<double> errors = errors_of(model, from, truth, 0.5, 120);
  CAPTURE(errors);
  CHECK(errors.front() < 0.05);
  CHECK(falls(errors, 0.55));
}

TEST_CASE("articulations: a chain of 100 links keeps its energy", "[articulations]")
{
  TreeModel model = rods(100);
  for (LinkModel &l : model.links) l.mass = 0.1, l.moments *= 0.1;
  const TreeState from = rest_of(model);
  std::vector<double> errors;
  for (const int steps : {240, 480, 960}) {
    const TreeState now = after(model, from, 1, steps);
    const DenseTree dense(model, now);
    errors.push_back(std::abs(energy(model, now) - energy(model, from)) / dense.kinetic_energy());
  }
  CAPTURE(errors);
  CHECK(errors.front() < 0.02);
  CHECK(falls(errors, 0.6));
}

TEST_CASE("articulations: a limit stops a pendulum and bears its weight", "[articulations]")
{
  TreeModel model = rods(1);
  model.links[0].lower = -0.5;
  Tree tree(model);
  tree.set(rest_of(model));
  tree.run(3, 720, 1);
  CHECK(tree.get().q[0][0] == Approx(-0.5).margin(1e-3));
  CHECK(std::abs(tree.get().v[0]) < 1e-3);
  CHECK(load_state(&tree.t, 0, STATE_ROW_IMPULSE).y * 240 == Approx(10 * 0.5 * std::cos(0.5)).epsilon(0.01));
}

namespace {

/* Two rods after a substep in which a motor turns one and stops at half a radian bound the other. */
TreeState stopped_rods(size_t driven, double speed)
{
  TreeModel model = rods(2);
  model.gravity.setZero();
  model.links[1].from_center.setZero();
  model.links[driven].damping = -1; /* DAMPING_OF_MOTOR */
  model.links[driven].target_speed = speed;
  model.links[1 - driven].lower = -0.5;
  model.links[1 - driven].upper = 0.5;
  Tree tree(model);
  tree.set(rest_of(model));
  tree.run(1.0 / 240, 1, 1);
  return tree.get();
}

} // namespace

/* The first arm is driven. The second hangs on it at its centre and stays by its inertia, until the stop of its joint,
 * far from where it is, takes it along. */
TEST_CASE("articulations: a stop that another joint's motor brings into reach acts in the same pass", "[articulations]")
{
  const TreeState s = stopped_rods(0, 1000);
  CHECK(s.v[0] > 900); /* the motor feels the other arm from the next pass on */
  CHECK(std::abs(s.v[1]) < 1e-6);
  CHECK(s.q[1][0] == Approx(-0.5).margin(1e-6));
}

/* The sweep has passed the stop when it comes to the motor. */
TEST_CASE("articulations: a stop nearer to the root than the motor that brings it into reach acts in the same pass",
          "[articulations]")
{
  const TreeState s = stopped_rods(1, 3000);
  CHECK(s.v[1] > 1000);
  CHECK(s.q[0][0] == Approx(-0.5).margin(1e-6));
}

TEST_CASE("articulations: friction holds a pendulum, or brakes it by its torque", "[articulations]")
{
  TreeModel model = rods(1);
  const auto angle_after = [&](double friction) {
    model.links[0].friction = friction;
    Tree tree(model);
    tree.set(rest_of(model));
    tree.run(0.1, 240, 1);
    return tree.get().q[0][0];
  };
  CHECK(std::abs(angle_after(5.1)) < 1e-9);
  CHECK(angle_after(2) == Approx(-0.5 * (5 - 2) / (1.0 / 3) * 0.01).epsilon(0.02));
}

TEST_CASE("articulations: motors of a whole tree reach their speeds together, or their largest force",
          "[articulations]")
{
  Random random(9);
  TreeModel model = random_tree(random, 12, TREE_JOINT_FREE);
  for (LinkModel &l : model.links) {
    if (l.joint == TREE_JOINT_BALL) l.joint = TREE_JOINT_HINGE;
    l.damping = -1; /* DAMPING_OF_MOTOR */
    l.target_speed = random.uniform(-2, 2);
  }
  Tree tree(model);
  const TreeState s = random_state(random, model, 1);
  tree.set(s);
  tree.prepare(0.01);
  Parameters p{};
  p.substep = 0.01;
  p.inverse_substep = 100;
  for (int pass = 0; pass < 500; ++pass) solve_tree_rows(&p, &tree.t, PASS_BIASED);
  for (size_t k = 1; k < model.links.size(); ++k)
    if (model.freedoms(k) == 1) CHECK(tree.get().v[model.first(k)] == Approx(model.links[k].target_speed).margin(1e-6));

  TreeModel weak = rods(1);
  weak.gravity.setZero();
  weak.links[0].damping = -1;
  weak.links[0].target_speed = 5;
  weak.links[0].largest_force = 1;
  Tree pushed(weak);
  pushed.set(rest_of(weak));
  pushed.run(0.5, 120, 1);
  CHECK(pushed.get().v[0] == Approx(1 / (1.0 / 3) * 0.5).epsilon(1e-6));
}

TEST_CASE("articulations: no speed makes a tree gain energy without end", "[articulations]")
{
  Random random(1);
  for (const int root : {TREE_JOINT_BALL, TREE_JOINT_FREE}) {
    for (const double speed : {20.0, 50.0}) {
      TreeModel model = random_tree(random, 12, root);
      model.gravity.setZero();
      for (LinkModel &l : model.links)
        if (l.joint == TREE_JOINT_SLIDER) l.joint = TREE_JOINT_HINGE;
      const TreeState s = random_state(random, model, speed);
      const double share = energy(model, after(model, s, 5, 1200)) / energy(model, s);
      CAPTURE(root, speed, share);
      CHECK(share < 1.05);
      CHECK(share > 0.3);
    }
  }
}
