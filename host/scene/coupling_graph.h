/* coupling_graph.h - the colours of couplings and the order in which kernels have them, as joint_graph.h has those of
 * joints.
 *
 * A coupling pushes up to four bodies. Those of one colour share none that can be pushed. They have colours of their
 * own, because they are solved after the joints and contacts of a pass; those past the last colour are solved in order.
 * Couplings of two joints of a tree stand behind all of these, tree after tree; their tree solves them
 * (shared/articulations/couplings.h).
 */
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <tandem/scene.h>

#include "host/runtime/interface/features.h"
#include "host/scene/articulation_buffers.h"
#include "host/scene/staged_uploads.h"

namespace tandem {

struct CouplingGraph {
  std::vector<uint32_t> order;  /* couplings of the scene by colour, of one colour by number */
  std::vector<uint32_t> starts; /* in that order: the first of each colour, of those past the last one, and the end */
  uint32_t colors = 0;          /* in use; COLOR_LIMIT + 1 if some are past the last one */
};

/* worlds: of a batch, as of joint_graph_of(); those past the last colour stand world after world. */
CouplingGraph coupling_graph_of(const Scene &scene, uint32_t worlds = 1);

Features coupling_features(const Scene &scene);

/* What does not change while the world runs. */
void stage_couplings(StagedUploads &uploads, const Scene &scene, const CouplingGraph &graph);

/* Those of trees. */
void stage_couplings_of_trees(StagedUploads &uploads, const Scene &scene, const CouplingGraph &graph,
                              const JointedLinks &links);

/* The joints of couplings. awake: joints, by their places. */
void stage_joints_of_couplings(StagedUploads &uploads, const Scene &scene, const CouplingGraph &graph,
                               std::span<const uint32_t> awake);

} // namespace tandem
