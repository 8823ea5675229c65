/* joint_curves.cpp - moves trees of links by several methods and compares them; see joint_curves.h. */
#include "tools/report/joint_curves.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include <tandem/articulations.h>
#include <tandem/world.h>

#include "host/base/random.h"
#include "tools/report/truth.h"
#include "tools/stability/joints.h"

namespace tandem {
namespace {

using stability::Vector;
using Numbers = Eigen::VectorXd;
/* The centres of all bodies after each step of 1/60 s. */
using Path = std::vector<std::vector<Vector>>;

/* A rod from `from` along `along`, on a hinge at `from` that the body `parent` or the world holds. */
uint32_t add_rod(Scene &scene, uint32_t parent, const Vector &from, const Vector &along, const Vector &axis)
{
  const auto number = static_cast<uint32_t>(scene.bodies.size());
  const Vector center = from + along / 2;
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Vector::UnitX(), along);
  scene.shapes.push_back(box_shape(float(along.norm() / 2), 0.05f, 0.08f));
  Body body;
  body.shape = static_cast<uint32_t>(scene.shapes.size() - 1);
  body.position = {center.x(), center.y(), center.z()};
  body.orientation = {float(turn.x()), float(turn.y()), float(turn.z()), float(turn.w())};
  scene.bodies.push_back(body);
  stability::connect(scene, JointType::hinge, parent, number, from, axis);
  return number;
}

Scene double_pendulum()
{
  Scene scene;
  scene.name = "double pendulum";
  const uint32_t upper = add_rod(scene, no_body, {0, 2, 0}, {0.8, 0.3, 0}, Vector::UnitZ());
  add_rod(scene, upper, {0.8, 2.3, 0}, {0.6, -0.2, 0}, Vector::UnitZ());
  stability::let_pass(scene);
  return scene;
}

/* Each link hangs on the end of one before it, and turns about any axis across it. */
Scene tree_of_links(uint32_t links)
{
  Scene scene;
  scene.name = fmt::format("tree of {} links", links);
  Random random(20);
  std::vector<Vector> ends;
  const auto any = [&] {
    return Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
  };
  for (uint32_t link = 0; link < links; ++link) {
    const uint32_t parent = link == 0 ? no_body : random.below(link);
    const Vector from = parent == no_body ? Vector(0, 2, 0) : ends[parent], along = 0.4 * any();
    add_rod(scene, parent, from, along, along.cross(any()).normalized());
    ends.push_back(from + along);
  }
  stability::let_pass(scene);
  return scene;
}

/* The tree of a scene of hinges as a system of ordinary differential equations. */
class DenseTree {
public:
  explicit DenseTree(const Scene &scene) : tree_(scene, scene.articulations.front(), scene.name), state_(tree_.state())
  {}

  /* q and q' one below the other. */
  Numbers start() const
  {
    Numbers y = Numbers::Zero(2 * count());
    for (Eigen::Index k = 0; k < count(); ++k) y[k] = state_.coordinates[static_cast<size_t>(k)][0];
    return y;
  }
  Numbers stepped(const Numbers &y, double h)
  {
    const Numbers a = slope(y), b = slope(y + h / 2 * a), c = slope(y + h / 2 * b), d = slope(y + h * c);
    return y + h / 6 * (a + 2 * b + 2 * c + d);
  }
  /* By the numbers of the bodies. */
  std::vector<Vector> centers(const Numbers &y)
  {
    take(y);
    std::vector<Vector> centers(size());
    const std::vector<LinkPose> poses = tree_.forward_kinematics(state_);
    for (size_t k = 0; k < poses.size(); ++k)
      centers[tree_.links()[k].body] = {poses[k].position[0], poses[k].position[1], poses[k].position[2]};
    return centers;
  }

private:
  size_t size() const { return tree_.velocities(); }
  Eigen::Index count() const { return static_cast<Eigen::Index>(size()); }
  void take(const Numbers &y)
  {
    for (Eigen::Index k = 0; k < count(); ++k) {
      state_.coordinates[static_cast<size_t>(k)][0] = y[k];
      state_.velocities[static_cast<size_t>(k)] = y[count() + k];
    }
  }
  Numbers slope(const Numbers &y)
  {
    take(y);
    std::vector<double> mass = tree_.mass_matrix(state_),
                        bias = tree_.inverse_dynamics(state_, std::vector<double>(size(), 0.0));
    const Eigen::Map<const Eigen::MatrixXd> m(mass.data(), count(), count());
    Numbers result(2 * count());
    result << y.tail(count()), m.ldlt().solve(-Eigen::Map<const Numbers>(bias.data(), count()));
    return result;
  }

