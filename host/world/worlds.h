/* worlds.h - the contents of a batch of worlds, behind the interface of <tandem/worlds.h>: one group of worlds, or
 * several where threads of the CPU step them.
 *
 *                      a device                                 a CPU
 *   worlds      0 1 2 3 4 5 6 7 8 9 10 11       0 1 2 3 | 4 5 6 7 | 8 9 10 11
 *   launches   [ all of them, in one set  ]    [thread 0][thread 1][thread 0]
 *
 * Worlds do not depend on each other, so a group of them (host/world/worlds_group.h) goes through its step on one
 * thread, which waits for no other one, and what it reads and writes stays in the caches of that thread. What a call
 * gives to worlds of several groups, all of them take, or none.
 */
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <tandem/worlds.h>

#include "host/runtime/interface/floating_point.h"
#include "host/runtime/part_threads.h"
#include "host/world/worlds_group.h"

namespace tandem {

struct Worlds::Implementation {
  Implementation(std::span<const Scene> scenes, uint32_t copies, const Settings &given, const Placement &placement);

  /* --- numbers of worlds --- */
  Group &group_of(uint32_t world) { return *groups[world / of_group]; }
  uint32_t number_in_group(uint32_t world) const { return world % of_group; }
  void check_world(const char *call, uint32_t world) const;
  void check(const char *call, std::span<const uint32_t> given) const;
  void check(const char *call, std::span<const WorldBody> given) const;
  void check(const char *call, std::span<const WorldJoint> given);
  bool is_kinematic(const WorldBody &body);
  void check_properties(size_t entry, const WorldBody &body, const BodyProperties &properties);

  /* --- what calls give to each group, and what groups answer --- */
  template <class Item> struct Share {
    Group *group;
    std::vector<Item> items;    /* in the numbers of the group */
    std::vector<size_t> places; /* of each in the call */
  };
  template <class Item> std::vector<Share<Item>> shares_of(std::span<const Item> items);
  /* Gives each group its items with their entries. All groups take them, or none. */
  template <class Item, class Entry, class Call>
  void call(std::span<const Item> items, std::span<const Entry> entries, const Call &call);
  /* The same, where `read` says what items have now, and `write` gives them what they shall have. */
  template <class Item, class Entry, class Read, class Write>
  void replace(std::span<const Item> items, std::span<const Entry> entries, const Read &read, const Write &write);
  /* What `function` answers for each group in turn, one behind the other. */
  template <class Value, class Function> std::vector<Value> gathered(const Function &function);
  template <class Value, class Function> Value total(const Function &function) const;
  /* Calls function(k) for each group k, several at the same time. */
  template <class Function> void for_each_group(const Function &function)
  {
    threads.run(groups.size(), PartFunction(function));
  }

  void step(const StepLimits &limits);
  void check_limits(const StepLimits &limits) const;
  void reset(std::span<const uint32_t> given);
  template <class Chosen> void choose_controls(std::span<const Chosen> chosen);
  void set_controls(std::span<const uint32_t> given, std::span<const float> values);

