/* articulations.cpp - the functions of shared/articulations/ in double, for programs that ask about a tree. */
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include <tandem/articulations.h>

#include "host/scene/articulation_order.h"
#include "host/scene/link_rows.h"

#define TANDEM_REFERENCE
namespace tandem::in_double {
#include "shared/articulations/dense.h"
#include "shared/articulations/free_motion.h"
#include "shared/articulations/inverse_dynamics.h"
#include "shared/platform.h"
} // namespace tandem::in_double

namespace tandem {

using namespace in_double;
using Triple = std::array<double, 3>;
using Quadruple = std::array<double, 4>;

namespace {

float4 row(double x, double y, double z, double w) { return {x, y, z, w}; }
template <class Vector> float4 row_of(const Vector &v, double w) { return row(v[0], v[1], v[2], w); }
/* Of unit length to the rounding of doubles, since a scene has floats. */
float4 row_of(const Quat &q)
{
  double s = 0;
  for (const float x : q) s += double(x) * x;
  s = 1 / std::sqrt(s);
  return row(q[0] * s, q[1] * s, q[2] * s, q[3] * s);
}
quat quat_of(const Quat &q)
{
  const float4 r = row_of(q);
  return make_quat(r.x, r.y, r.z, r.w);
}
template <class Vector> vec3 vec3_of(const Vector &v) { return make_vec3(v[0], v[1], v[2]); }
Triple triple_of(vec3 v) { return {v.x, v.y, v.z}; }
vec3 sum_of(double_float3 p) { return add(p.high, p.low); }

} // namespace

struct ArticulationTree::Tables {
  std::vector<OrderedLink> ordered;
  std::vector<ArticulationLink> links;
  std::vector<Body> bodies; /* of the links */
  std::vector<uint> code, first;
  std::vector<float4> constants, ranges;
  Triple ground{0, 0, 0}; /* frame a of a root that is held */
  vec3 gravity;
  size_t velocities = 0;

  Tables(const Scene &scene, const Articulation &articulation, const std::string &where)
      : ordered(ordered_links_of(scene, articulation, where)), gravity(vec3_of(scene.gravity))
  {
    for (const OrderedLink &l : ordered) add_link(scene, l);
  }

  bool is_free() const { return ordered.front().is_free; }

private:
  void add_link(const Scene &scene, const OrderedLink &l)
  {
    const LinkRows rows = rows_of_link(scene, l);
    code.push_back(rows.code);
    first.push_back(l.link.first_velocity);
    links.push_back(l.link);
    bodies.push_back(scene.bodies[l.link.body]);
    velocities += l.link.velocities;
    for (const auto &numbers : rows.numbers) constants.push_back(row(numbers[0], numbers[1], numbers[2], numbers[3]));
    constants.resize(links.size() * LINK_ROWS, row(0, 0, 0, 0));
    ranges.push_back(row(0, 0, 0, 0));
    if (links.size() == 1) ground = rows.ground;
  }

  friend class ArticulationTree;
};

namespace {

void require_length(const char *what, size_t length, size_t needed)
{
  if (length != needed)
    throw InputError(fmt::format("articulation: {} {} are given; {} are needed", length, what, needed));
}

/* The tables of one question. */
struct Posed {
  template <class Tables> Posed(const Tables &tables, const ArticulationState &s)
  {
    const size_t links = tables.links.size();
    require_length("coordinates", s.coordinates.size(), links);
    require_length("velocities", s.velocities.size(), tables.velocities);
    state.resize(links * STATE_ROWS);
    work.resize(links * WORK_ROWS);
    next.resize(links);
    root.resize(ROOT_ROWS);
    t = {tables.code.data(),
         tables.constants.data(),
         tables.ranges.data(),
         state.data(),
         root.data(),
         work.data(),
         next.data(),
         nullptr, /* no table of paths */
         nullptr,
         nullptr,
         place_beside(0u, 0u, 1u),
         0u,
         0u,
         uint(links),
         0u,
         0u,
         0u,
         0u,
         uint(links)};
    for (uint k = 0; k < links; ++k) {
      const Quadruple &q = s.coordinates[k];
      store_state(1, &t, k, STATE_JOINT_POSITION, make_vec4(q[0], q[1], q[2], q[3]));
    }
    root[ROOT_POSITION] = row_of(tables.is_free() ? s.root_position : tables.ground, 0);
    root[ROOT_POSITION + 1] = row(0, 0, 0, 0);
    set(tables.links, s.velocities, STATE_JOINT_VELOCITY, ROOT_LINEAR_VELOCITY);
    prepare_tree(&t, 0);
  }

