/* articulation_buffers.cpp - see articulation_buffers.h. */
#include "host/scene/articulation_buffers.h"

#include <algorithm>

#include <fmt/format.h>

#include <tandem/round_to_float.h>

#include "host/scene/articulation_order.h"
#include "host/scene/body_buffers.h"
#include "host/scene/checker.h"
#include "host/scene/joint_buffers.h"
#include "host/scene/joint_rows.h"
#include "host/scene/link_rows.h"
#include "shared/batching/node_words.h"
#include "shared/counts.h"

namespace tandem {
namespace {

float4 float4_of(const std::array<double, 4> &row)
{
  return {round_to_float(row[0]), round_to_float(row[1]), round_to_float(row[2]), round_to_float(row[3])};
}

/* Whether the drive is a part of the mass matrix: shared/articulations/drives.h. */
bool is_implicit(const JointAxis &axis)
{
  return !axis.motor && (axis.stiffness > 0 || axis.damping > 0) && axis.max_force == JointAxis::unlimited;
}

/* The row with the moments and those of the axis, which follow it. */
std::array<float4, LINK_ROWS - LINK_MOMENTS> axis_rows_of(const Scene &scene, const JointAxis &axis, uint32_t body)
{
  const std::array<double, 3> moments = moments_of_link(scene, scene.bodies[body]);
  const auto axis_row = row_of_axis(axis);
  return {float4_of({moments[0], moments[1], moments[2], is_implicit(axis) ? 1.0 : 0.0}), axis_row[0], axis_row[1],
          axis_row[2]};
}

/* The tables while links are added. */
struct LinkTables {
  std::vector<uint32_t> code, body, place, body_link;
  std::vector<float4> row, ground;

  explicit LinkTables(size_t room)
  {
    for (uint32_t index = 0; index < room; ++index) body_link.insert(body_link.end(), {index, INDEX_NONE, 0});
  }

  /* A tree of which a link is in quarantine has no links for kernels. */
  void add(const Scene &scene, const std::vector<OrderedLink> &links, std::span<const uint32_t> index_of_body,
           const std::vector<BodyStatus> &status)
  {
    const auto number = static_cast<uint32_t>(place.size() / 4);
    const bool is_out = std::any_of(links.begin(), links.end(), [&](const OrderedLink &l) {
      return l.link.body < status.size() && status[l.link.body] == BodyStatus::quarantined;
    });
    const auto count = is_out ? 0u : static_cast<uint32_t>(links.size());
    place.insert(place.end(), {static_cast<uint32_t>(code.size()), 0, 1, count});
    const auto node = index_of_body[links.front().link.body];
    for (uint32_t k = 0; k < links.size(); ++k) {
      const uint32_t index = index_of_body[links[k].link.body];
      body.push_back(index);
      const std::array<uint32_t, LINK_WORDS> words{node, number, k};
      std::copy(words.begin(), words.end(), body_link.begin() + ptrdiff_t{LINK_WORDS} * index);
      add_link(scene, links[k], k == 0);
    }
  }
  void stage(StagedUploads &uploads)
  {
    uploads.add(Buffer::link_code, std::move(code));
    uploads.add(Buffer::link_row, std::move(row));
    uploads.add(Buffer::link_body, std::move(body));
    uploads.add(Buffer::articulation_place, std::move(place));
    uploads.add(Buffer::articulation_ground, std::move(ground));
    uploads.add(Buffer::body_link, std::move(body_link));
  }

private:
  void add_link(const Scene &scene, const OrderedLink &l, bool is_root)
  {
    const LinkRows rows = rows_of_link(scene, l);
    code.push_back(rows.code);
    for (size_t k = 0; k < LINK_MOMENTS; ++k) row.push_back(float4_of(rows.numbers[k]));
    const auto axis = axis_rows_of(scene, l.axis, l.link.body);
    row.insert(row.end(), axis.begin(), axis.end());
    if (!is_root) return;
    const auto position = double_float3_of(rows.ground);
    ground.insert(ground.end(), position.begin(), position.end());
  }
};

/* Refuses what a link, or the joint of one, cannot have within a step. */
class LinkChecks {
public:
  LinkChecks(const Scene &scene, const std::string &where)
      : scene_(scene), where_(where), joints_(articulated_joints(scene)), linked_(scene.bodies.size())
  {}

