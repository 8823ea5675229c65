/* joint_buffers.cpp - see joint_buffers.h. */
#include "host/scene/joint_buffers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include <tandem/round_to_float.h>

#include "host/scene/articulation_buffers.h"
#include "host/scene/body_buffers.h"
#include "host/scene/joint_rows.h"
#include "host/scene/joint_sharing.h"
#include "shared/broadphase/joined_pairs.h"
#include "shared/counts.h"
#include "shared/joints/joint_codes.h"

namespace tandem {
namespace {

uint32_t modes_of(const Joint &joint)
{
  const HeldAxes held = held_by(joint);
  return held.directions | held.rotations << JOINT_ANGULAR_SHIFT;
}

bool is_to_world(const Joint &joint)
{
  return !is_vacant(joint) && (joint.body_a == no_body || joint.body_b == no_body);
}

bool can_break(const Joint &joint) { return std::isfinite(joint.break_force) || std::isfinite(joint.break_torque); }

bool parts_bodies(const Joint &joint) { return !joint.collide && joint.body_a != no_body && joint.body_b != no_body; }

/* Two bodies that a joint keeps from colliding, the higher number first. */
using BodyPair = std::pair<uint32_t, uint32_t>;

std::set<BodyPair> joined_pairs(const Scene &scene)
{
  std::set<BodyPair> pairs;
  for (const Joint &joint : scene.joints)
    if (parts_bodies(joint)) pairs.insert({std::max(joint.body_a, joint.body_b), std::min(joint.body_a, joint.body_b)});
  return pairs;
}

float4 float4_of(const Quat &orientation)
{
  const Quat q = unit(orientation);
  return {q[0], q[1], q[2], q[3]};
}

/* Kernels compute with a number in place of an infinite limit. */
float finite(float x) { return std::clamp(x, -1e30f, 1e30f); }

/* Kernels divide by stiffness and damping; what comes of the least and the largest of floats is none. */
float moderate(float x) { return x > 0 ? std::clamp(x, 1e-30f, 1e30f) : 0; }

/* As kernels have it: negative damping is a motor's. */
struct Damper {
  float damping, target_velocity;
};

/* A force F is a damper c towards the speed F / c. One that the axis has not is so weak that it brakes nothing. */
Damper damper_of(const JointAxis &axis)
{
  if (axis.motor) return {float{DAMPING_OF_MOTOR}, axis.target_velocity};
  const float damping = moderate(std::max(axis.damping, std::abs(axis.force) / fastest_damper));
  return {damping, damping > 0 ? axis.target_velocity + axis.force / damping : axis.target_velocity};
}

/* The planes of the axes of joints, by their places. */
class AxisRows {
public:
  AxisRows(size_t joints, uint32_t axes)
      : joints_(joints), kinds_(joints * axes, uint32_t{JOINT_AXIS_NONE}), rows_(joints * axes * 3)
  {}
  void set(size_t joint, size_t k, const UsedAxis &used)
  {
    kinds_[k * joints_ + joint] = used.kind;
    const std::array<float4, 3> row = row_of_axis(used.axis);
    for (size_t part = 0; part < row.size(); ++part) rows_[(3 * k + part) * joints_ + joint] = row[part];
  }
  void stage(StagedUploads &uploads)
  {
    uploads.add(Buffer::joint_axis_kind, std::move(kinds_));
    uploads.add(Buffer::joint_axis_row, std::move(rows_));
  }

private:
  size_t joints_;
  std::vector<uint32_t> kinds_;
  std::vector<float4> rows_;
};

/* The rows of joints, by their places. */
struct JointRows {
  std::vector<uint32_t> modes;
  std::vector<float4> arm_a, arm_b, frame_a, frame_b, world_frame, limits;