  void set(const std::vector<ArticulationLink> &links, std::span<const double> numbers, uint state_row, uint root_row)
  {
    for (uint k = 0; k < links.size(); ++k) {
      const auto [angular, linear] = numbers_of(links[k], numbers);
      store_state(1, &t, k, state_row, make_vec4(angular[0], angular[1], angular[2], 0));
      if (links[k].velocities == 6) root[root_row] = row_of(linear, 0);
    }
  }
  /* Those of a link in its up to two rows. */
  static std::array<Triple, 2> numbers_of(const ArticulationLink &l, std::span<const double> numbers)
  {
    std::array<Triple, 2> rows{};
    for (uint32_t n = 0; n < l.velocities; ++n) rows[n / 3][n % 3] = numbers[l.first_velocity + n];
    return rows;
  }
  std::vector<double> numbers(const std::vector<ArticulationLink> &links, size_t count, uint work_row) const
  {
    std::vector<double> all(count);
    for (uint k = 0; k < links.size(); ++k) {
      const spatial_force f = load_force(&t, k, work_row);
      const std::array<Triple, 2> rows{triple_of(f.moment), triple_of(f.force)};
      for (uint32_t n = 0; n < links[k].velocities; ++n) all[links[k].first_velocity + n] = rows[n / 3][n % 3];
    }
    return all;
  }

  Posed(const Posed &) = delete; /* t points into the vectors */
  Posed &operator=(const Posed &) = delete;

