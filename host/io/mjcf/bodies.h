/* bodies.h - the tree below <worldbody>: bodies, frames and replicas become links. This is not a public header. */
#pragma once

#include "host/io/mjcf/filters.h"

namespace tandem {

/* A joint by its name: where it is among the links, and its reference. */
struct MjcfJointPlace {
  size_t link, joint;
  double reference;
};

class MjcfBodies {
public:
  MjcfBodies(const MjcfCompiler &compiler, const MjcfDefaults &defaults, MjcfGeoms &geoms, XmlNotes &notes)
      : compiler_(compiler), defaults_(defaults), geoms_(geoms), notes_(notes)
  {}
  /* Fails, with the element, for a name that stands twice, for a joint of the world, for a free joint of an inner body,
   * and for more than 100,000 bodies and geoms or 1,000,000 elements in all, replicas included. */
  void read(const XmlElement &world);
  /* The link of a body; Link::world for "world". */
  size_t link_of(const XmlElement &element, const char *key) const;
  /* The link that moves and of which this one is a part, or Link::world. */
  size_t mover_of(size_t link) const { return link == Link::world ? link : movers_[link]; }
  RigidFrame place_of(size_t link) const;
  void set_filters(const MjcfExclusions &excluded, const XmlElement &root);

  std::vector<Link> links;
  std::map<std::string, MjcfJointPlace> joints;

private:
  struct Place {
    size_t link;
    RigidFrame frame;                  /* in the link */
    std::string class_of_body, suffix; /* of names in a replica */
  };
  void read_children(const XmlElement &element, const Place &at);
  void read_frame(const XmlElement &frame, const Place &at);
  void read_replicas(const XmlElement &replicate, const Place &at);
  void read_body(const XmlElement &body, const Place &at);
  void read_joint(const XmlElement &joint, const Place &at);
  void read_geom(const XmlElement &geom, const Place &at);
  void read_inertial(const XmlElement &inertial, const Place &at);
  void count(const XmlElement &element);
  void count_visits(const XmlElement &element);

  const MjcfCompiler &compiler_;
  const MjcfDefaults &defaults_;
  MjcfGeoms &geoms_;
  XmlNotes &notes_;
  std::map<std::string, size_t> names_;
  std::vector<size_t> movers_;
  std::vector<std::vector<MassProperties>> masses_; /* of the geoms of each link */
  std::vector<std::optional<MassProperties>> inertials_;
  std::vector<std::vector<MjcfContact>> contacts_; /* of the shapes of each link */
  size_t elements_ = 0, visits_ = 0;
};

} // namespace tandem
