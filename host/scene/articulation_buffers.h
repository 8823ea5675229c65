/* articulation_buffers.h - the articulations of a scene as the tables that kernels read, and what a step has no
 * articulations with. */
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <tandem/scene.h>
#include <tandem/settings.h>

#include "host/scene/body_status.h"
#include "host/scene/staged_uploads.h"
#include "host/scene/tree_places.h"

namespace tandem {

/* By joint of the scene: whether it is a coordinate of an articulation, so that it holds no bodies as others do. */
std::vector<bool> articulated_joints(const Scene &scene);

/* The links of all articulations. */
constexpr uint32_t no_link = 0xffffffffu;
struct JointedLinks {
  /* By joint of the scene: its articulation, or no_link; the number of its link in that, and the body of the link. */
  std::vector<uint32_t> of_joint, number_of_joint, body_of_joint;
  std::vector<std::vector<uint32_t>> trees; /* the bodies of each articulation */
  std::vector<uint32_t> of_body;            /* by body of the scene: its articulation, or no_link */
  std::vector<bool> bases;                  /* by body: whether a tree stands on it */
  std::vector<TreePlace> places;            /* by articulation */
  TreeRoom room{};                          /* of the tables */
  std::vector<uint32_t> freedoms;           /* by articulation that has a table of paths; of others 0 */
  PathPlaces paths;                         /* shared/articulations/path.h */

  uint32_t most_freedoms() const { return freedoms.empty() ? 0 : *std::max_element(freedoms.begin(), freedoms.end()); }
  bool has_base(uint32_t body) const { return body < bases.size() && bases[body]; }
  bool has_body(uint32_t body) const { return body < of_body.size() && of_body[body] != no_link; }
};
/* The articulations have been validated. */
JointedLinks links_of(const Scene &scene);

bool holds_link(const JointedLinks &links, const Joint &joint);

/* Throws InputError if contacts of links cannot have the material. */
void check_material_beside_links(const Material &material, size_t index, const std::string &where);

/* Throws InputError if a joint that is none of a tree's cannot hold a link as it is. */
void check_joint_beside_links(const JointedLinks &links, const Joint &joint, size_t index, const std::string &where);

/* Throws InputError if a joint of a tree cannot be as it is. */
void check_joint_of_tree(const Joint &joint, size_t index, const std::string &where);

/* The axes of joints of trees; none given: of all. Others than those of trees are passed over. */
void stage_link_axes(StagedUploads &uploads, const Scene &scene, std::span<const uint32_t> joints,
                     const JointedLinks &links);

/* Throws InputError that names the first articulation, joint or body that cannot be simulated. */
void check_articulations(const Scene &scene, const std::string &where);

/* The same of one articulation, as if it were the only one. */
void check_articulation(const Scene &scene, const Articulation &articulation, const std::string &where);

/* Throws InputError if the settings ask for what has no articulations. */
void check_articulations(const Settings &settings, const Scene &scene);

/* The tables of all links but where their bodies are. */
void stage_articulations(StagedUploads &uploads, const Scene &scene, const JointedLinks &links);

/* Which bodies the links are, and which trees kernels run. index_of_body: of each body of the scene. room: for bodies,
 * in the buffers. awake: bodies from this index on sleep. */
void stage_bodies_of_links(StagedUploads &uploads, const JointedLinks &links, std::span<const uint32_t> index_of_body,
                           size_t room, const std::vector<BodyStatus> &status, uint32_t awake);

} // namespace tandem
