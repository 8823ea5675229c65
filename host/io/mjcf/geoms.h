/* geoms.h - shapes, masses, surfaces and meshes of MJCF geoms. This is not a public header. */
#pragma once

#include "host/io/mjcf/compiler.h"

namespace tandem {

struct MjcfGeom {
  LinkShape shape;
  MassProperties mass; /* in the frame of the shape's link; its mass may be 0 */
  uint32_t contype = 1, conaffinity = 1;
};

class MjcfGeoms {
public:
  MjcfGeoms(const MjcfCompiler &compiler, const MjcfDefaults &defaults, OutsideFiles outside, XmlNotes &notes,
            Scene &scene)
      : compiler_(compiler), defaults_(defaults), outside_(outside), notes_(notes), scene_(scene)
  {}
  void read_assets(const XmlElement &asset);
  /* geom: completed by its class; outer: the frame in the link in which its pose is. Nothing, with a note, for a geom
   * of a kind that has no shape here. */
  std::optional<MjcfGeom> read(const XmlElement &geom, const RigidFrame &outer);

private:
  bool set_shape(const XmlElement &geom, MjcfGeom &result, MassProperties &solid);
  const Shape &mesh_shape_of(const XmlElement &geom);
  Shape read_mesh(const XmlElement &mesh) const;
  uint32_t material_of(const XmlElement &geom);

  const MjcfCompiler &compiler_;
  const MjcfDefaults &defaults_;
  OutsideFiles outside_;
  XmlNotes &notes_;
  Scene &scene_;
  std::map<std::string, XmlElement> meshes_;
  std::map<std::string, Shape> hulls_;
  std::map<std::array<float, 4>, uint32_t> materials_;
};

} // namespace tandem
