/* articulation_buffers.cpp - see articulation_buffers.h. */
#include "host/scene/articulation_buffers.h"

#include <algorithm>

#include <fmt/format.h>

#include <tandem/round_to_float.h>

#include "host/scene/articulation_order.h"
#include "host/scene/body_buffers.h"
#include "host/scene/checker.h"
#include "host/scene/joint_buffers.h"
#include "host/scene/joint_rows.h"
#include "host/scene/link_rows.h"
#include "shared/batching/node_words.h"
#include "shared/counts.h"

namespace tandem {
namespace {

float4 float4_of(const std::array<double, 4> &row)
{
  return {round_to_float(row[0]), round_to_float(row[1]), round_to_float(row[2]), round_to_float(row[3])};
}

/* Whether the drive is a part of the mass matrix: shared/articulations/drives.h. */
bool is_implicit(const JointAxis &axis)
{
  return !axis.motor && (axis.stiffness > 0 || axis.damping > 0 || axis.force != 0) &&
         axis.max_force == JointAxis::unlimited;
}

/* What a program may set of the axis of a joint. */
struct LinkAxis {
  std::array<float4, LINK_ROWS - LINK_MOMENTS> link; /* the row with the moments and those that follow it */
  float4 range;
};

LinkAxis link_axis_of(const Scene &scene, const JointAxis &axis, uint32_t body)
{
  const std::array<double, 3> moments = moments_of_link(scene, scene.bodies[body]);
  const auto axis_row = row_of_axis(axis);
  return {{float4_of({moments[0], moments[1], moments[2], is_implicit(axis) ? 1.0 : 0.0}), axis_row[1], axis_row[2]},
          axis_row[0]};
}

/* The tables of all trees but where their bodies are. */
class LinkTables {
public:
  LinkTables(const Scene &scene, const JointedLinks &links) : scene_(scene), places_(links.places)
  {
    code_.resize(links.room.links);
    freedom_.resize(size_t{links.room.links} * PATH_WORDS);
    row_.resize(size_t{links.room.links} * LINK_ROWS);
    range_.resize(links.room.links);
  }

  void add(uint32_t number, const std::vector<OrderedLink> &links)
  {
    for (uint32_t k = 0; k < links.size(); ++k) add_link(places_[number], k, links[k]);
  }
  void stage(StagedUploads &uploads)
  {
    uploads.add(Buffer::link_code, std::move(code_));
    uploads.add(Buffer::link_freedom, std::move(freedom_));
    uploads.add(Buffer::link_row, std::move(row_));
    uploads.add(Buffer::link_range, std::move(range_));
    uploads.add(Buffer::articulation_ground, std::move(ground_));
  }

private:
  void add_link(const TreePlace &place, uint32_t k, const OrderedLink &l)
  {
    const LinkRows rows = rows_of_link(scene_, l);
    code_[place.row(1, k, 0)] = rows.code;
    for (size_t word = 0; word < PATH_WORDS; ++word) freedom_[place.row(PATH_WORDS, k, word)] = rows.freedom[word];
    for (size_t row = 0; row < LINK_MOMENTS; ++row) row_[place.row(LINK_ROWS, k, row)] = float4_of(rows.numbers[row]);
    const LinkAxis axis = link_axis_of(scene_, l.axis, l.link.body);
    for (size_t row = 0; row < axis.link.size(); ++row)
      row_[place.row(LINK_ROWS, k, LINK_MOMENTS + row)] = axis.link[row];
    range_[place.row(1, k, 0)] = axis.range;
    if (k > 0) return;
    const auto position = double_float3_of(rows.ground);
    ground_.insert(ground_.end(), position.begin(), position.end());
  }

