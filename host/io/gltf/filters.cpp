/* filters.cpp - reads collision filters and converts combinations of systems to bits; see filters.h. */
#include "host/io/gltf/filters.h"

#include <algorithm>
#include <set>

namespace tandem {
namespace {

using Systems = std::set<std::string>;

struct FilterText {
  Systems member_of, listed;
  enum { collides_with_all, only_with_listed, not_with_listed } rule = collides_with_all;

  /* Whether a collider that is in `systems` passes this filter. One that is in no system is in no list. */
  bool accepts(const Systems &systems) const
  {
    bool all_listed = !systems.empty() && std::includes(listed.begin(), listed.end(), systems.begin(), systems.end());
    return rule == collides_with_all || all_listed == (rule == only_with_listed);
  }
};

Systems read_systems(const JsonValue &list)
{
  Systems systems;
  for (size_t i = 0; i < list.array_size(); ++i) systems.insert(list.element(i).text());
  return systems;
}

FilterText read_filter(const JsonValue &json)
{
  static constexpr const char *keys[] = {"collisionSystems", "collideWithSystems", "notCollideWithSystems", "name",
                                         "extras",           "extensions"};
  json.only_keys(keys);
  FilterText filter;
  if (auto list = json.find("collisionSystems")) filter.member_of = read_systems(*list);
  auto only = json.find("collideWithSystems"), except = json.find("notCollideWithSystems");
  if (only && except) json.fail("collideWithSystems and notCollideWithSystems exclude each other");
  if (only || except) filter.listed = read_systems(only ? *only : *except);
  if (only) filter.rule = FilterText::only_with_listed;
  if (except) filter.rule = FilterText::not_with_listed;
  return filter;
}

} // namespace

std::vector<GltfFilter> read_gltf_filters(const JsonValue &bodies_extension)
{
  std::vector<FilterText> texts;
  std::vector<GltfFilter> filters;
  std::optional<JsonValue> list = bodies_extension.find("collisionFilters");
  for (size_t i = 0; list && i < list->array_size(); ++i) texts.push_back(read_filter(list->element(i)));
  std::vector<Systems> combinations{Systems{}};
  for (const FilterText &text : texts) {
    auto at = std::find(combinations.begin(), combinations.end(), text.member_of);
    if (at == combinations.end()) at = combinations.insert(at, text.member_of);
    if (combinations.size() > 32)
      list->fail("more than 31 different combinations of collision systems are not supported yet");
    filters.push_back({uint32_t(1) << (at - combinations.begin()), 0});
  }
  for (size_t i = 0; i < texts.size(); ++i)
    for (size_t bit = 0; bit < combinations.size(); ++bit)
      if (texts[i].accepts(combinations[bit])) filters[i].mask |= uint32_t(1) << bit;
  return filters;
}

} // namespace tandem
