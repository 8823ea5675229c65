/* joint_order.h - the places of joints in the buffers while some of them sleep.
 *
 *   | colour 0 | colour 1 | ... | overflow | asleep |      kernels of a step run over the joints before those asleep
 *
 * A joint sleeps with its bodies; one that is not enabled sleeps always. Those awake stand in the order of the graph
 * (host/scene/joint_graph.h), and those asleep as they came. Falling asleep and waking cost what is awake or moves, and
 * nothing that sleeps on.
 */
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <tandem/scene.h>

#include "host/scene/joint_graph.h"
#include "shared/counts.h"

namespace tandem {

class JointOrder {
public:
  JointOrder() = default;
  JointOrder(const Scene &scene, const JointGraph &graph);

  std::span<const uint32_t> joints() const { return joints_; } /* by place */
  std::span<const uint32_t> awake() const { return joints().first(starts_.back()); }
  /* As JointGraph::starts, of those awake. */
  const std::vector<uint32_t> &starts() const { return starts_; }
  /* As JointGraph::colors and link_colors, of those awake. */
  uint32_t colors() const { return colors_from(0); }
  uint32_t link_colors() const { return colors_from(COLOR_OVERFLOW + 1); }
  uint32_t place_of(uint32_t joint) const { return place_[joint]; }
  std::span<const uint32_t> of_body(uint32_t body) const; /* those that are enabled */

  /* Rows that move, all at once. Those that fall asleep are among them, wherever they go, because steps leave the rows
   * of sleepers on both sides of what they hand on. */
  struct Moves {
    std::vector<uint32_t> from, to;
  };
  Moves put_to_sleep(const std::function<bool(uint32_t joint)> &sleeps);
  Moves wake(std::vector<uint32_t> joints); /* each once, and all asleep */
  /* joints: all of them by place, of which the first `awake` are awake. */
  Moves take(std::vector<uint32_t> joints, size_t awake);
  /* Whether take() may be given these. */
  bool is_order(std::span<const uint32_t> joints, size_t awake) const;

private:
  Moves put(std::vector<uint32_t> first, size_t awake, size_t all_from);
  void find_starts(size_t awake);
  uint32_t colors_from(uint32_t first) const;

  std::vector<uint32_t> joints_, place_, starts_;
  std::vector<uint32_t> rank_, colors_;   /* in the graph: the place of each joint; JointGraph::starts */
  std::vector<uint32_t> of_body_, first_; /* the joints of bodies; the first one of each body, and the end */
};

} // namespace tandem
