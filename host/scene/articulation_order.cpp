/* articulation_order.cpp - see articulation_order.h. */
#include "host/scene/articulation_order.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "host/base/printable.h"
#include "host/scene/checker.h"
#include "host/scene/joint_rows.h"
#include "host/scene/specialise.h"
#include "shared/joints/joint_codes.h"

namespace tandem {
namespace {

class Order {
public:
  Order(const Scene &scene, const Articulation &articulation, const std::string &where)
      : scene_(scene), articulation_(articulation), where_(where)
  {
    check_joints();
    start();
    list_joints();
    grow();
    require_all();
    number();
  }

  std::vector<OrderedLink> links() && { return std::move(links_); }

private:
  [[noreturn]] void fail(const std::string &why) const
  {
    const std::string name =
        articulation_.name.empty() ? "articulation" : fmt::format("articulation '{}'", printable(articulation_.name));
    throw InputError(fmt::format("{}: {}: {}", printable(where_), name, why));
  }
  [[noreturn]] void fail_joint(uint32_t joint, const std::string &why) const
  {
    fail(fmt::format("{} {}", label("joint", joint, scene_.joints[joint].name), why));
  }

  void check_joints() const
  {
    std::set<uint32_t> seen;
    for (const uint32_t joint : articulation_.joints) {
      if (joint >= scene_.joints.size())
        fail(fmt::format("joint {} does not exist; the scene has {} joints", joint, scene_.joints.size()));
      if (!seen.insert(joint).second) fail_joint(joint, "is named twice; name each joint once");
      if (is_vacant(scene_.joints[joint])) fail_joint(joint, "was destroyed; it has no bodies");
      check_type(joint);
    }
    if (!articulation_.armatures.empty() && articulation_.armatures.size() != articulation_.joints.size())
      fail(fmt::format("{} armatures for {} joints; give one for each joint, or none", articulation_.armatures.size(),
                       articulation_.joints.size()));
    for (const float x : articulation_.armatures)
      if (!(x >= 0) || !std::isfinite(x))
        fail(fmt::format("an armature is {}; a finite number of at least 0 is needed", x));
  }

  void check_type(uint32_t index) const
  {
    const Joint &joint = scene_.joints[index];
    if (joint.type != JointType::fixed && joint.type != JointType::hinge && joint.type != JointType::slider &&
        !is_ball_of_tree(joint))
      fail_joint(index, "has another type than fixed, hinge, slider, ball or cone_twist; leave it out, and it closes a "
                        "loop");
  }

  bool is_ground(uint32_t body) const { return body == no_body || scene_.bodies[body].type == BodyType::fixed; }

  /* The joints that hold the tree to the ground. */
  void start()
  {
    std::vector<size_t> grounded;
    for (size_t n = 0; n < articulation_.joints.size(); ++n) {
      const Joint &joint = scene_.joints[articulation_.joints[n]];
      if (is_ground(joint.body_a) || is_ground(joint.body_b)) grounded.push_back(n);
    }
    if (grounded.size() > 1)
      fail_joint(articulation_.joints[grounded[1]],
                 fmt::format("holds the tree to the ground, as joint {} does; leave one of them out, and it closes a "
                             "loop",
                             articulation_.joints[grounded[0]]));
    used_.assign(articulation_.joints.size(), false);
    if (grounded.empty()) return add_free_root();
    const Joint &joint = scene_.joints[articulation_.joints[grounded[0]]];
    if (articulation_.root != no_body)
      fail(fmt::format("body {} is named as the root of a free tree, but joint {} holds the tree to the ground; name "
                       "no root",
                       articulation_.root, articulation_.joints[grounded[0]]));
    add(grounded[0], is_ground(joint.body_b), ArticulationLink::none);
  }

  void add_free_root()
  {
    uint32_t root = articulation_.root;
    for (const uint32_t joint : articulation_.joints)
      if (articulation_.root == no_body)
        root = std::min({root, scene_.joints[joint].body_a, scene_.joints[joint].body_b});
    if (root == no_body) fail("it has no joints; name a joint or a root");
    if (root >= scene_.bodies.size())
      fail(fmt::format("the root, body {}, does not exist; the scene has {} bodies", root, scene_.bodies.size()));
    OrderedLink l;
    l.link.body = root;
    l.is_free = true;
    add_link(l);
  }

  /* b_is_parent: the tree grows through the joint from its body b to its body a. */
  void add(size_t n, bool b_is_parent, uint32_t parent)
  {
    const uint32_t index = articulation_.joints[n];
    const Joint &joint = scene_.joints[index];
    OrderedLink l;
    l.link = {b_is_parent ? joint.body_a : joint.body_b, parent, index, 0, 0};
    l.type = is_ball_of_tree(joint) ? JointType::ball : joint.type;
    l.position_a = joint.position_a, l.position_b = joint.position_b;
    l.orientation_a = joint.orientation_a, l.orientation_b = joint.orientation_b;
    if (b_is_parent) turn_round(l);
    l.axis = axis_of_tree(joint);
    if (!articulation_.armatures.empty()) l.armature = articulation_.armatures[n];
    used_[n] = true;
    add_link(l);
  }