  ArticulationTree tree_;
  ArticulationState state_;
};

Path reference_path(const Scene &scene, uint32_t frames, uint32_t steps_of_frame)
{
  DenseTree tree(scene);
  Numbers y = tree.start();
  Path path;
  for (uint32_t frame = 0; frame < frames; ++frame) {
    for (uint32_t k = 0; k < steps_of_frame; ++k) y = tree.stepped(y, double{base_step} / steps_of_frame);
    path.push_back(tree.centers(y));
  }
  return path;
}

Path path_of_world(const Scene &scene, uint32_t frames, uint32_t substeps, const std::string &backend)
{
  World world(scene, stability::with_stiff_joints(substeps), {backend, {}, false});
  Path path;
  for (uint32_t frame = 0; frame < frames; ++frame) {
    world.step();
    path.emplace_back();
    for (const PreciseBodyState &body : world.precise_bodies())
      path.back().push_back({body.position[0], body.position[1], body.position[2]});
  }
  return path;
}

double distance_between(const Path &one, const Path &other)
{
  double sum = 0;
  size_t count = 0;
  for (size_t frame = 0; frame < one.size(); ++frame)
    for (size_t body = 0; body < one[frame].size(); ++body, ++count)
      sum += (one[frame][body] - other[frame][body]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(count));
}

} // namespace

double JointCurve::Point::substep() const { return double{base_step} / substeps; }

std::optional<double> JointCurve::order() const
{
  double x = 0, y = 0, xx = 0, xy = 0;
  for (const Point &point : points) {
    if (!(point.error > 0) || !std::isfinite(point.error)) return std::nullopt;
    const double of_step = std::log(point.substep()), of_error = std::log(point.error);
    x += of_step, y += of_error, xx += of_step * of_step, xy += of_step * of_error;
  }
  const double n = static_cast<double>(points.size()), spread = n * xx - x * x;
  if (!(spread > 0)) return std::nullopt;
  return (n * xy - x * y) / spread;
}

std::string order_sentence(const JointCurve &curve)
{
  const std::optional<double> order = curve.order();
  return fmt::format("error {:.3g} m with {} substeps of 1/60 s, {:.3g} m with {}; {}", curve.points.front().error,
                     curve.points.front().substeps, curve.points.back().error, curve.points.back().substeps,
                     order ? fmt::format("order of convergence {:.2f}", *order) : "no order of convergence");
}

JointReport joint_curves(const std::string &backend, bool quick)
{
  constexpr uint32_t steps_of_reference = 32;
  const uint32_t frames = quick ? 20 : 40, most_substeps = quick ? 16 : 64;
  JointReport report;
  for (const Scene &maximal : {double_pendulum(), tree_of_links(20)}) {
    Scene reduced = maximal;
    make_articulations(reduced, reduced.name);
    const Path truth = reference_path(reduced, frames, 2 * steps_of_reference);
    report.uncertainty =
        std::max(report.uncertainty, distance_between(truth, reference_path(reduced, frames, steps_of_reference)));
    for (const Scene *scene : {&std::as_const(reduced), &maximal}) {
      JointCurve curve{scene->name, scene == &reduced ? "reduced coordinates" : "maximal coordinates", {}};
      for (uint32_t substeps = 2; substeps <= most_substeps; substeps *= 2)
        curve.points.push_back({substeps, distance_between(truth, path_of_world(*scene, frames, substeps, backend))});
      report.curves.push_back(curve);
    }
  }
  return report;
}

} // namespace tandem
