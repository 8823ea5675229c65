/* joint_sharing.cpp - see joint_sharing.h. */
#include "host/scene/joint_sharing.h"

#include <algorithm>
#include <optional>

#include <tandem/round_to_float.h>

#include "host/scene/body_buffers.h"
#include "host/scene/joint_buffers.h"
#include "host/scene/joint_rows.h"
#include "host/scene/specialise.h"
#include "shared/joints/joint_codes.h"

namespace tandem {
namespace {

/* Bodies of at most `least` joints settle in any case, those of more than `most` in none. Between these it depends on
 * how much of the motion of its joints a body has: errors of random stars grew from the motion of 1.96 joints on where
 * rotations are held, and from that of 3.5 where points are. */
constexpr uint32_t least = 2, most = 6;
constexpr double most_of_turning = 1.9, most_of_points = 2.5;

bool is_between_pushed(const Scene &scene, const Joint &joint)
{
  return can_be_pushed(scene, joint.body_a) && can_be_pushed(scene, joint.body_b);
}

bool uses_rotations(const Joint &joint)
{
  const auto is_rotation = [](const UsedAxis &used) {
    return used.kind >= JOINT_AXIS_TWIST && used.kind != JOINT_AXIS_DISTANCE;
  };
  const std::vector<UsedAxis> axes = axes_used_by(joint);
  return held_by(joint).rotations != 0 || std::any_of(axes.begin(), axes.end(), is_rotation);
}

/* What impulses at the end of an arm, and moments, move: the sums over three axes. */
struct Response {
  double linear, angular;
};

/* Moments of inertia are computed once a body, because those of meshes take long. */
class Responses {
public:
  explicit Responses(const Scene &scene) : scene_(scene), inertia_(scene.bodies.size()) {}
  Response of(uint32_t body, const Point &arm)
  {
    std::optional<Vec3> &inverse = inertia_[body];
    if (!inverse) inverse = inverse_inertia_of(scene_, scene_.bodies[body]);
    const double x = double{(*inverse)[0]}, y = double{(*inverse)[1]}, z = double{(*inverse)[2]};
    const double of_x = arm[0] * arm[0], of_y = arm[1] * arm[1], of_z = arm[2] * arm[2];
    return {3 * double{inverse_mass_of(scene_.bodies[body])} + x * (of_y + of_z) + y * (of_x + of_z) +
                z * (of_x + of_y),
            x + y + z};
  }

private:
  const Scene &scene_;
  std::vector<std::optional<Vec3>> inertia_;
};

double share_of(double own, double other) { return own > 0 ? own / (own + other) : 0; }

} // namespace

JointSharing::JointSharing(const Scene &scene) : scene_(scene), crowds_(scene.bodies.size())
{
  for (const Joint &joint : scene.joints) {
    if (!joint.enabled || !is_between_pushed(scene, joint)) continue;
    const bool turns = uses_rotations(joint);
    for (const uint32_t body : {joint.body_a, joint.body_b}) {
      ++crowds_[body].joints;
      crowds_[body].hold_rotations = crowds_[body].hold_rotations || turns;
    }
  }
  add_motions();
}

void JointSharing::add_motions()
{
  const auto depends = [&](uint32_t body) { return crowds_[body].joints > least && crowds_[body].joints <= most; };
  Responses responses(scene_);
  for (const Joint &joint : scene_.joints) {
    if (!joint.enabled || !is_between_pushed(scene_, joint) || (!depends(joint.body_a) && !depends(joint.body_b)))
      continue;
    const Response a = responses.of(joint.body_a, joint.position_a), b = responses.of(joint.body_b, joint.position_b);
    crowds_[joint.body_a].linear += share_of(a.linear, b.linear);
    crowds_[joint.body_b].linear += share_of(b.linear, a.linear);
    crowds_[joint.body_a].angular += share_of(a.angular, b.angular);
    crowds_[joint.body_b].angular += share_of(b.angular, a.angular);
  }
}

bool JointSharing::shares(const Crowd &crowd) const
{
  if (crowd.joints <= least || crowd.joints > most) return crowd.joints > most;
  if (!crowd.hold_rotations) return crowd.linear > most_of_points;
  return std::max(crowd.linear, crowd.angular) > most_of_turning;
}

float JointSharing::of(const Joint &joint, uint32_t body) const
{
  if (!is_between_pushed(scene_, joint) || !shares(crowds_[body])) return 1;
  return round_to_float((crowds_[body].hold_rotations ? 0.75 : 0.5) * crowds_[body].joints);
}

} // namespace tandem
