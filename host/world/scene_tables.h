/* scene_tables.h - the shapes, materials, joints, couplings, articulations and actuators of the scenes of a batch, one
 * scene after the other in the scene of them all. Scenes with equal shapes and materials, such as copies of one, share
 * these. */
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <tandem/scene.h>

namespace tandem {

class SceneTables {
public:
  /* Adds bodies, joints, what is of joints, and tables of a world's scene to those of all. */
  void add(const Scene &scene, Scene &all);
  /* The scene of a world of this scene of all, in which so many bodies belong to each. */
  Scene scene_of(uint32_t world, const Scene &all, uint32_t bodies, const Vec3 &gravity) const;

  uint32_t worlds() const { return static_cast<uint32_t>(table_of_.size()); }
  uint32_t materials(uint32_t world) const { return static_cast<uint32_t>(table(world).materials.size()); }
  uint32_t first_joint(uint32_t world) const { return static_cast<uint32_t>(first_joint_[world]); }
  uint32_t joints(uint32_t world) const { return static_cast<uint32_t>(first_joint_[world + 1] - first_joint_[world]); }
  uint32_t first_material(uint32_t world) const { return table(world).first_material; }

private:
  struct Table {
    std::string name;
    std::vector<Shape> shapes;
    std::vector<Material> materials;
    uint32_t first_shape, first_material; /* in the scene of all */
  };
  const Table &table(uint32_t world) const { return tables_[table_of_[world]]; }
  void add_table(const Scene &scene, Scene &all);

  std::vector<Table> tables_;
  std::vector<uint32_t> table_of_; /* by world */
  /* Of each world, and the end. */
  std::vector<size_t> first_joint_ = {0}, first_coupling_ = {0}, first_articulation_ = {0}, first_actuator_ = {0};
};

} // namespace tandem
