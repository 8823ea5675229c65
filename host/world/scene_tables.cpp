/* scene_tables.cpp - joins the tables of scenes, and takes them apart; see scene_tables.h. */
#include "host/world/scene_tables.h"

#include <algorithm>
#include <memory>
#include <tuple>

#include "host/scene/joint_rows.h"

namespace tandem {
namespace {

bool are_equal(const Shape &a, const Shape &b)
{
  return std::tie(a.type, a.size, a.hull, a.mesh, a.compound) == std::tie(b.type, b.size, b.hull, b.mesh, b.compound);
}

auto fields_of(const Material &m)
{
  return std::tie(m.name, m.static_friction, m.dynamic_friction, m.restitution, m.friction_combine,
                  m.restitution_combine, m.rolling_friction, m.spinning_friction);
}

bool are_same(const Material &a, const Material &b) { return fields_of(a) == fields_of(b); }

/* Children of compounds name materials of the scene, too. */
Shape with_materials_from(uint32_t first, Shape shape)
{
  if (!shape.compound || first == 0) return shape;
  auto moved = std::make_shared<Compound>(*shape.compound);
  for (Child &child : moved->children)
    if (child.material) *child.material += first;
  shape.compound = std::move(moved);
  return shape;
}

/* A joint with its bodies numbered from another first one. */
Joint renumbered(Joint joint, uint32_t from, uint32_t to)
{
  for (uint32_t *body : {&joint.body_a, &joint.body_b})
    if (*body != no_body) *body += to - from;
  return joint;
}

Coupling renumbered(Coupling coupling, size_t from, size_t to)
{
  for (uint32_t *joint : {&coupling.joint_a, &coupling.joint_b}) *joint += static_cast<uint32_t>(to - from);
  return coupling;
}

} // namespace

void SceneTables::add_table(const Scene &scene, Scene &all)
{
  const auto first_shape = static_cast<uint32_t>(all.shapes.size()),
             first_material = static_cast<uint32_t>(all.materials.size());
  for (const Shape &shape : scene.shapes) all.shapes.push_back(with_materials_from(first_material, shape));
  all.materials.insert(all.materials.end(), scene.materials.begin(), scene.materials.end());
  tables_.push_back({scene.name, scene.shapes, scene.materials, first_shape, first_material});
}

/* Only the last table is looked at, so that adding takes the same time for each of many scenes. */
void SceneTables::add(const Scene &scene, Scene &all)
{
  const auto has_tables = [&](const Table &table) {
    return table.name == scene.name && std::ranges::equal(table.shapes, scene.shapes, are_equal) &&
           std::ranges::equal(table.materials, scene.materials, are_same);
  };
  if (tables_.empty() || !has_tables(tables_.back())) add_table(scene, all);
  table_of_.push_back(static_cast<uint32_t>(tables_.size() - 1));
  const auto first_body = static_cast<uint32_t>(all.bodies.size());
  std::vector<uint32_t> number_of; /* of each joint of the scene, in that of them all */
  for (const Joint &joint : scene.joints) {
    number_of.push_back(static_cast<uint32_t>(all.joints.size()));
    if (!is_vacant(joint)) all.joints.push_back(renumbered(joint, 0, first_body));
  }
  for (Coupling coupling : scene.couplings) {
    coupling.joint_a = number_of[coupling.joint_a];
    coupling.joint_b = number_of[coupling.joint_b];
    all.couplings.push_back(std::move(coupling));
  }
  for (Articulation articulation : scene.articulations) {
    for (uint32_t &joint : articulation.joints) joint = number_of[joint];
    if (articulation.root != no_body) articulation.root += first_body;
    all.articulations.push_back(std::move(articulation));
  }
  for (Actuator actuator : scene.actuators) {
    actuator.joint = number_of[actuator.joint];
    all.actuators.push_back(std::move(actuator));
  }
  first_joint_.push_back(all.joints.size());
  first_coupling_.push_back(all.couplings.size());
  first_articulation_.push_back(all.articulations.size());
  first_actuator_.push_back(all.actuators.size());
  for (Body body : scene.bodies) {
    body.shape += tables_.back().first_shape;
    body.material += tables_.back().first_material;
    all.bodies.push_back(std::move(body));
  }
}

Scene SceneTables::scene_of(uint32_t world, const Scene &all, uint32_t bodies, const Vec3 &gravity) const
{
  const Table &own = table(world);
  Scene scene;
  scene.name = own.name;
  scene.gravity = gravity;
  scene.shapes = own.shapes;
  scene.materials = own.materials;
  const auto first = all.bodies.begin() + static_cast<ptrdiff_t>(size_t{world} * bodies);
  scene.bodies.assign(first, first + bodies);
  for (size_t k = first_joint_[world]; k < first_joint_[world + 1]; ++k)
    scene.joints.push_back(renumbered(all.joints[k], world * bodies, 0));
  for (size_t k = first_coupling_[world]; k < first_coupling_[world + 1]; ++k)
    scene.couplings.push_back(renumbered(all.couplings[k], first_joint_[world], 0));
  for (size_t k = first_articulation_[world]; k < first_articulation_[world + 1]; ++k) {
    Articulation articulation = all.articulations[k];
    for (uint32_t &joint : articulation.joints) joint -= static_cast<uint32_t>(first_joint_[world]);
    if (articulation.root != no_body) articulation.root -= world * bodies;
    scene.articulations.push_back(std::move(articulation));
  }
  for (size_t k = first_actuator_[world]; k < first_actuator_[world + 1]; ++k)
    scene.actuators.emplace_back(all.actuators[k]).joint -= static_cast<uint32_t>(first_joint_[world]);
  for (Body &body : scene.bodies) {
    body.shape -= own.first_shape;
    body.material -= own.first_material;
  }
  return scene;
}

} // namespace tandem