  void check(const Articulation &articulation, const std::vector<OrderedLink> &links)
  {
    articulation_ = &articulation;
    for (const OrderedLink &l : links) {
      check_body(l.link.body);
      if (l.link.joint != ArticulationLink::none)
        check_joint_of_tree(scene_.joints[l.link.joint], l.link.joint, where_);
    }
  }
  /* Joints and couplings besides those of the trees. */
  void check_others() const
  {
    for (size_t k = 0; k < scene_.joints.size(); ++k)
      for (const uint32_t body : {scene_.joints[k].body_a, scene_.joints[k].body_b})
        if (!joints_[k] && !is_vacant(scene_.joints[k]) && body != no_body && linked_[body])
          refuse(where_, label("joint", k, scene_.joints[k].name),
                 fmt::format("holds body {}, a link, and is no joint of its articulation; only contacts push links "
                             "besides",
                             body));
    for (size_t k = 0; k < scene_.couplings.size(); ++k)
      for (const uint32_t joint : {scene_.couplings[k].joint_a, scene_.couplings[k].joint_b})
        if (joints_[joint])
          refuse(
              where_, label("coupling", k, scene_.couplings[k].name),
              fmt::format("couples joint {}, which is one of an articulation; couplings are of other joints", joint));
    for (size_t k = 0; k < scene_.materials.size(); ++k) check_material_beside_links(scene_.materials[k], k, where_);
  }

private:
  [[noreturn]] void fail(const std::string &what, const std::string &why) const
  {
    const std::string name =
        articulation_->name.empty() ? "articulation" : fmt::format("articulation '{}'", printable(articulation_->name));
    refuse(where_, name, what + " " + why);
  }
  void check_body(uint32_t index)
  {
    const Body &body = scene_.bodies[index];
    const std::string name = label("body", index, body.name);
    if (linked_[index]) fail(name, "is a link of another articulation, too; one tree holds a body");
    linked_[index] = true;
    if (body.linear_damping > 0 || body.angular_damping > 0)
      fail(name, "has damping; joints of a tree have it, as JointAxis::damping");
    if (body.max_linear_speed < JointAxis::unlimited || body.max_angular_speed < JointAxis::unlimited)
      fail(name, "has a highest speed; links have none, joints have JointAxis::max_speed");
    if (body.continuous) fail(name, "is continuous; links are not");
  }
  const Scene &scene_;
  const std::string &where_;
  const Articulation *articulation_ = nullptr;
  std::vector<bool> joints_, linked_;
};

} // namespace

std::vector<bool> articulated_joints(const Scene &scene)
{
  std::vector<bool> joints(scene.joints.size());
  for (const Articulation &articulation : scene.articulations)
    for (const uint32_t joint : articulation.joints)
      if (joint < joints.size()) joints[joint] = true;
  return joints;
}

namespace {

/* The other body of the joint that holds a root. */
void note_base(const Joint &joint, uint32_t root, JointedLinks &links)
{
  const uint32_t base = joint.body_a == root ? joint.body_b : joint.body_a;
  if (base != no_body) links.bases[base] = true;
}

} // namespace

JointedLinks links_of(const Scene &scene)
{
  JointedLinks links;
  if (scene.articulations.empty()) return links;
  links.of_joint.assign(scene.joints.size(), no_link);
  links.body_of_joint.assign(scene.joints.size(), no_body);
  links.of_body.assign(scene.bodies.size(), no_link);
  links.bases.resize(scene.bodies.size());
  for (const Articulation &articulation : scene.articulations) {
    links.trees.emplace_back();
    for (const OrderedLink &l : ordered_links_of(scene, articulation, scene.name)) {
      if (l.link.joint != ArticulationLink::none) {
        if (l.link.parent == ArticulationLink::none) note_base(scene.joints[l.link.joint], l.link.body, links);
        links.of_joint[l.link.joint] = links.count;
        links.body_of_joint[l.link.joint] = l.link.body;
      }
      links.of_body[l.link.body] = static_cast<uint32_t>(links.trees.size() - 1);
      links.trees.back().push_back(l.link.body);
      ++links.count;
    }
  }
  return links;
}

void stage_link_axes(StagedUploads &uploads, const Scene &scene, std::span<const uint32_t> joints,
                     const JointedLinks &links)
{
  const auto stage = [&](uint32_t joint) {
    if (links.of_joint[joint] == no_link) return;
    const auto rows = axis_rows_of(scene, axis_of_tree(scene.joints[joint]), links.body_of_joint[joint]);
    uploads.add_elements(Buffer::link_row, std::vector<float4>(rows.begin(), rows.end()),
                         size_t{links.of_joint[joint]} * LINK_ROWS + LINK_MOMENTS);
  };
  for (const uint32_t joint : joints) stage(joint);
  if (!joints.empty()) return;
  for (uint32_t joint = 0; joint < links.of_joint.size(); ++joint) stage(joint);
}

void check_material_beside_links(const Material &material, size_t index, const std::string &where)
{
  if (material.rolling_friction > 0 || material.spinning_friction > 0)
    refuse(where, label("material", index, material.name),
           "has rolling or spinning friction, and the scene has articulations; contacts of links have neither");
}

void check_joint_of_tree(const Joint &joint, size_t index, const std::string &where)
{
  const Checker check{where, "joint", index, joint.name};
  if (!joint.enabled) check.fail("is not enabled; joints of a tree always are");
  if (joint.break_force < JointAxis::unlimited || joint.break_torque < JointAxis::unlimited)
    check.fail("can break; joints of a tree do not");
  for (const UsedAxis &used : axes_used_by(joint))
    if (used.axis.restitution > 0) check.fail("has a limit that bounces; those of a tree do not");
  if (joint.type == JointType::ball) check_ball_of_tree(joint, index, where);
}

void check_articulations(const Scene &scene, const std::string &where)
{
  if (scene.articulations.empty()) return;
  LinkChecks checks(scene, where);
  for (const Articulation &articulation : scene.articulations)
    checks.check(articulation, ordered_links_of(scene, articulation, where));
  checks.check_others();
}

void check_articulations(const Settings &settings, const Scene &scene)
{
  if (scene.articulations.empty()) return;
  const auto fail = [&](const std::string &why) {
    throw InputError(
        fmt::format("{}: {}; the scene has {} articulations", scene.name, why, scene.articulations.size()));
  };
  if (settings.solver != Solver::soft_step)
    fail(fmt::format("the solver {} has no articulations, soft-step has them", name_of(settings.solver)));
  if (settings.sleeping) fail("links do not sleep, and settings.sleeping is on");
  if (settings.batching != Batching::coloring && settings.batching != Batching::sequential)
    fail(fmt::format("the batching {} has no articulations, coloring and sequential have them",
                     name_of(settings.batching)));
}

void stage_articulations(StagedUploads &uploads, const Scene &scene, std::span<const uint32_t> index_of_body,
                         size_t room, const std::vector<BodyStatus> &status)
{
  LinkTables tables(room);
  for (const Articulation &articulation : scene.articulations)
    tables.add(scene, ordered_links_of(scene, articulation, scene.name), index_of_body, status);
  tables.stage(uploads);
}

} // namespace tandem
