/* worlds_breaks.cpp - joints of a batch that break, each world's by themselves, and are whole again in a world that is
 * reset.
 *
 * A joint that is broken is not enabled. The scene of all worlds says so, and its joints are coloured anew
 * (host/world/joint_calls.cpp): those of a world keep the colours and the order that they have alone, and their places
 * among those of all worlds are looked up again.
 */
#include <algorithm>

#include "host/scene/joint_buffers.h"
#include "host/world/worlds_group.h"

namespace tandem {

const WorldJoints &Worlds::Group::present_joints()
{
  World::Implementation &all = engine();
  if (graph_of_joints != all.graph_number) {
    joints = WorldJoints(all.scene, all.joint_graph, all.coupling_graph, tables.worlds());
    graph_of_joints = all.graph_number;
  }
  return joints;
}

/* Tables of joints are written with what their scene says. */
void Worlds::Group::enable_joints(std::span<const uint32_t> changed, bool enabled)
{
  if (changed.empty()) return;
  write_controls();
  std::vector<Joint> now = engine().scene.joints;
  for (const uint32_t joint : changed) now[joint].enabled = enabled;
  engine().put_joints(std::move(now), engine().joint_slots, changed);
}

void Worlds::Group::mend(std::span<const uint32_t> numbers)
{
  std::vector<uint32_t> broken;
  for (const uint32_t number : numbers)
    for (uint32_t k = 0; k < tables.joints(number); ++k)
      if (const uint32_t joint = tables.first_joint(number) + k; is_broken(joint)) broken.push_back(joint);
  enable_joints(broken, true);
}

bool Worlds::Group::is_broken(uint32_t joint) const
{
  return enabled_at_start[joint] && !engine().scene.joints[joint].enabled;
}

/* Joints that may break are taken as whole. */
Scene Worlds::Group::mended(uint32_t number, Scene scene) const
{
  for (uint32_t k = 0; k < std::min<size_t>(scene.joints.size(), tables.joints(number)); ++k)
    if (enabled_at_start[tables.first_joint(number) + k] && (features_of(scene.joints[k]) & FEATURE_JOINT_BREAKS))
      scene.joints[k].enabled = true;
  return scene;
}

/* Those that are not enabled in the scene of a world that is loaded. */
void Worlds::Group::break_as_in(uint32_t number, const Scene &scene)
{
  std::vector<uint32_t> broken;
  for (uint32_t k = 0; k < scene.joints.size(); ++k)
    if (const uint32_t joint = tables.first_joint(number) + k; enabled_at_start[joint] && !scene.joints[k].enabled)
      broken.push_back(joint);
  enable_joints(broken, false);
}

WorldEvents<JointBreak> Worlds::Group::joint_breaks() const
{
  const std::vector<JointBreak> &breaks = engine().joint_breaks;
  WorldEvents<JointBreak> result;
  result.first.push_back(0);
  size_t at = 0;
  for (uint32_t number = 0; number < count(); ++number) {
    const uint32_t first = tables.first_joint(number), end = first + tables.joints(number);
    for (; at < breaks.size() && breaks[at].joint.index < end; ++at) {
      if (engine().statistics.steps == entered[number]) continue;
      result.all.push_back(breaks[at]);
      result.all.back().joint.index -= first;
    }
    result.first.push_back(result.all.size());
  }
  return result;
}

} // namespace tandem