  /* in_tree: what the joint holds is held by its tree. */
  void add(const Joint &joint, const JointSharing &sharing, bool in_tree)
  {
    modes.push_back(in_tree ? 0 : modes_of(joint));
    arm_a.push_back(arm_of(joint.position_a, joint.body_a, sharing.of(joint, joint.body_a)));
    arm_b.push_back(arm_of(joint.position_b, joint.body_b, sharing.of(joint, joint.body_b)));
    frame_a.push_back(float4_of(joint.orientation_a));
    frame_b.push_back(float4_of(joint.orientation_b));
    const auto place = double_float3_of(joint.body_a == no_body ? joint.position_a : joint.position_b);
    world_frame.insert(world_frame.end(), place.begin(), place.end());
    limits.push_back({finite(joint.break_force), finite(joint.break_torque), 0, 0});
  }
  void stage(StagedUploads &uploads)
  {
    uploads.add(Buffer::joint_modes, std::move(modes));
    uploads.add(Buffer::joint_arm_a, std::move(arm_a));
    uploads.add(Buffer::joint_arm_b, std::move(arm_b));
    uploads.add(Buffer::joint_frame_a, std::move(frame_a));
    uploads.add(Buffer::joint_frame_b, std::move(frame_b));
    uploads.add(Buffer::joint_world_frame, std::move(world_frame));
    uploads.add(Buffer::joint_break, std::move(limits));
  }

private:
  static float4 arm_of(const Point &p, uint32_t body, float sharing)
  {
    if (body == no_body) return {0, 0, 0, 1};
    return {round_to_float(p[0]), round_to_float(p[1]), round_to_float(p[2]), sharing};
  }
};

/* Bodies that came since the graph was made have no joints, nor have those that it knows and that are gone since the
 * world went back to a state before them. */
void stage_colors(StagedUploads &uploads, const JointGraph &graph, std::span<const uint32_t> index_of_body, size_t room)
{
  std::vector<uint32_t> colors(2 * room);
  for (size_t body = 0; body < std::min(graph.body_colors.size() / 2, index_of_body.size()); ++body)
    for (size_t word = 0; word < 2; ++word)
      colors[2 * size_t{index_of_body[body]} + word] = graph.body_colors[2 * body + word];
  uploads.add(Buffer::body_joint_colors, std::move(colors));
}

/* The table of broadphase/joined_pairs.h, by the indices of bodies. Pairs of which one sleeps are never looked for. */
class JoinedPairTable {
public:
  JoinedPairTable(const Scene &scene, std::span<const uint32_t> index_of_body, uint32_t entries)
      : scene_(scene), index_of_body_(index_of_body), entries_(entries), words_(2 * size_t{entries}, INDEX_NONE)
  {}
  void add(std::span<const uint32_t> joints)
  {
    for (const uint32_t number : joints)
      if (parts_bodies(scene_.joints[number])) add(scene_.joints[number]);
  }
  std::vector<uint32_t> words() && { return std::move(words_); }

private:
  void add(const Joint &joint)
  {
    const auto [b, a] = std::minmax(index_of_body_[joint.body_a], index_of_body_[joint.body_b]);
    uint32_t k = joined_pair_hash(a, b) & (entries_ - 1);
    const auto is_taken = [&] { return words_[2 * size_t{k}] != INDEX_NONE; };
    while (is_taken() && (words_[2 * size_t{k}] != a || words_[2 * size_t{k} + 1] != b)) k = (k + 1) & (entries_ - 1);
    words_[2 * size_t{k}] = a;
    words_[2 * size_t{k} + 1] = b;
  }

