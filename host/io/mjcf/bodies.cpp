/* bodies.cpp - walks <worldbody>; see bodies.h. */
#include "host/io/mjcf/bodies.h"

#include <fmt/format.h>

#include "host/io/mjcf/joints.h"

namespace tandem {
namespace {

constexpr size_t most_elements = 100'000, most_visits = 1'000'000;

} // namespace

void MjcfBodies::count(const XmlElement &element)
{
  if (++elements_ > most_elements)
    element.fail(fmt::format("more than {} bodies, geoms and frames up to here, replicas included", most_elements));
}

/* Elements of other kinds are few in a robot, but replicas may read each of them again and again. */
void MjcfBodies::count_visits(const XmlElement &element)
{
  visits_ += element.children.size();
  if (visits_ > most_visits)
    element.fail(fmt::format("more than {} elements up to here, replicas included", most_visits));
}

void MjcfBodies::read_frame(const XmlElement &frame, const Place &at)
{
  constexpr const char *known[] = {MJCF_FRAME, "name", "childclass"};
  notes_.add_other_attributes(frame, known);
  count(frame);
  Place inner = at;
  inner.frame = at.frame * compiler_.frame_of(frame);
  inner.class_of_body = frame.text("childclass").value_or(at.class_of_body);
  read_children(frame, inner);
}

/* Each replica stands in the frame of the one before by the offset and the turn. Names end with its number. */
void MjcfBodies::read_replicas(const XmlElement &replicate, const Place &at)
{
  constexpr const char *known[] = {"count", "offset", "euler", "sep", "childclass"};
  notes_.add_other_attributes(replicate, known);
  const double number = replicate.needed_number("count");
  if (!(number >= 1) || number != std::floor(number) || number > double(most_elements))
    replicate.fail(fmt::format("count is {:g}; a whole number from 1 to {} is needed", number, most_elements));
  XmlElement pose = replicate;
  pose.attributes.erase("pos");
  if (replicate.has("offset")) pose.attributes["pos"] = *replicate.text("offset");
  const RigidFrame next = compiler_.frame_of(pose);
  Place inner = at;
  inner.class_of_body = replicate.text("childclass").value_or(at.class_of_body);
  const size_t digits = fmt::format("{}", size_t(number) - 1).size();
  for (size_t k = 0; k < size_t(number); ++k) {
    count(replicate);
    inner.suffix = fmt::format("{}{}{:0{}}", at.suffix, replicate.text("sep").value_or(""), k, digits);
    read_children(replicate, inner);
    inner.frame = inner.frame * next;
  }
}

void MjcfBodies::read_geom(const XmlElement &geom, const Place &at)
{
  count(geom);
  XmlElement completed = defaults_.completed(geom, at.class_of_body);
  if (geom.has("name")) completed.attributes["name"] += at.suffix;
  const std::optional<MjcfGeom> read = geoms_.read(completed, at.frame);
  if (!read) return;
  links[at.link].shapes.push_back(read->shape);
  contacts_[at.link].push_back({read->contype, read->conaffinity, 0});
  if (read->mass.mass > 0) masses_[at.link].push_back(read->mass);
}

void MjcfBodies::read_joint(const XmlElement &joint, const Place &at)
{
  Link &link = links[at.link];
  if (at.link == 0) joint.fail("the world has no joints; put it into a body");
  const XmlElement completed = joint.name == "freejoint" ? joint : defaults_.completed(joint, at.class_of_body);
  if (link.floats) joint.fail("a joint beside a free one; a body that floats has no others");
  movers_[at.link] = at.link;
  if (joint.name == "freejoint" || completed.text("type").value_or("") == "free") {
    if (link.parent != 0) joint.fail("an inner body does not float; put the body into <worldbody>");
    if (!link.joints.empty()) joint.fail("a free joint beside others; a body that floats has no others");
    link.floats = true;
    return;
  }
  const std::string name = joint.text("name").value_or("");
  const std::string label = name.empty() ? fmt::format("{} joint {}", link.name, link.joints.size()) : name + at.suffix;
  link.joints.push_back(mjcf_joint(completed, compiler_, at.frame, label, notes_));
  const MjcfJointPlace place{at.link, link.joints.size() - 1, mjcf_reference(completed, compiler_)};
  if (!name.empty() && !joints.emplace(label, place).second)
    joint.fail("a joint of that name stands before; names are needed once");
}

void MjcfBodies::read_inertial(const XmlElement &inertial, const Place &at)
{
  constexpr const char *known[] = {MJCF_FRAME, "mass", "diaginertia", "fullinertia"};
  notes_.add_other_attributes(inertial, known);
  const double mass = inertial.needed_number("mass");
  if (!(mass >= 0)) inertial.fail(fmt::format("mass is {:g} kg; at least 0 is needed", mass));
  MassProperties own{mass, {}, {}};
  const std::vector<double> full = inertial.numbers("fullinertia", 6, 6);
  if (!full.empty()) own.inertia = {full[0], full[1], full[2], full[3], full[4], full[5]};
  else if (const auto three = inertial.vector("diaginertia"))
    own.inertia = {(*three)[0], (*three)[1], (*three)[2], 0, 0, 0};
  else inertial.fail("diaginertia or fullinertia is missing; one is needed");
  if (inertials_[at.link]) inertial.fail("a second one in its body; at most one is needed");
  inertials_[at.link] = placed_mass(own, at.frame * compiler_.frame_of(inertial));
}

void MjcfBodies::read_body(const XmlElement &body, const Place &at)
{
  constexpr const char *known[] = {MJCF_FRAME, "name", "childclass", "gravcomp"};
  notes_.add_other_attributes(body, known);
  count(body);
  Link link;
  const std::string name = body.text("name").value_or("");
  link.name = name.empty() ? fmt::format("body {}", links.size()) : name + at.suffix;
  link.line = body.line;
  link.parent = at.link;
  link.pose = at.frame * compiler_.frame_of(body);
  link.gravity_factor = round_to_float(1 - body.number_or("gravcomp", 0));
  if (!name.empty() && !names_.emplace(link.name, links.size()).second)
    body.fail("a body of that name stands before; names are needed once");
  const Place inner{links.size(), {}, body.text("childclass").value_or(at.class_of_body), at.suffix};
  movers_.push_back(movers_[at.link]);
  masses_.emplace_back();
  inertials_.emplace_back();
  contacts_.emplace_back();
  links.push_back(link);
  read_children(body, inner);
}

void MjcfBodies::read_children(const XmlElement &element, const Place &at)
{
  constexpr const char *known[] = {"body", "frame", "replicate", "geom", "joint", "freejoint", "inertial"};
  count_visits(element);
  notes_.add_other_children(element, known);
  for (const XmlElement &child : element.children) {
    if (child.name == "joint" || child.name == "freejoint") read_joint(child, at);
    if (child.name == "geom") read_geom(child, at);
    if (child.name == "inertial") read_inertial(child, at);
  }
  for (const XmlElement &child : element.children) {
    if (child.name == "frame") read_frame(child, at);
    if (child.name == "replicate") read_replicas(child, at);
    if (child.name == "body") read_body(child, at);
  }
}

void MjcfBodies::read(const XmlElement &world)
{
  if (links.empty()) {
    Link fixed;
    fixed.name = "world";
    fixed.line = world.line;
    links.push_back(fixed);
    movers_.push_back(Link::world);
    masses_.emplace_back();
    inertials_.emplace_back();
    contacts_.emplace_back();
    names_.emplace("world", 0);
  }
  read_children(world, {0, {}, world.text("childclass").value_or(""), ""});
  for (size_t k = 0; k < links.size(); ++k) {
    const bool given = inertials_[k] && compiler_.inertia != MjcfCompiler::from_geoms;
    if (given) links[k].mass = inertials_[k];
    else if (compiler_.inertia != MjcfCompiler::from_inertial && !masses_[k].empty())
      links[k].mass = compound_mass(masses_[k]);
  }
}

size_t MjcfBodies::link_of(const XmlElement &element, const char *key) const
{
  const std::string name = element.needed_text(key);
  const auto found = names_.find(name);
  if (found == names_.end()) element.fail(fmt::format("body \"{}\" does not exist in this file", name));
  return found->second;
}

RigidFrame MjcfBodies::place_of(size_t link) const
{
  RigidFrame place;
  for (; link != Link::world; link = links[link].parent) place = links[link].pose * place;
  return place;
}

void MjcfBodies::set_filters(const MjcfExclusions &excluded, const XmlElement &root)
{
  std::vector<MjcfContact> all;
  for (size_t k = 0; k < links.size(); ++k)
    for (MjcfContact contact : contacts_[k]) {
      contact.body = mover_of(k);
      all.push_back(contact);
    }
  const std::vector<MjcfFilter> filters = mjcf_filters(all, excluded, root, notes_);
  size_t next = 0;
  for (Link &link : links)
    for (LinkShape &shape : link.shapes) {
      shape.filter_group = filters[next].group;
      shape.filter_mask = filters[next].mask;
      ++next;
    }
}

} // namespace tandem
