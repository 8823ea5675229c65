/* sleeping_joints.cpp - joints fall asleep and wake with their bodies: their rows change places, and what they say of
 * bodies follows these (host/world/joint_order.h). */
#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "host/pipeline/layout.h"
#include "host/pipeline/scene_counts.h"
#include "host/scene/articulation_buffers.h"
#include "host/scene/joint_buffers.h"
#include "host/world/implementation.h"

namespace tandem {

/* All but the bodies, which tell_joints() gives anew. */
std::vector<BodyRows> World::Implementation::joint_rows(const std::vector<bool> &touched) const
{
  std::vector<BodyRows> rows;
  for (size_t i = 0; i < touched.size(); ++i) {
    const Buffer buffer = buffer_at(i);
    const bool is_of_scene = row_of(buffer).lifetime == Lifetime::SCENE && has_rows_of_joints(row_of(buffer));
    const bool tells_bodies = buffer == Buffer::joint_a || buffer == Buffer::joint_b || buffer == Buffer::body_joint;
    if (is_of_scene && is_filled(touched, buffer) && !tells_bodies) rows.push_back({buffer, {buffer}});
  }
  for (const CarriedBuffer &carried : buffers.carried())
    if (is_filled(touched, carried.now) && has_rows_of_joints(row_of(carried.now)))
      rows.push_back({carried.now, {carried.now, carried.previous}});
  return rows;
}

void World::Implementation::launch_moves_of_joints(Launcher &to, const BodyRows &rows, uint32_t most) const
{
  const BufferRow &row = row_of(rows.from);
  if (row.capacity == Capacity::JOINTS) move_body_rows(to, rows, COUNT_LENGTH, most);
  else
    move_planes(to, rows, {row.per_item * joint_graph.axes, static_cast<uint32_t>(scene.joints.size())}, COUNT_LENGTH,
                most);
}

/* carried: also the rows that steps hand on. */
void World::Implementation::move_joint_rows(const JointOrder::Moves &moves, bool carried)
{
  if (moves.from.empty()) return;
  const auto moved = static_cast<uint32_t>(moves.from.size());
  memory.upload(Buffer::move_from, moves.from.data(), moved * sizeof(uint32_t));
  memory.upload(Buffer::move_to, moves.to.data(), moved * sizeof(uint32_t));
  set_length(memory, moved);
  for (const BodyRows &rows : joint_rows(buffers.needs().touched))
    if (carried || !is_carried(row_of(rows.from).lifetime)) launch_moves_of_joints(launcher, rows, moved);
}

/* Tells kernels which articulations are awake with all of their links, and where these are. */
void World::Implementation::tell_articulations()
{
  if (scene.articulations.empty()) return;
  StagedUploads uploads;
  stage_bodies_of_links(uploads, links, index_of_body, plan.bodies, slots.status(), special.awake);
  uploads.write(memory);
}

/* Tells kernels which joints are awake and where their bodies are. To be called when one of both has changed. */
void World::Implementation::tell_joints()
{
  if (scene.joints.empty() && scene.articulations.empty()) return;
  StagedUploads uploads;
  stage_bodies_of_joints(uploads, scene, joint_graph, joint_order.awake(), index_of_body, first_joined_pair(sizes()));
  if (special.features & (FEATURE_AVBD | FEATURE_SPLIT_JOINTS))
    stage_joints_of_bodies(uploads, scene, joint_order.awake(), index_of_body, plan.bodies);
  stage_joints_of_couplings(uploads, scene, coupling_graph, joint_order.awake());
  if (!scene.articulations.empty())
    stage_bodies_of_links(uploads, links, index_of_body, plan.bodies, slots.status(), special.awake);
  for (const auto &[entry, value] : joint_entries_of(joint_order.starts()))
    uploads.add_count(static_cast<uint32_t>(entry), value);
  stage_parameters(uploads);
  uploads.write(memory);
  plan_joints();
}

void World::Implementation::plan_joints() noexcept
{
  const std::vector<uint32_t> &starts = joint_order.starts();
  plan.joint_colors = joint_order.colors();
  plan.link_joint_colors = joint_order.link_colors();
  plan.joint_axes = joint_graph.axes;
  std::copy(starts.begin(), starts.end(), plan.known.begin() + JOINT_COLOR_START);
  plan.known[COUNT_JOINTS] = plan.known[COUNT_COMMIT_JOINTS] = starts.back();
  const std::vector<uint32_t> &of_couplings = coupling_graph.starts;
  std::copy(of_couplings.begin(), of_couplings.end(), plan.known.begin() + COUPLING_COLOR_START);
  plan.known[COUNT_COUPLINGS] = plan.known[COUNT_COMMIT_COUPLINGS] = of_couplings.back();
}

/* A joint that is a coordinate of an articulation and no more has none. */
bool World::Implementation::has_rows(uint32_t joint) const
{
  const std::vector<uint32_t> &without = joint_graph.without_rows;
  return scene.joints[joint].enabled && !std::binary_search(without.begin(), without.end(), joint);
}

/* One of its bodies lies among the sleepers; the other one does, too, unless it cannot sleep. */
bool World::Implementation::is_joint_asleep(uint32_t joint) const
{
  if (!scene.joints[joint].enabled) return true;
  const auto sleeps = [&](uint32_t body) { return body != no_body && index_of_body[body] >= special.awake; };
  return sleeps(scene.joints[joint].body_a) || sleeps(scene.joints[joint].body_b);
}

/* Bodies have fallen asleep and lie behind those awake. */
void World::Implementation::put_joints_to_sleep()
{
  if (joint_order.awake().empty() && scene.articulations.empty()) return;
  move_joint_rows(joint_order.put_to_sleep([&](uint32_t joint) { return is_joint_asleep(joint); }), true);
  tell_joints();
}

/* These bodies have woken and lie among those awake. */
void World::Implementation::wake_joints(std::span<const uint32_t> of_slots)
{
  std::vector<uint32_t> woken;
  for (const uint32_t slot : of_slots) {
    const std::span<const uint32_t> joints = joint_order.of_body(slot);
    std::copy_if(joints.begin(), joints.end(), std::back_inserter(woken),
                 [&](uint32_t joint) { return has_rows(joint); });
  }
  if (woken.empty() && scene.articulations.empty()) return;
  std::sort(woken.begin(), woken.end());
  woken.erase(std::unique(woken.begin(), woken.end()), woken.end());
  move_joint_rows(joint_order.wake(std::move(woken)), true);
  tell_joints();
}

/* The islands that sleep and have a joint with the body. */
std::set<uint32_t> World::Implementation::islands_joined_to(uint32_t slot) const
{
  std::set<uint32_t> islands;
  for (const uint32_t joint : joint_order.of_body(slot))
    for (const uint32_t body : {scene.joints[joint].body_a, scene.joints[joint].body_b})
      if (body != no_body && sleepers.sleeps(body)) islands.insert(sleepers.island_of(body));
  return islands;
}

/* Whether its bodies sleep in one island, or at most one of them can sleep. */
bool World::Implementation::sleeps_as_one(uint32_t joint) const
{
  const auto can_sleep = [&](uint32_t body) {
    return can_be_pushed(scene, body) && slots.status()[body] == BodyStatus::present;
  };
  const auto [a, b] = std::pair(scene.joints[joint].body_a, scene.joints[joint].body_b);
  if (!can_sleep(a) || !can_sleep(b)) return true;
  if (!sleepers.sleeps(a) || !sleepers.sleeps(b)) return sleepers.sleeps(a) == sleepers.sleeps(b);
  return sleepers.island_of(a) == sleepers.island_of(b);
}

/* joints: as a snapshot has them; empty: nobody sleeps. */
void World::Implementation::take_joint_order(std::vector<uint32_t> joints)
{
  if (joints.empty() && (sleepers.empty() || scene.joints.empty())) return;
  for (uint32_t joint = 0; joint < scene.joints.size(); ++joint)
    if ((has_rows(joint) || is_in_tree(joint)) && !sleeps_as_one(joint))
      throw InputError(
          fmt::format("snapshot: the bodies of joint {} do not sleep in one island; the file is damaged", joint));
  const auto stands_behind = [&](uint32_t joint) {
    return joint < scene.joints.size() && (is_joint_asleep(joint) || !has_rows(joint));
  };
  const auto asleep = std::find_if(joints.begin(), joints.end(), stands_behind);
  const auto awake = static_cast<size_t>(asleep - joints.begin());
  const bool others_sleep = std::all_of(asleep, joints.end(), stands_behind);
  if (!others_sleep || !joint_order.is_order(joints, awake))
    throw InputError("snapshot: the joints that sleep are not those of the bodies that do; the file is damaged");
  joint_order.take(std::move(joints), awake);
  StagedUploads uploads;
  stage_joints(uploads, scene, joint_graph, joint_order.joints(), index_of_body, plan.bodies);
  uploads.write(memory);
  tell_joints();
}

} // namespace tandem
