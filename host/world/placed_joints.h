/* placed_joints.h - puts joints into a world in place of others, with their colours and their order, and takes them out
 * again unless they are kept: what comes after may lack memory, and a call takes effect completely or not at all. */
#pragma once

#include <utility>
#include <vector>

#include "host/world/implementation.h"

namespace tandem {

/* The joints of a world, in place of others unless they are kept. */
class World::Implementation::PlacedJoints {
public:
  /* graph: that of the joints. */
  PlacedJoints(Implementation &world, std::vector<Joint> joints, JointGraph graph)
      : world_(world), joints_(std::move(joints)), graph_(std::move(graph))
  {
    world.scene.joints.swap(joints_);
    try {
      order_ = JointOrder(world.scene, graph_);
      order_.put_to_sleep([&](uint32_t joint) { return world.is_joint_asleep(joint); });
    } catch (...) {
      world.scene.joints.swap(joints_);
      throw;
    }
    exchange();
  }
  ~PlacedJoints()
  {
    if (kept_) return;
    world_.scene.joints.swap(joints_);
    exchange();
    world_.plan_joints();
  }
  PlacedJoints(const PlacedJoints &) = delete;
  PlacedJoints &operator=(const PlacedJoints &) = delete;
  void keep() noexcept { kept_ = true; }
  const std::vector<Joint> &joints_before() const { return joints_; }
  const JointGraph &graph_before() const { return graph_; }

private:
  void exchange() noexcept
  {
    std::swap(world_.joint_graph, graph_);
    std::swap(world_.joint_order, order_);
  }

  Implementation &world_;
  std::vector<Joint> joints_;
  JointGraph graph_;
  JointOrder order_;
  bool kept_ = false;
};

} // namespace tandem