  const Scene &scene_;
  const std::vector<TreePlace> &places_;
  std::vector<uint32_t> code_, freedom_;
  std::vector<float4> row_, range_, ground_;
};

void check_joint_at_link(const Joint &joint, size_t index, const std::string &where)
{
  if (bounces(joint))
    refuse(where, label("joint", index, joint.name), "has a limit that bounces; joints that hold links have none");
}

[[noreturn]] void refuse_link(const Scene &scene, const Articulation &articulation, uint32_t index,
                              const std::string &where, const char *why)
{
  const std::string name =
      articulation.name.empty() ? "articulation" : fmt::format("articulation '{}'", printable(articulation.name));
  refuse(where, name, fmt::format("{} {}", label("body", index, scene.bodies[index].name), why));
}

/* Refuses what a link cannot have within a step. */
void check_link(const Scene &scene, const Articulation &articulation, uint32_t index, const std::string &where)
{
  const Body &body = scene.bodies[index];
  const auto fail = [&](const char *why) { refuse_link(scene, articulation, index, where, why); };
  if (body.linear_damping > 0 || body.angular_damping > 0)
    fail("has damping; joints of a tree have it, as JointAxis::damping");
  if (body.max_linear_speed < JointAxis::unlimited || body.max_angular_speed < JointAxis::unlimited)
    fail("has a highest speed; links have none, joints have JointAxis::max_speed");
  if (body.continuous) fail("is continuous; links are not");
}

void check_links(const Scene &scene, const Articulation &articulation, const std::vector<OrderedLink> &links,
                 const std::string &where)
{
  for (const OrderedLink &l : links) {
    check_link(scene, articulation, l.link.body, where);
    if (l.link.joint != ArticulationLink::none) check_joint_of_tree(scene.joints[l.link.joint], l.link.joint, where);
  }
}

/* Refuses what the articulations of a scene, and what is beside them, cannot have within a step. */
class LinkChecks {
public:
  LinkChecks(const Scene &scene, const std::string &where)
      : scene_(scene), where_(where), trees_(scene.joints.size(), no_link), linked_(scene.bodies.size())
  {}

