/* make_articulations.cpp - finds the trees that the joints of a scene make: a spanning forest, in the order of the
 * joints (Kruskal, "On the shortest spanning subtree of a graph", 1956). */
#include <algorithm>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include <tandem/articulations.h>

#include "host/scene/articulation_buffers.h"
#include "host/scene/checker.h"
#include "host/scene/joint_buffers.h"
#include "host/scene/joint_rows.h"

namespace tandem {
namespace {

/* Bodies that joints have connected so far, each group with one of them as its name. */
class Groups {
public:
  explicit Groups(size_t bodies) : towards_(bodies), grounded_(bodies)
  {
    std::iota(towards_.begin(), towards_.end(), 0u);
  }
  uint32_t of(uint32_t body)
  {
    while (towards_[body] != body) body = towards_[body] = towards_[towards_[body]];
    return body;
  }
  /* False if the joint would close a loop, which is also one through the ground. */
  bool connect(uint32_t a, uint32_t b)
  {
    const uint32_t one = of(a), other = of(b);
    if (one == other || (grounded_[one] && grounded_[other])) return false;
    towards_[std::max(one, other)] = std::min(one, other);
    grounded_[std::min(one, other)] = grounded_[one] || grounded_[other];
    return true;
  }
  bool connect_to_ground(uint32_t body)
  {
    const uint32_t group = of(body);
    if (grounded_[group]) return false;
    return grounded_[group] = true;
  }

private:
  std::vector<uint32_t> towards_;
  std::vector<bool> grounded_;
};

class Forest {
public:
  /* in_trees: by coupling, whether its joints shall belong to one tree. */
  Forest(Scene &scene, const std::string &where, std::span<const float> armatures, const std::vector<bool> &in_trees)
      : scene_(scene), where_(where), armatures_(armatures), is_barred_(scene.bodies.size()),
        groups_(scene.bodies.size())
  {
    for (size_t k = 0; k < scene.couplings.size(); ++k)
      for (const uint32_t joint : {scene.couplings[k].joint_a, scene.couplings[k].joint_b})
        if (!in_trees[k]) bar(scene.joints[joint]);
    for (const Joint &joint : scene.joints)
      if (bounces(joint)) bar(joint);
  }
  void choose_joints()
  {
    for (uint32_t joint = 0; joint < scene_.joints.size(); ++joint)
      if (is_to_be_tried(joint)) try_joint(joint);
  }
  /* Strikes couplings out whose joints do not belong to one tree. Whether there were any. */
  bool strike_out(std::vector<bool> &in_trees)
  {
    const std::vector<bool> before = in_trees;
    for (size_t k = 0; k < in_trees.size(); ++k)
      in_trees[k] = in_trees[k] && are_of_one_tree(scene_.couplings[k].joint_a, scene_.couplings[k].joint_b);
    return in_trees != before;
  }
  void grow()
  {
    for (const uint32_t joint : taken_) add(joint);
    note_left();
  }

private:
  bool is_taken(uint32_t joint) const { return std::binary_search(taken_.begin(), taken_.end(), joint); }
  bool are_of_one_tree(uint32_t a, uint32_t b)
  {
    return is_taken(a) && is_taken(b) &&
           groups_.of(some_link_of(scene_.joints[a])) == groups_.of(some_link_of(scene_.joints[b]));
  }
  /* Neither coupled joints that are not of one tree, nor those with limits that bounce, may hold links. */
  void bar(const Joint &joint)
  {
    for (const uint32_t body : {joint.body_a, joint.body_b})
      if (!is_ground(body)) is_barred_[body] = true;
  }
  bool is_barred(uint32_t body) const { return body != no_body && is_barred_[body]; }
  bool is_ground(uint32_t body) const { return body == no_body || scene_.bodies[body].type == BodyType::fixed; }
  bool is_to_be_tried(uint32_t index) const
  {
    const Joint &joint = scene_.joints[index];
    return joint.enabled && !(is_ground(joint.body_a) && is_ground(joint.body_b)) && !holds_nothing(joint);
  }
  uint32_t some_link_of(const Joint &joint) const { return is_ground(joint.body_a) ? joint.body_b : joint.body_a; }