  /* With both frames turned by half a turn about z, the coordinate keeps its sign. */
  static void turn_round(OrderedLink &l)
  {
    std::swap(l.position_a, l.position_b);
    std::swap(l.orientation_a, l.orientation_b);
    for (Quat *q : {&l.orientation_a, &l.orientation_b}) {
      const Quat o = *q;
      *q = {o[1], -o[0], o[3], -o[2]};
    }
  }

  void add_link(OrderedLink l)
  {
    const Body &body = scene_.bodies[l.link.body];
    const std::string name = label("body", l.link.body, body.name);
    const Axes none;
    if (body.type != BodyType::dynamic) fail(name + " is not dynamic; links of a tree are");
    if (body.linear_locks != none || body.angular_locks != none)
      fail(name + " has locked axes; links of a tree have none");
    for (const float x : inverse_inertia_of(scene_, body))
      if (!(x > 0)) fail(name + " has an infinite moment of inertia; links of a tree have finite ones");
    if (!linked_.insert(l.link.body).second)
      fail_joint(l.link.joint, "closes a loop; leave it out, and it closes the loop as a joint of the scene");
    links_.push_back(l);
  }

  /* By body, in the order of Articulation::joints. */
  void list_joints()
  {
    for (size_t n = 0; n < articulation_.joints.size(); ++n) {
      const Joint &joint = scene_.joints[articulation_.joints[n]];
      of_body_[joint.body_a].push_back(n);
      of_body_[joint.body_b].push_back(n);
    }
  }

  /* From each link on through its joints, to all that is beyond the one before the next. */
  void grow()
  {
    struct Visit {
      uint32_t link;
      size_t next; /* of the joints of its body */
    };
    std::vector<Visit> way{{0, 0}};
    while (!way.empty()) {
      const uint32_t link = way.back().link, body = links_[link].link.body;
      const std::vector<size_t> &joints = of_body_[body];
      size_t &next = way.back().next;
      while (next < joints.size() && used_[joints[next]]) ++next;
      if (next == joints.size()) {
        way.pop_back();
        continue;
      }
      add(joints[next], scene_.joints[articulation_.joints[joints[next]]].body_b == body, link);
      way.push_back({uint32_t(links_.size() - 1), 0});
    }
  }

  void require_all() const
  {
    for (size_t n = 0; n < used_.size(); ++n)
      if (!used_[n])
        fail_joint(
            articulation_.joints[n],
            fmt::format("is not connected with body {}, the root; make a tree of its own of it", links_[0].link.body));
  }

  void number()
  {
    uint32_t first = 0;
    for (OrderedLink &l : links_) {
      l.link.first_velocity = first;
      l.link.velocities = l.is_free ? 6 : l.type == JointType::ball ? 3 : l.type == JointType::fixed ? 0 : 1;
      first += l.link.velocities;
      number_path(l);
    }
  }

  /* Velocities beyond the 64th have no bits; trees that have such are not solved by paths. */
  void number_path(OrderedLink &l) const
  {
    for (uint32_t n = l.link.first_velocity; n < l.link.first_velocity + l.link.velocities && n < 64; ++n)
      l.path |= uint64_t{1} << n;
    if (l.link.parent == ArticulationLink::none) return;
    const OrderedLink &parent = links_[l.link.parent];
    l.path |= parent.path;
    l.path_entries = parent.path_entries + parent.link.velocities;
  }

  const Scene &scene_;
  const Articulation &articulation_;
  const std::string &where_;
  std::vector<OrderedLink> links_;
  std::vector<bool> used_;
  std::set<uint32_t> linked_;                       /* the bodies of links_ */
  std::map<uint32_t, std::vector<size_t>> of_body_; /* entries of Articulation::joints */
};

} // namespace

bool is_ball_of_tree(const Joint &joint)
{
  const HeldAxes held = held_by(joint);
  return !crosses(joint.type) && held.directions == JOINT_XYZ && held.rotations == 0;
}

namespace {

/* A spring and a damper alike about all axes are a part of the mass matrix. */
bool is_driven_alike(const Joint &ball)
{
  const auto &r = ball.rotations;
  JointAxis drive;
  drive.stiffness = r[0].stiffness;
  drive.damping = r[0].damping;
  return ball.type == JointType::ball && r[0] == drive && r[1] == drive && r[2] == drive;
}

} // namespace

bool has_rows_besides_tree(const Joint &joint)
{
  return is_ball_of_tree(joint) && !axes_used_by(joint).empty() && !is_driven_alike(joint);
}

JointAxis axis_of_tree(const Joint &joint)
{
  if (joint.type == JointType::hinge) return joint.rotations[0];
  if (joint.type == JointType::slider) return joint.directions[0];
  return is_ball_of_tree(joint) && is_driven_alike(joint) ? joint.rotations[0] : JointAxis{};
}

std::vector<OrderedLink> ordered_links_of(const Scene &scene, const Articulation &articulation,
                                          const std::string &where)
{
  return Order(scene, articulation, where).links();
}

} // namespace tandem