  void check(const Articulation &articulation, const std::vector<OrderedLink> &links)
  {
    for (const OrderedLink &l : links) {
      if (linked_[l.link.body])
        refuse_link(scene_, articulation, l.link.body, where_,
                    "is a link of another articulation, too; one tree holds a body");
      linked_[l.link.body] = true;
      if (l.link.joint != ArticulationLink::none)
        trees_[l.link.joint] = static_cast<uint32_t>(&articulation - scene_.articulations.data());
    }
    check_links(scene_, articulation, links, where_);
  }
  /* Joints and couplings besides those of the trees. */
  void check_others() const
  {
    for (size_t k = 0; k < scene_.joints.size(); ++k)
      if (trees_[k] == no_link && holds_a_link(scene_.joints[k])) check_joint_at_link(scene_.joints[k], k, where_);
    for (size_t k = 0; k < scene_.couplings.size(); ++k) check_coupling(k);
    for (size_t k = 0; k < scene_.materials.size(); ++k) check_material_beside_links(scene_.materials[k], k, where_);
  }

private:
  bool holds_a_link(const Joint &joint) const
  {
    const auto is_link = [&](uint32_t body) { return body != no_body && linked_[body]; };
    return !is_vacant(joint) && (is_link(joint.body_a) || is_link(joint.body_b));
  }
  [[noreturn]] void refuse_coupling(size_t coupling, uint32_t joint, const char *why) const
  {
    refuse(where_, label("coupling", coupling, scene_.couplings[coupling].name),
           fmt::format("couples joint {}, {}", joint, why));
  }
  /* Either of two joints of one tree, or of two that hold no links. */
  void check_coupling(size_t k) const
  {
    const Coupling &coupling = scene_.couplings[k];
    const uint32_t a = coupling.joint_a, b = coupling.joint_b;
    for (const uint32_t joint : {a, b}) {
      const Joint &one = scene_.joints[joint];
      if (trees_[joint] != no_link && one.type != JointType::hinge && one.type != JointType::slider)
        refuse_coupling(k, joint, "a coordinate of an articulation; of these, hinges and sliders can be coupled");
      if (trees_[joint] == no_link && holds_a_link(one))
        refuse_coupling(k, joint, "which holds a link of an articulation from outside; couplings are of other joints");
    }
    if (trees_[a] != trees_[b])
      refuse_coupling(
          k, trees_[a] == no_link ? b : a,
          "a coordinate of an articulation, with a joint that is none of it; a coupling is of two joints of "
          "one articulation, or of two that belong to none");
  }
  const Scene &scene_;
  const std::string &where_;
  std::vector<uint32_t> trees_; /* by joint, its articulation */
  std::vector<bool> linked_;
};

} // namespace

std::vector<bool> articulated_joints(const Scene &scene)
{
  std::vector<bool> joints(scene.joints.size());
  for (const Articulation &articulation : scene.articulations)
    for (const uint32_t joint : articulation.joints)
      if (joint < joints.size()) joints[joint] = true;
  return joints;
}

namespace {

/* The other body of the joint that holds a root. */
void note_base(const Joint &joint, uint32_t root, JointedLinks &links)
{
  const uint32_t base = joint.body_a == root ? joint.body_b : joint.body_a;
  if (base != no_body) links.bases[base] = true;
}

/* A tree that nothing can move has one freedom for all that. */
uint32_t freedoms_of_table(const std::vector<OrderedLink> &tree)
{
  const ArticulationLink &last = tree.back().link;
  const uint32_t freedoms = last.first_velocity + last.velocities;
  return freedoms <= TREE_FREEDOMS ? std::max(freedoms, 1u) : 0;
}

TreeShape shape_of(const std::vector<OrderedLink> &tree)
{
  TreeShape shape;
  for (const OrderedLink &l : tree) shape.push_back(code_of_link(l));
  return shape;
}

/* The freedoms of the longest path. */
uint32_t longest_path(const std::vector<OrderedLink> &tree)
{
  uint32_t most = 1;
  for (const OrderedLink &l : tree) most = std::max(most, l.path_entries + l.link.velocities);
  return most;
}

} // namespace

JointedLinks links_of(const Scene &scene)
{
  JointedLinks links;
  if (scene.articulations.empty()) return links;
  links.of_joint.assign(scene.joints.size(), no_link);
  links.number_of_joint.assign(scene.joints.size(), 0);
  links.body_of_joint.assign(scene.joints.size(), no_body);
  links.of_body.assign(scene.bodies.size(), no_link);
  links.bases.resize(scene.bodies.size());
  std::vector<TreeShape> shapes;
  std::vector<uint32_t> entries; /* of the longest path of each tree; 0 of those without a table */
  for (const Articulation &articulation : scene.articulations) {
    links.trees.emplace_back();
    const std::vector<OrderedLink> tree = ordered_links_of(scene, articulation, scene.name);
    links.freedoms.push_back(freedoms_of_table(tree));
    shapes.push_back(shape_of(tree));
    entries.push_back(links.freedoms.back() > 0 ? longest_path(tree) : 0);
    for (const OrderedLink &l : tree) {
      if (l.link.joint != ArticulationLink::none) {
        if (l.link.parent == ArticulationLink::none) note_base(scene.joints[l.link.joint], l.link.body, links);
        links.of_joint[l.link.joint] = static_cast<uint32_t>(links.trees.size() - 1);
        links.number_of_joint[l.link.joint] = static_cast<uint32_t>(links.trees.back().size());
        links.body_of_joint[l.link.joint] = l.link.body;
      }
      links.of_body[l.link.body] = static_cast<uint32_t>(links.trees.size() - 1);
      links.trees.back().push_back(l.link.body);
    }
  }
  links.places = tree_places(shapes);
  links.room = room_of(links.places);
  links.paths = path_places(links.places, entries);
  return links;
}

bool holds_link(const JointedLinks &links, const Joint &joint)
{
  const auto is_link = [&](uint32_t body) { return body != no_body && links.has_body(body); };
  return is_link(joint.body_a) || is_link(joint.body_b);
}

void stage_link_axes(StagedUploads &uploads, const Scene &scene, std::span<const uint32_t> joints,
                     const JointedLinks &links)
{
  const auto stage = [&](uint32_t joint) {
    if (links.of_joint[joint] == no_link) return;
    const LinkAxis rows = link_axis_of(scene, axis_of_tree(scene.joints[joint]), links.body_of_joint[joint]);
    const TreePlace &place = links.places[links.of_joint[joint]];
    const uint32_t k = links.number_of_joint[joint];
    for (size_t row = 0; row < rows.link.size(); ++row)
      uploads.add_elements(Buffer::link_row, std::vector<float4>{rows.link[row]},
                           place.row(LINK_ROWS, k, LINK_MOMENTS + row));
    uploads.add_elements(Buffer::link_range, std::vector<float4>{rows.range}, place.row(1, k, 0));
  };
  for (const uint32_t joint : joints) stage(joint);
  if (!joints.empty()) return;
  for (uint32_t joint = 0; joint < links.of_joint.size(); ++joint) stage(joint);
}

void check_material_beside_links(const Material &material, size_t index, const std::string &where)
{
  if (material.rolling_friction > 0 || material.spinning_friction > 0)
    refuse(where, label("material", index, material.name),
           "has rolling or spinning friction, and the scene has articulations; contacts of links have neither");
}

void check_joint_beside_links(const JointedLinks &links, const Joint &joint, size_t index, const std::string &where)
{
  if (holds_link(links, joint)) check_joint_at_link(joint, index, where);
}

void check_joint_of_tree(const Joint &joint, size_t index, const std::string &where)
{
  const Checker check{where, "joint", index, joint.name};
  if (!joint.enabled) check.fail("is not enabled; joints of a tree always are");
  if (joint.break_force < JointAxis::unlimited || joint.break_torque < JointAxis::unlimited)
    check.fail("can break; joints of a tree do not");
  check_joint_at_link(joint, index, where);
}

void check_articulations(const Scene &scene, const std::string &where)
{
  if (scene.articulations.empty()) return;
  LinkChecks checks(scene, where);
  for (const Articulation &articulation : scene.articulations)
    checks.check(articulation, ordered_links_of(scene, articulation, where));
  checks.check_others();
}

void check_articulation(const Scene &scene, const Articulation &articulation, const std::string &where)
{
  check_links(scene, articulation, ordered_links_of(scene, articulation, where), where);
}

void check_articulations(const Settings &settings, const Scene &scene)
{
  if (scene.articulations.empty()) return;
  const auto fail = [&](const std::string &why) {
    throw InputError(
        fmt::format("{}: {}; the scene has {} articulations", scene.name, why, scene.articulations.size()));
  };
  if (settings.solver != Solver::soft_step)
    fail(fmt::format("the solver {} has no articulations, soft-step has them", name_of(settings.solver)));
  if (settings.batching != Batching::coloring && settings.batching != Batching::sequential)
    fail(fmt::format("the batching {} has no articulations, coloring and sequential have them",
                     name_of(settings.batching)));
}

void stage_articulations(StagedUploads &uploads, const Scene &scene, const JointedLinks &links)
{
  LinkTables tables(scene, links);
  for (uint32_t number = 0; number < scene.articulations.size(); ++number)
    tables.add(number, ordered_links_of(scene, scene.articulations[number], scene.name));
  tables.stage(uploads);
}

/* A tree of which a link is in quarantine or asleep has no links for kernels. A tree sleeps as a whole. */
void stage_bodies_of_links(StagedUploads &uploads, const JointedLinks &links, std::span<const uint32_t> index_of_body,
                           size_t room, const std::vector<BodyStatus> &status, uint32_t awake)
{
  std::vector<uint32_t> body(links.room.links), place, body_link;
  for (uint32_t index = 0; index < room; ++index) body_link.insert(body_link.end(), {index, INDEX_NONE, 0});
  for (uint32_t number = 0; number < links.trees.size(); ++number) {
    const std::vector<uint32_t> &tree = links.trees[number];
    const TreePlace &at = links.places[number];
    const bool is_out = std::any_of(tree.begin(), tree.end(), [&](uint32_t slot) {
      return status_of(status, slot) == BodyStatus::quarantined || index_of_body[slot] >= awake;
    });
    const PathPlace &paths = links.paths.of_tree[number];
    place.insert(place.end(), {at.block, at.item, at.stride, is_out ? 0 : at.links, paths.block, paths.entries,
                               links.freedoms[number], at.first});
    for (uint32_t k = 0; k < tree.size(); ++k) {
      const uint32_t index = index_of_body[tree[k]];
      body[at.row(1, k, 0)] = index;
      const std::array<uint32_t, LINK_WORDS> words{index_of_body[tree.front()], number, k};
      std::copy(words.begin(), words.end(), body_link.begin() + ptrdiff_t{LINK_WORDS} * index);
    }
  }
  uploads.add(Buffer::link_body, std::move(body));
  uploads.add(Buffer::articulation_place, std::move(place));
  uploads.add(Buffer::body_link, std::move(body_link));
}

} // namespace tandem
