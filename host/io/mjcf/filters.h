/* filters.h - which geoms collide: MuJoCo's contype and conaffinity, and excluded pairs of bodies, as groups and masks.
 *
 * Two geoms collide there if the contype of one and the conaffinity of the other have a bit in common, one way or the
 * other, and two bodies here if each accepts the other. So each combination that occurs is a group of its own, and its
 * mask says with which others it collides. This is not a public header.
 */
#pragma once

#include <set>

#include "host/io/mjcf/geoms.h"

namespace tandem {

struct MjcfFilter {
  uint32_t group = 1, mask = 0xffffffffu;
};

/* What decides on the contacts of a geom. body: any number that excluded pairs refer to. */
struct MjcfContact {
  uint32_t contype = 1, conaffinity = 1;
  size_t body = 0;
};

using MjcfExclusions = std::set<std::pair<size_t, size_t>>;

/* A filter for each geom. More than 32 combinations: excluded pairs collide, with a note in that line; if that does not
 * suffice, InputError of `where`. */
std::vector<MjcfFilter> mjcf_filters(const std::vector<MjcfContact> &geoms, const MjcfExclusions &excluded,
                                     const XmlElement &root, XmlNotes &notes);

} // namespace tandem
