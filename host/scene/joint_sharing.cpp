/* joint_sharing.cpp - see joint_sharing.h. */
#include "host/scene/joint_sharing.h"

#include <algorithm>
#include <array>
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
/* What the world holds by a joint answers later, as if it had so much more motion: stars on one and on two welds. */
constexpr double motion_of_anchor = 0.5;

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

/* What impulses at the end of an arm move, the sum over three axes; and what moments move, about each principal axis,
 * whose sum would be that of the axis of a thin rod, about which nothing turns it. */
struct Response {
  double linear;
  std::array<double, 3> angular;
  double least_angular() const { return *std::min_element(angular.begin(), angular.end()); }
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
            {x, y, z}};
  }

private:
  const Scene &scene_;
  std::vector<std::optional<Vec3>> inertia_;
};

double share_of(double own, double other) { return own > 0 ? own / (own + other) : 0; }

/* An arm may turn to where it is hardest to turn. */
void add_shares_of_turning(std::array<double, 3> &sums, const Response &own, const Response &other)
{
  for (size_t axis = 0; axis < 3; ++axis) sums[axis] += share_of(own.angular[axis], other.least_angular());
}

} // namespace

JointSharing::JointSharing(const Scene &scene) : scene_(scene), crowds_(scene.bodies.size())
{
  for (const Joint &joint : scene.joints) {
    if (!joint.enabled) continue;
    if (!is_between_pushed(scene, joint)) {
      add_anchor(joint);
      continue;
    }
    const bool turns = uses_rotations(joint);
    for (const uint32_t body : {joint.body_a, joint.body_b}) {
      ++crowds_[body].joints;
      crowds_[body].hold_rotations = crowds_[body].hold_rotations || turns;
    }
  }
  add_motions();
}

void JointSharing::add_anchor(const Joint &joint)
{
  const uint32_t held = can_be_pushed(scene_, joint.body_a) ? joint.body_a : joint.body_b;
  if (held != no_body && held_by(joint).rotations != 0) ++crowds_[held].anchors;
}

void JointSharing::add_motions()
{
  const auto depends = [&](uint32_t body) { return depends_on_motion(crowds_[body]); };
  Responses responses(scene_);
  for (const Joint &joint : scene_.joints) {
    if (!joint.enabled || !is_between_pushed(scene_, joint) || (!depends(joint.body_a) && !depends(joint.body_b)))
      continue;
    const Response a = responses.of(joint.body_a, joint.position_a), b = responses.of(joint.body_b, joint.position_b);
    crowds_[joint.body_a].linear += share_of(a.linear, b.linear);
    crowds_[joint.body_b].linear += share_of(b.linear, a.linear);
    add_shares_of_turning(crowds_[joint.body_a].angular, a, b);
    add_shares_of_turning(crowds_[joint.body_b].angular, b, a);
  }
}

bool JointSharing::depends_on_motion(const Crowd &crowd)
{
  return crowd.joints >= least && crowd.joints + crowd.anchors > least && crowd.joints <= most;
}

bool JointSharing::shares(const Crowd &crowd)
{
  if (!depends_on_motion(crowd)) return crowd.joints > most;
  if (!crowd.hold_rotations) return crowd.linear > most_of_points;
  const double angular = *std::max_element(crowd.angular.begin(), crowd.angular.end());
  return std::max(crowd.linear, angular) + motion_of_anchor * crowd.anchors > most_of_turning;
}

float JointSharing::of(const Joint &joint, uint32_t body) const
{
  if (!is_between_pushed(scene_, joint) || !shares(crowds_[body])) return 1;
  return round_to_float((crowds_[body].hold_rotations ? 0.75 : 0.5) * crowds_[body].joints);
}

} // namespace tandem
