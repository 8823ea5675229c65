/* filters.cpp - a bit for each combination that occurs; see filters.h. */
#include "host/io/mjcf/filters.h"

#include <algorithm>
#include <tuple>

namespace tandem {
namespace {

constexpr size_t most_groups = 32;
constexpr size_t any_body = size_t(-1);

/* contype, conaffinity, and the body if pairs with it are excluded. */
using Combination = std::tuple<uint32_t, uint32_t, size_t>;

bool collide(const Combination &a, const Combination &b, const MjcfExclusions &excluded)
{
  const auto &[type_a, affinity_a, body_a] = a;
  const auto &[type_b, affinity_b, body_b] = b;
  if (excluded.count({body_a, body_b}) || excluded.count({body_b, body_a})) return false;
  return (type_a & affinity_b) != 0 || (type_b & affinity_a) != 0;
}

std::vector<Combination> combinations_of(const std::vector<MjcfContact> &geoms, const MjcfExclusions &excluded)
{
  std::set<size_t> named;
  for (const auto &[a, b] : excluded) named.insert({a, b});
  std::vector<Combination> combinations;
  for (const MjcfContact &geom : geoms)
    combinations.emplace_back(geom.contype, geom.conaffinity, named.count(geom.body) ? geom.body : any_body);
  return combinations;
}

} // namespace

std::vector<MjcfFilter> mjcf_filters(const std::vector<MjcfContact> &geoms, const MjcfExclusions &excluded,
                                     const XmlElement &root, XmlNotes &notes)
{
  const std::vector<Combination> all = combinations_of(geoms, excluded);
  std::vector<Combination> distinct;
  for (const Combination &one : all)
    if (distinct.size() <= most_groups && std::find(distinct.begin(), distinct.end(), one) == distinct.end())
      distinct.push_back(one);
  if (distinct.size() > most_groups && excluded.empty())
    root.fail("more than 32 combinations of contype and conaffinity; a scene has 32 groups");
  if (distinct.size() > most_groups) {
    notes.add(root, "more than 32 groups of geoms: excluded pairs collide");
    return mjcf_filters(geoms, {}, root, notes);
  }
  std::vector<MjcfFilter> filters;
  for (const Combination &one : all) {
    MjcfFilter filter;
    for (size_t bit = 0; bit < distinct.size(); ++bit) {
      if (one == distinct[bit]) filter.group = uint32_t(1) << bit;
      if (!collide(one, distinct[bit], excluded)) filter.mask &= ~(uint32_t(1) << bit);
    }
    filters.push_back(filter);
  }
  return filters;
}

} // namespace tandem
