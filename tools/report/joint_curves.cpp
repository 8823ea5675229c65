/* joint_curves.cpp - moves trees of links by several methods and compares them; see joint_curves.h. */
#include "tools/report/joint_curves.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include <tandem/articulations.h>
#include <tandem/world.h>

#include "host/base/random.h"
#include "tools/report/truth.h"

namespace tandem {
namespace {

using Vector3 = Eigen::Vector3d;
using Numbers = Eigen::VectorXd;
/* The centres of all bodies after each step of 1/60 s. */
using Path = std::vector<std::vector<Vector3>>;

struct TreeScene {
  std::string name;
  Scene scene;
};

/* A rod from `from` along `along`, on a hinge at `from` that the body `parent` or the world holds. */
uint32_t add_rod(Scene &scene, uint32_t parent, const Vector3 &from, const Vector3 &along, const Vector3 &axis)
{
  const auto quat_of = [](const Eigen::Quaterniond &q) {
    return Quat{float(q.x()), float(q.y()), float(q.z()), float(q.w())};
  };
  const auto number = static_cast<uint32_t>(scene.bodies.size());
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Vector3::UnitX(), along),
                           frame = Eigen::Quaterniond::FromTwoVectors(Vector3::UnitX(), axis);
  const Vector3 center = from + along / 2;
  scene.shapes.push_back(box_shape(float(along.norm() / 2), 0.05f, 0.08f));
  Body body;
  body.shape = static_cast<uint32_t>(scene.shapes.size() - 1);
  body.position = {center.x(), center.y(), center.z()};
  body.orientation = quat_of(turn);
  body.filter_mask = 0;
  Joint joint;
  joint.type = JointType::hinge;
  joint.body_a = parent;
  joint.body_b = number;
  const auto place = [&](const Vector3 &of, const Eigen::Quaterniond &axes, Point &position, Quat &orientation) {
    const Vector3 at = axes.conjugate() * (from - of);
    position = {at.x(), at.y(), at.z()};
    orientation = quat_of(axes.conjugate() * frame);
  };
  Vector3 of_parent = Vector3::Zero();
  Eigen::Quaterniond axes_of_parent = Eigen::Quaterniond::Identity();
  if (parent != no_body) {
    const Body &other = scene.bodies[parent];
    of_parent = {other.position[0], other.position[1], other.position[2]};
    axes_of_parent = Eigen::Quaterniond(double{other.orientation[3]}, double{other.orientation[0]},
                                        double{other.orientation[1]}, double{other.orientation[2]});
  }
  place(of_parent, axes_of_parent, joint.position_a, joint.orientation_a);
  place(center, turn, joint.position_b, joint.orientation_b);
  scene.bodies.push_back(body);
  scene.joints.push_back(joint);
  return number;
}

TreeScene double_pendulum()
{
  TreeScene tree{"double pendulum", {}};
  tree.scene.name = tree.name;
  const uint32_t upper = add_rod(tree.scene, no_body, {0, 2, 0}, {0.8, 0.3, 0}, Vector3::UnitZ());
  add_rod(tree.scene, upper, {0.8, 2.3, 0}, {0.6, -0.2, 0}, Vector3::UnitZ());
  return tree;
}

/* Each link hangs on the end of one before it, or in its middle, and turns about any axis across it. */
TreeScene tree_of_links(uint32_t links)
{
  TreeScene tree{"tree of 20 links", {}};
  tree.scene.name = tree.name;
  Random random(20);
  std::vector<Vector3> ends;
  const auto any = [&] {
    return Vector3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
  };
  for (uint32_t link = 0; link < links; ++link) {
    const uint32_t parent = link == 0 ? no_body : random.below(link);
    const Vector3 from = parent == no_body ? Vector3(0, 2, 0) : ends[parent], along = 0.4 * any();
    add_rod(tree.scene, parent, from, along, along.cross(any()).normalized());
    ends.push_back(from + along);
  }
  return tree;
}

/* The tree of a scene of hinges as a system of ordinary differential equations. */
class DenseTree {
public:
  explicit DenseTree(const Scene &scene) : tree_(scene, scene.articulations.front(), scene.name), state_(tree_.state())
  {}
  size_t size() const { return tree_.velocities(); }

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
  std::vector<Vector3> centers(const Numbers &y)
  {
    take(y);
    std::vector<Vector3> centers(size());
    const std::vector<LinkPose> poses = tree_.forward_kinematics(state_);
    for (size_t k = 0; k < poses.size(); ++k)
      centers[tree_.links()[k].body] = {poses[k].position[0], poses[k].position[1], poses[k].position[2]};
    return centers;
  }

private:
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

/* Joints are a quarter as fast as substeps, as they are by default. */
Path path_of_world(const Scene &scene, uint32_t frames, uint32_t substeps, const std::string &backend)
{
  Settings settings;
  settings.substeps = substeps;
  settings.joint_hertz = float(0.25 * substeps / double{base_step});
  World world(scene, settings, {backend, {}, false});
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
  for (const TreeScene &tree : {double_pendulum(), tree_of_links(20)}) {
    Scene reduced = tree.scene;
    make_articulations(reduced, reduced.name);
    const Path truth = reference_path(reduced, frames, 2 * steps_of_reference);
    report.uncertainty =
        std::max(report.uncertainty, distance_between(truth, reference_path(reduced, frames, steps_of_reference)));
    for (const bool is_reduced : {true, false}) {
      JointCurve curve{tree.name, is_reduced ? "reduced coordinates" : "maximal coordinates", {}};
      for (uint32_t substeps = 2; substeps <= most_substeps; substeps *= 2)
        curve.points.push_back({substeps, distance_between(truth, path_of_world(is_reduced ? reduced : tree.scene,
                                                                                frames, substeps, backend))});
      report.curves.push_back(curve);
    }
  }
  return report;
}

} // namespace tandem
