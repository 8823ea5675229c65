/* articulations.h - bodies whose joints form a tree, described by the coordinates of these joints (reduced
 * coordinates), and what programs ask of such a tree: where its links are, which forces its joints need, its mass
 * matrix and the Jacobians of its points. All of it is computed in double precision from the functions that kernels
 * run, shared/articulations/.
 */
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <tandem/articulation.h>
#include <tandem/export.h>
#include <tandem/no_body.h>
#include <tandem/scene.h>

namespace tandem {

/* A link of the tree; parents come before their children. */
struct ArticulationLink {
  static constexpr uint32_t none = 0xffffffffu;

  uint32_t body = no_body;     /* index into Scene::bodies */
  uint32_t parent = none;      /* index of a link; none: the root */
  uint32_t joint = none;       /* towards the root, index into Scene::joints; none: of a free root */
  uint32_t first_velocity = 0; /* where its numbers begin among those of the tree */
  uint32_t velocities = 0;     /* 0: fixed; 1: hinge, slider; 3: ball; 6: free root */
};

/* Numbers of velocities, accelerations and forces stand link by link. Of a hinge or slider: the rate of its coordinate
 * (rad/s, m/s), which counts as that of the scene's joint does. Of a ball: the angular velocity of the link relative to
 * its parent, in axes of the joint's frame on the parent. Of a free root: its angular and then its linear velocity, in
 * axes of the world. */
struct ArticulationState {
  /* Of each link: an angle (rad, counted on beyond half a turn) or a way (m) in the first number; of a ball the
   * quaternion x y z w of the link's frame in the parent's, of a free root that of its body. */
  std::vector<std::array<double, 4>> coordinates;
  std::array<double, 3> root_position{0, 0, 0}; /* of the centre of a free root */
  std::vector<double> velocities;
};

struct LinkPose {
  std::array<double, 3> position; /* of the centre of mass */
  std::array<double, 4> orientation;
  std::array<double, 3> linear_velocity, angular_velocity;
};

class TANDEM_API ArticulationTree {
public:
  /* Throws InputError that names the joint or body that does not fit into a tree; `where` prefixes the message. */
  ArticulationTree(const Scene &scene, const Articulation &articulation, const std::string &where);
  ArticulationTree(ArticulationTree &&) noexcept;
  ArticulationTree &operator=(ArticulationTree &&) noexcept;
  ~ArticulationTree();

  std::span<const ArticulationLink> links() const;
  size_t velocities() const; /* numbers of the whole tree */

  /* The coordinates that put the bodies where the scene has them, as far as the joints allow. */
  ArticulationState state() const;

  /* The functions below throw InputError if a list has not the length that the tree needs. */
  std::vector<LinkPose> forward_kinematics(const ArticulationState &state) const;
  /* The accelerations under these forces of the joints and gravity, without springs, limits and motors. */
  std::vector<double> forward_dynamics(const ArticulationState &state, std::span<const double> forces) const;
  /* The forces of the joints that give these accelerations under gravity. */
  std::vector<double> inverse_dynamics(const ArticulationState &state, std::span<const double> accelerations) const;
  /* velocities() x velocities() numbers, row by row, with armatures. */
  std::vector<double> mass_matrix(const ArticulationState &state) const;
  /* 6 x velocities() numbers, row by row: the angular and then the linear velocity, in axes of the world, of a point of
   * a link that is given from the link's centre in its own axes. */
  std::vector<double> jacobian(const ArticulationState &state, uint32_t link, const std::array<double, 3> &point) const;

private:
  struct Tables;
  std::unique_ptr<Tables> tables_;
};

/* Makes articulations of the joints of a scene, if it has none: each tree of joints that a tree can have
 * (articulation.h), in the order of the joints. A joint that closes a loop of those before it, and one that no tree can
 * have, stays as it is; Scene::notes says how many do, and why the first of them does. where: prefixes messages.
 * armatures: of each joint of the scene, as Articulation::armatures; or none. Throws InputError if the scene is not
 * valid before or with articulations, and leaves it as it was. */
TANDEM_API void make_articulations(Scene &scene, const std::string &where, std::span<const float> armatures = {});

} // namespace tandem
