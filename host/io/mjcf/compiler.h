/* compiler.h - how an MJCF file writes angles and turns, and what its default classes add to elements. This is not a
 * public header. */
#pragma once

#include "host/io/articulated/parts.h"

namespace tandem {

/* The <compiler> elements of a file. */
struct MjcfCompiler {
  bool degrees = true, autolimits = true;
  std::string eulerseq = "xyz", meshdir;
  enum { automatic, from_geoms, from_inertial } inertia = automatic;

  void read(const XmlElement &compiler, XmlNotes &notes);
  double angle(double x) const; /* in radians */
  /* pos, and one of quat, axisangle, euler, xyaxes and zaxis. */
  RigidFrame frame_of(const XmlElement &element) const;
  /* Whether a range applies: `limited`, or if it is auto, that there is a range. */
  bool is_limited(const XmlElement &element, const char *limited, const char *range) const;
};

/* The attributes that frame_of reads. */
#define MJCF_FRAME "pos", "quat", "axisangle", "euler", "xyaxes", "zaxis"

/* Classes within one another; each begins with what its outer class says. */
class MjcfDefaults {
public:
  MjcfDefaults() { classes_["main"]; }
  /* Fails for classes that have more than 1,000,000 attributes in all with what they inherit. */
  void read(const XmlElement &top);
  /* The element, without its children, with the attributes of its class, or of the class of the body it is in, below
   * its own. Fails if there is no such class. */
  XmlElement completed(const XmlElement &element, const std::string &class_of_body) const;

private:
  using Attributes = std::map<std::string, std::string>;
  using Class = std::map<std::string, Attributes>; /* by the name of the element */
  void read_class(const XmlElement &element, const std::string &name, Class inherited);
  std::map<std::string, Class> classes_;
  size_t inherited_ = 0; /* attributes of all classes */
};

} // namespace tandem
