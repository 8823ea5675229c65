/* joint_sharing.h - how much lighter than they are bodies seem to their joints, so that passes over the joints of a
 * body that many or heavy others hang on do not amplify errors.
 *
 *          o   o            Each joint alone would move the light body out of its own way, and so undo what the others
 *           \ /             have done. Gauss-Seidel passes over them, warm started by the last substep, have an
 *        o --x-- o          iteration matrix of complex eigenvalues, and errors grow. Where each of n joints takes
 *           / \             2 / n of an error, they settle, and where rotations are held, too, 4 / 3 n.
 *          o   o
 */
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <tandem/scene.h>

namespace tandem {

/* Follows from the joints of the scene, and from masses, moments and arms of their bodies. */
class JointSharing {
public:
  explicit JointSharing(const Scene &scene);
  /* At least 1; 1 of most bodies. */
  float of(const Joint &joint, uint32_t body) const;

private:
  /* The joints of a body with others that can be pushed. */
  struct Crowd {
    uint32_t joints = 0, anchors = 0; /* anchors: that hold rotations to what cannot be pushed */
    bool hold_rotations = false;
    /* Sums over the joints: which share of the motion is this body's, and of the turning about each of its axes. */
    double linear = 0;
    std::array<double, 3> angular{};
  };
  void add_motions();
  void add_anchor(const Joint &joint);
  static bool depends_on_motion(const Crowd &crowd);
  static bool shares(const Crowd &crowd);

  const Scene &scene_;
  std::vector<Crowd> crowds_; /* by body */
};

} // namespace tandem