  Settings settings;
  Placement placement;
  uint32_t worlds = 0, bodies = 0; /* bodies: of each world */
  uint32_t of_group = 1;           /* worlds of each group but the last */
  PartThreads threads;             /* for several groups */
  std::vector<std::unique_ptr<Group>> groups;
  std::vector<WorldBody> every_body; /* made when it is first asked for */
};

inline uint32_t world_of(uint32_t world) { return world; }
inline uint32_t world_of(const WorldBody &body) { return body.world; }
inline uint32_t world_of(const WorldJoint &joint) { return joint.world; }
inline uint32_t in_world(uint32_t, uint32_t number) { return number; }
inline WorldBody in_world(const WorldBody &body, uint32_t number) { return {number, body.body}; }
inline WorldJoint in_world(const WorldJoint &joint, uint32_t number) { return {number, joint.joint}; }

template <class Item>
std::vector<Worlds::Implementation::Share<Item>> Worlds::Implementation::shares_of(std::span<const Item> items)
{
  constexpr size_t none = size_t(-1);
  std::vector<size_t> share_of(groups.size(), none);
  std::vector<Share<Item>> shares;
  for (size_t i = 0; i < items.size(); ++i) {
    const uint32_t world = world_of(items[i]);
    size_t &share = share_of[world / of_group];
    if (share == none) {
      share = shares.size();
      shares.push_back({groups[world / of_group].get(), {}, {}});
    }
    shares[share].items.push_back(in_world(items[i], number_in_group(world)));
    shares[share].places.push_back(i);
  }
  return shares;
}

template <class Entry> std::vector<Entry> entries_at(std::span<const size_t> places, std::span<const Entry> entries)
{
  std::vector<Entry> own;
  own.reserve(places.size());
  for (const size_t place : places) own.push_back(entries[place]);
  return own;
}

template <class Item, class Entry, class Call>
void Worlds::Implementation::call(std::span<const Item> items, std::span<const Entry> entries, const Call &call)
{
  if (groups.size() == 1) return call(*groups.front(), items, entries);
  const std::vector<Share<Item>> shares = shares_of(items);
  std::vector<Group::Mark> marks;
  for (const Share<Item> &share : shares) marks.push_back(share.group->mark());
  try {
    for (const Share<Item> &share : shares)
      call(*share.group, std::span<const Item>(share.items),
           std::span<const Entry>(entries_at<Entry>(share.places, entries)));
  } catch (...) {
    for (size_t k = 0; k < shares.size(); ++k) shares[k].group->take_back(marks[k]);
    throw;
  }
}

template <class Item, class Entry, class Read, class Write>
void Worlds::Implementation::replace(std::span<const Item> items, std::span<const Entry> entries, const Read &read,
                                     const Write &write)
{
  if (groups.size() == 1) return write(*groups.front(), items, entries);
  struct Replacement {
    Share<Item> share;
    std::vector<Entry> before, after;
  };
  std::vector<Replacement> replacements;
  for (Share<Item> &share : shares_of(items)) {
    std::vector<Entry> after = entries_at<Entry>(share.places, entries),
                       before = read(*share.group, std::span<const Item>(share.items), std::span<const Entry>(after));
    replacements.push_back({std::move(share), std::move(before), std::move(after)});
  }
  const auto put = [&](const Replacement &one, const std::vector<Entry> &values) {
    write(*one.share.group, std::span<const Item>(one.share.items), std::span<const Entry>(values));
  };
  size_t done = 0;
  try {
    for (; done < replacements.size(); ++done) put(replacements[done], replacements[done].after);
  } catch (...) {
    while (done-- > 0) put(replacements[done], replacements[done].before); /* needs no more memory than it took */
    throw;
  }
}

template <class Value, class Function> std::vector<Value> Worlds::Implementation::gathered(const Function &function)
{
  if (groups.size() == 1) return function(*groups.front());
  std::vector<std::vector<Value>> each(groups.size());
  for_each_group([&](size_t k) { each[k] = function(*groups[k]); });
  std::vector<Value> all;
  for (const std::vector<Value> &values : each) all.insert(all.end(), values.begin(), values.end());
  return all;
}

template <class Value, class Function> Value Worlds::Implementation::total(const Function &function) const
{
  Value sum{};
  for (const std::unique_ptr<Group> &group : groups) sum += function(*group);
  return sum;
}

template <class Chosen> void Worlds::Implementation::choose_controls(std::span<const Chosen> chosen)
{
  const minicl::ExactFloatingPoint environment;
  std::vector<Controls> controls;
  for (const std::unique_ptr<Group> &group : groups) {
    group->write_controls();
    controls.emplace_back(group->engine(), group->tables, chosen);
  }
  for (size_t k = 0; k < groups.size(); ++k) groups[k]->controls = std::move(controls[k]);
}

} // namespace tandem
