/* joint_buffers.h - the joints of a scene as the rows that kernels read, and the pairs of bodies that they keep from
 * colliding. */
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <tandem/scene.h>

#include "host/runtime/interface/features.h"
#include "host/scene/joint_graph.h"
#include "host/scene/staged_uploads.h"
#include "shared/platform.h"

namespace tandem {

/* Whether joints push the body: not the world (no_body), nor what is fixed or kinematic. */
bool can_be_pushed(const Scene &scene, uint32_t body);

/* Whether it has a limit with restitution. */
bool bounces(const Joint &joint);

/* The highest speed, m/s or rad/s, towards which a damper pulls in place of a force. */
constexpr float fastest_damper = 1e12f;
/* The numbers of an axis as kernels read them: shared/joints/axes.h. A force is a damper towards a speed. */
std::array<float4, 3> row_of_axis(const JointAxis &axis);

Features features_of(const Joint &joint);
Features joint_features(const Scene &scene);

/* JointGraph::axes. */
uint32_t most_axes_of_joint(const Scene &scene);

/* By body of the scene: whether a joint keeps it from colliding with another. */
std::vector<bool> joined_bodies(const Scene &scene);

/* The entries of JointGraph::joined_pairs. */
uint32_t joined_pair_entries(const Scene &scene);

/* How many entries of the table of joined pairs are in use while these joints are awake. */
uint32_t joined_pair_entries(const Scene &scene, const JointGraph &graph, std::span<const uint32_t> awake);

/* joints: by their places. room: for bodies, in the buffers. */
void stage_joints(StagedUploads &uploads, const Scene &scene, const JointGraph &graph, std::span<const uint32_t> joints,
                  std::span<const uint32_t> index_of_body, size_t room);

/* Of these the axes alone. axes: JointGraph::axes. */
void stage_axes(StagedUploads &uploads, const Scene &scene, std::span<const uint32_t> joints, uint32_t axes);

/* The axes of one joint, which has the kinds of axes that it had. joints: how many there are. */
void stage_axes_at(StagedUploads &uploads, const Joint &joint, uint32_t place, size_t joints);

/* What changes as bodies move in the buffers: the bodies of the joints that are awake, which come first, and the table
 * of joined pairs. index_of_body: of each body of the scene. first_pair: of body_filter, where the table begins. */
void stage_bodies_of_joints(StagedUploads &uploads, const Scene &scene, const JointGraph &graph,
                            std::span<const uint32_t> awake, std::span<const uint32_t> index_of_body,
                            uint32_t first_pair);

/* The other direction: the joints of each body that joints push. room: for bodies, in the buffers. */
void stage_joints_of_bodies(StagedUploads &uploads, const Scene &scene, std::span<const uint32_t> awake,
                            std::span<const uint32_t> index_of_body, size_t room);

} // namespace tandem