  bool connect(const Joint &joint)
  {
    const bool stands = is_ground(joint.body_a) || is_ground(joint.body_b);
    return stands ? groups_.connect_to_ground(some_link_of(joint)) : groups_.connect(joint.body_a, joint.body_b);
  }
  void try_joint(uint32_t index)
  {
    const Joint &joint = scene_.joints[index];
    try {
      if (is_barred(joint.body_a) || is_barred(joint.body_b))
        refuse(where_, label("joint", index, joint.name),
               "holds a body of a joint that bounces, or is coupled with none of its tree; such bodies are no links");
      Articulation alone;
      alone.joints = {index};
      check_articulation(scene_, alone, where_);
    } catch (const InputError &error) {
      return leave(error.what());
    }
    if (connect(joint)) taken_.push_back(index);
    else leave(fmt::format("{}: {}: closes a loop", printable(where_), label("joint", index, joint.name)));
  }
  void leave(const std::string &why)
  {
    if (left_++ == 0) first_left_ = why;
  }
  void add(uint32_t index)
  {
    const uint32_t group = groups_.of(some_link_of(scene_.joints[index]));
    const auto [known, is_new] = number_.try_emplace(group, scene_.articulations.size());
    if (is_new) scene_.articulations.emplace_back();
    Articulation &tree = scene_.articulations[known->second];
    tree.joints.push_back(index);
    if (!armatures_.empty()) tree.armatures.push_back(armatures_[index]);
  }
  void note_left()
  {
    if (left_ > 0)
      scene_.notes.push_back(
          fmt::format("joints in maximal coordinates beside the articulations: {}, the first: {}", left_, first_left_));
  }

  Scene &scene_;
  const std::string &where_;
  std::span<const float> armatures_;
  std::vector<bool> is_barred_;
  Groups groups_;
  std::vector<uint32_t> taken_;
  std::map<uint32_t, size_t> number_; /* of the articulation of a group */
  size_t left_ = 0;
  std::string first_left_;
};

bool can_be_coupled_in_tree(const Joint &joint)
{
  return joint.type == JointType::hinge || joint.type == JointType::slider;
}

std::vector<bool> couplings_of_hinges_and_sliders(const Scene &scene)
{
  std::vector<bool> are;
  for (const Coupling &coupling : scene.couplings)
    are.push_back(can_be_coupled_in_tree(scene.joints[coupling.joint_a]) &&
                  can_be_coupled_in_tree(scene.joints[coupling.joint_b]));
  return are;
}

/* Joints whose coupling would leave their tree hold no links, so that other couplings may leave theirs. */
void grow_forest(Scene &scene, const std::string &where, std::span<const float> armatures)
{
  std::vector<bool> in_trees = couplings_of_hinges_and_sliders(scene);
  for (;;) {
    Forest forest(scene, where, armatures, in_trees);
    forest.choose_joints();
    if (forest.strike_out(in_trees)) continue;
    return forest.grow();
  }
}

} // namespace

void make_articulations(Scene &scene, const std::string &where, std::span<const float> armatures)
{
  if (!scene.articulations.empty()) return;
  if (!armatures.empty() && armatures.size() != scene.joints.size())
    throw InputError(fmt::format("{}: {} armatures for {} joints; give one for each joint, or none", printable(where),
                                 armatures.size(), scene.joints.size()));
  validate(scene, where);
  const size_t notes = scene.notes.size();
  grow_forest(scene, where, armatures);
  try {
    validate(scene, where);
  } catch (...) {
    scene.articulations.clear();
    scene.notes.resize(notes);
    throw;
  }
}

} // namespace tandem