  std::vector<float4> state, root, work;
  std::vector<uint> next;
  articulation t;
};

} // namespace

ArticulationTree::ArticulationTree(const Scene &scene, const Articulation &articulation, const std::string &where)
    : tables_(std::make_unique<Tables>(scene, articulation, where))
{}
ArticulationTree::ArticulationTree(ArticulationTree &&) noexcept = default;
ArticulationTree &ArticulationTree::operator=(ArticulationTree &&) noexcept = default;
ArticulationTree::~ArticulationTree() = default;

std::span<const ArticulationLink> ArticulationTree::links() const { return tables_->links; }
size_t ArticulationTree::velocities() const { return tables_->velocities; }

namespace {

quat conjugate_of(quat q) { return make_quat(-q.x, -q.y, -q.z, q.w); }

/* A body as a parent: what stands still at a root that is held. */
struct Placed {
  vec3 position, linear, angular;
  quat turn;
};
Placed placed(const Body &body)
{
  return {vec3_of(body.position), vec3_of(body.linear_velocity), vec3_of(body.angular_velocity),
          quat_of(body.orientation)};
}

Quadruple coordinates_of(const OrderedLink &l, quat relative, vec3 gap)
{
  if (l.is_free || l.type == JointType::ball) return {relative.x, relative.y, relative.z, relative.w};
  if (l.type == JointType::hinge) return {twist_of(relative), 0, 0, 0};
  return {l.type == JointType::slider ? gap.x : 0.0, 0, 0, 0};
}

} // namespace

ArticulationState ArticulationTree::state() const
{
  const Tables &tables = *tables_;
  ArticulationState s;
  s.velocities.resize(tables.velocities);
  for (size_t k = 0; k < tables.links.size(); ++k) {
    const OrderedLink &l = tables.ordered[k];
    const float4 *constants = &tables.constants[k * LINK_ROWS];
    const bool is_root = l.link.parent == ArticulationLink::none;
    const Placed own = placed(tables.bodies[k]);
    const Placed parent = is_root ? Placed{vec3_of(tables.ground), zero3(), zero3(), make_quat(0, 0, 0, 1)}
                                  : placed(tables.bodies[l.link.parent]);
    const float4 qa = constants[LINK_FRAME_A_ORIENTATION], qb = constants[LINK_FRAME_B_ORIENTATION],
                 pa = constants[LINK_FRAME_A], pb = constants[LINK_FRAME_B];
    const quat a = quat_multiply(parent.turn, make_quat(qa.x, qa.y, qa.z, qa.w));
    const quat b = quat_multiply(own.turn, make_quat(qb.x, qb.y, qb.z, qb.w));
    const mat3 axes = rotation_of(a);
    const vec3 arm_b = rotate(rotation_of(own.turn), make_vec3(pb.x, pb.y, pb.z));
    const vec3 arm_a = rotate(rotation_of(parent.turn), make_vec3(pa.x, pa.y, pa.z));
    const vec3 at_b = add(subtract(own.position, parent.position), arm_b);
    s.coordinates.push_back(
        coordinates_of(l, quat_multiply(conjugate_of(a), b), rotate_back(axes, subtract(at_b, arm_a))));
    if (l.is_free) s.root_position = triple_of(own.position);
    const vec3 angular = rotate_back(axes, subtract(own.angular, parent.angular));
    const vec3 rate =
        subtract(add(own.linear, cross3(own.angular, arm_b)), add(parent.linear, cross3(parent.angular, at_b)));
    const Triple linear = triple_of(l.is_free ? own.linear : rotate_back(axes, rate)),
                 turning = triple_of(l.is_free ? own.angular : angular);
    const Triple &low = !l.is_free && l.type == JointType::slider ? linear : turning;
    for (uint32_t n = 0; n < l.link.velocities; ++n)
      s.velocities[l.link.first_velocity + n] = n < 3 ? low[n] : linear[n - 3];
  }
  return s;
}

std::vector<LinkPose> ArticulationTree::forward_kinematics(const ArticulationState &state) const
{
  const Posed posed(*tables_, state);
  std::vector<LinkPose> poses;
  for (uint k = 0; k < tables_->links.size(); ++k) {
    const vec4 q = load_work(&posed.t, k, WORK_ORIENTATION);
    const spatial_motion m = load_motion(&posed.t, k, WORK_VELOCITY);
    poses.push_back({triple_of(sum_of(link_position(&posed.t, k))),
                     {q.x, q.y, q.z, q.w},
                     triple_of(m.linear),
                     triple_of(m.angular)});
  }
  return poses;
}

std::vector<double> ArticulationTree::forward_dynamics(const ArticulationState &state,
                                                       std::span<const double> forces) const
{
  require_length("forces", forces.size(), tables_->velocities);
  Posed posed(*tables_, state);
  posed.set(tables_->links, forces, STATE_JOINT_FORCE, ROOT_LINEAR_FORCE);
  /* The inertial forces first, since the velocities that they belong to are those of the state. */
  load_inertial_forces(&posed.t, 1);
  std::vector<spatial_force> inertial;
  for (uint k = 0; k < tables_->links.size(); ++k) inertial.push_back(load_force(&posed.t, k, WORK_FORCE));
  load_outer_forces(&posed.t, tables_->gravity, 1);
  for (uint k = 0; k < tables_->links.size(); ++k) add_to_force(1, &posed.t, k, WORK_FORCE, inertial[k]);
  push_links_and_joints(&posed.t);
  settle_tree(&posed.t);
  std::vector<double> accelerations(tables_->velocities);
  for (uint k = 0; k < tables_->links.size(); ++k) {
    const ArticulationLink &l = tables_->links[k];
    const vec4 now = load_state(&posed.t, k, STATE_JOINT_VELOCITY), linear = load_root(&posed.t, ROOT_LINEAR_VELOCITY);
    const std::array<Triple, 2> rows{triple_of(xyz(now)), triple_of(xyz(linear))};
    for (uint32_t n = 0; n < l.velocities; ++n)
      accelerations[l.first_velocity + n] = rows[n / 3][n % 3] - state.velocities[l.first_velocity + n];
  }
  return accelerations;
}

std::vector<double> ArticulationTree::inverse_dynamics(const ArticulationState &state,
                                                       std::span<const double> accelerations) const
{
  require_length("accelerations", accelerations.size(), tables_->velocities);
  const Posed posed(*tables_, state);
  for (uint k = 0; k < tables_->links.size(); ++k) {
    const auto [angular, linear] = Posed::numbers_of(tables_->links[k], accelerations);
    store_force(1, &posed.t, k, WORK_PENDING, {vec3_of(angular), vec3_of(linear)});
  }
  find_joint_forces(&posed.t, tables_->gravity);
  return posed.numbers(tables_->links, tables_->velocities, WORK_PENDING);
}

std::vector<double> ArticulationTree::mass_matrix(const ArticulationState &state) const
{
  const Posed posed(*tables_, state);
  std::vector<double> matrix(tables_->velocities * tables_->velocities);
  find_mass_matrix(&posed.t, tables_->first.data(), uint(tables_->velocities), matrix.data());
  return matrix;
}

std::vector<double> ArticulationTree::jacobian(const ArticulationState &state, uint32_t link,
                                               const std::array<double, 3> &point) const
{
  if (link >= tables_->links.size())
    throw InputError(
        fmt::format("articulation: link {} does not exist; the tree has {} links", link, tables_->links.size()));
  const Posed posed(*tables_, state);
  const vec4 q = load_work(&posed.t, link, WORK_ORIENTATION);
  const vec3 arm = rotate(rotation_of(quat_from(q)), vec3_of(point));
  std::vector<double> matrix(6 * tables_->velocities);
  find_jacobian(&posed.t, tables_->first.data(), uint(tables_->velocities), link, arm, matrix.data());
  return matrix;
}

} // namespace tandem