  const Scene &scene_;
  std::span<const uint32_t> index_of_body_;
  uint32_t entries_;
  std::vector<uint32_t> words_;
};

} // namespace

bool bounces(const Joint &joint)
{
  const std::vector<UsedAxis> used = axes_used_by(joint);
  return std::any_of(used.begin(), used.end(), [](const UsedAxis &one) { return one.axis.restitution > 0; });
}

std::array<float4, 3> row_of_axis(const JointAxis &axis)
{
  const Damper damper = damper_of(axis);
  return {
      float4{finite(axis.lower), finite(axis.upper), axis.target_position, damper.target_velocity},
      float4{moderate(axis.stiffness), damper.damping, finite(axis.max_force), axis.friction},
      float4{moderate(axis.limit_stiffness), moderate(axis.limit_damping), finite(axis.max_speed), axis.restitution}};
}

bool can_be_pushed(const Scene &scene, uint32_t body)
{
  return body != no_body && scene.bodies[body].type == BodyType::dynamic;
}

void stage_axes(StagedUploads &uploads, const Scene &scene, std::span<const uint32_t> joints, uint32_t axes)
{
  AxisRows rows(joints.size(), axes);
  for (size_t i = 0; i < joints.size(); ++i) {
    const std::vector<UsedAxis> used = axes_used_by(scene.joints[joints[i]]);
    for (size_t k = 0; k < used.size(); ++k) rows.set(i, k, used[k]);
  }
  rows.stage(uploads);
}

void stage_axes_at(StagedUploads &uploads, const Joint &joint, uint32_t place, size_t joints)
{
  const std::vector<UsedAxis> used = axes_used_by(joint);
  for (size_t k = 0; k < used.size(); ++k) {
    const std::array<float4, 3> row = row_of_axis(used[k].axis);
    for (size_t part = 0; part < row.size(); ++part)
      uploads.add_elements(Buffer::joint_axis_row, std::vector<float4>{row[part]}, (3 * k + part) * joints + place);
  }
}

Features features_of(const Joint &joint)
{
  Features features = FEATURE_JOINTS;
  if (modes_of(joint) != JOINT_XYZ) features |= FEATURE_JOINT_FRAMES;
  if (!axes_used_by(joint).empty()) features |= FEATURE_JOINT_AXES | FEATURE_JOINT_FRAMES;
  if (bounces(joint)) features |= FEATURE_JOINT_BOUNCES;
  if (can_break(joint)) features |= FEATURE_JOINT_BREAKS;
  if (is_to_world(joint)) features |= FEATURE_JOINTS_TO_WORLD;
  if (parts_bodies(joint)) features |= FEATURE_JOINED_PAIRS | FEATURE_FILTER;
  return features;
}

Features joint_features(const Scene &scene)
{
  Features features = 0;
  for (const Joint &joint : scene.joints) features |= features_of(joint);
  return features;
}

uint32_t most_axes_of_joint(const Scene &scene)
{
  size_t most = 0;
  for (const Joint &joint : scene.joints) most = std::max(most, axes_used_by(joint).size());
  return static_cast<uint32_t>(most);
}

std::vector<bool> joined_bodies(const Scene &scene)
{
  std::vector<bool> joined(scene.joints.empty() ? 0 : scene.bodies.size());
  for (const Joint &joint : scene.joints)
    if (parts_bodies(joint)) joined[joint.body_a] = joined[joint.body_b] = true;
  return joined;
}

uint32_t joined_pair_entries(const Scene &scene)
{
  const size_t pairs = joined_pairs(scene).size();
  return pairs > 0 ? static_cast<uint32_t>(std::bit_ceil(2 * pairs)) : 0;
}

/* Half of them at least stay empty. A scene without a table has none at any time. */
uint32_t joined_pair_entries(const Scene &scene, const JointGraph &graph, std::span<const uint32_t> awake)
{
  const auto parts = [&](uint32_t joint) { return parts_bodies(scene.joints[joint]); };
  const auto pairs = static_cast<size_t>(std::count_if(awake.begin(), awake.end(), parts) +
                                         std::count_if(graph.without_rows.begin(), graph.without_rows.end(), parts));
  return static_cast<uint32_t>(std::min<size_t>(std::bit_ceil(2 * std::max<size_t>(pairs, 1)), graph.joined_pairs));
}

void stage_joints(StagedUploads &uploads, const Scene &scene, const JointGraph &graph, std::span<const uint32_t> joints,
                  std::span<const uint32_t> index_of_body, size_t room)
{
  if (scene.joints.empty()) return;
  JointRows rows;
  const JointSharing sharing(scene);
  const std::vector<bool> in_trees = articulated_joints(scene);
  for (const uint32_t joint : joints) rows.add(scene.joints[joint], sharing, in_trees[joint]);
  rows.stage(uploads);
  stage_axes(uploads, scene, joints, graph.axes);
  stage_colors(uploads, graph, index_of_body, room);
}

void stage_bodies_of_joints(StagedUploads &uploads, const Scene &scene, const JointGraph &graph,
                            std::span<const uint32_t> awake, std::span<const uint32_t> index_of_body,
                            uint32_t first_pair)
{
  const auto index = [&](uint32_t body) { return body == no_body ? INDEX_NONE : index_of_body[body]; };
  std::vector<uint32_t> a, b;
  for (const uint32_t joint : awake) {
    a.push_back(index(scene.joints[joint].body_a));
    b.push_back(index(scene.joints[joint].body_b));
  }
  uploads.add(Buffer::joint_a, std::move(a));
  uploads.add(Buffer::joint_b, std::move(b));
  const uint32_t entries = joined_pair_entries(scene, graph, awake);
  if (entries == 0) return;
  JoinedPairTable table(scene, index_of_body, entries);
  table.add(awake);
  table.add(graph.without_rows);
  uploads.add_elements(Buffer::body_filter, std::move(table).words(), first_pair);
}

void stage_joints_of_bodies(StagedUploads &uploads, const Scene &scene, std::span<const uint32_t> awake,
                            std::span<const uint32_t> index_of_body, size_t room)
{
  const auto visit = [&](const auto &at) {
    for (uint32_t place = 0; place < awake.size(); ++place)
      for (const uint32_t side : {0u, 1u}) {
        const Joint &joint = scene.joints[awake[place]];
        const uint32_t body = side == 0 ? joint.body_a : joint.body_b;
        if (can_be_pushed(scene, body)) at(index_of_body[body], 2 * place + side);
      }
  };
  std::vector<uint32_t> start(room + 1), next;
  visit([&](uint32_t body, uint32_t) { ++start[body + 1]; });
  std::partial_sum(start.begin(), start.end(), start.begin());
  next = start;
  std::vector<uint32_t> entries(start.back());
  visit([&](uint32_t body, uint32_t entry) { entries[next[body]++] = entry; });
  uploads.add(Buffer::body_joint, std::move(entries));
  uploads.add(Buffer::body_joint_start, std::move(start));
}

} // namespace tandem
