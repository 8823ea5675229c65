/* sleep.cpp - islands fall asleep at the end of a step, and wake before or during one.
 *
 *   | half-spaces | large | awake | asleep | room |      the body buffers; kernels of a step run over the bodies before
 *                                                        those asleep
 *
 * Bodies that fall asleep move behind the others, and their cached pairs go to host/world/sleepers.h. Bodies that wake
 * move to the end of those awake and change places with sleepers that lie there; their pairs are appended to the cached
 * ones. The table in which those awake look for sleepers is changed where others sleep than before, and sorted anew
 * when much of it is out of order (shared/sleeping/sleeper_table.h). So waking costs what moves, and falling asleep
 * what was awake; neither costs what sleeps, but for the places of the links of articulations, which are told anew.
 *
 * A large body that wakes is one of the small ones from then on: the broadphase finds the same pairs, and takes longer.
 *
 * An island wakes when a body that is awake touches it, when a call changes one of its bodies or a body that is joined
 * to one, or when a body beside it is destroyed or set elsewhere. Its joints sleep and wake with it
 * (host/world/joint_order.h).
 */
#include <algorithm>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "host/pipeline/broadphases/broadphase.h"
#include "host/pipeline/scene_counts.h"
#include "host/pipeline/sleeping.h"
#include "host/scene/parameters.h"
#include "host/world/implementation.h"
#include "shared/sleeping/table_limits.h"

namespace tandem {
namespace {

size_t words_of(Buffer buffer)
{
  const BufferRow &row = row_of(buffer);
  return row.per_item * size_of(row.element) / sizeof(uint32_t);
}

/* What a pair remembers without regard to which of its bodies is the first. */
bool is_symmetric(Buffer buffer) { return buffer == Buffer::cached_color || buffer == Buffer::cached_touching; }

/* The buffers of the scene and of modules that have a row for each body. Those of body_link name their own place, which
 * tell_joints() gives anew in scenes with articulations; without any they stay what they are. */
bool follows_bodies(Buffer buffer)
{
  if (buffer == Buffer::body_link) return false;
  const BufferRow &row = row_of(buffer);
  const bool kept =
      row.lifetime == Lifetime::SCENE || (row.lifetime == Lifetime::KEPT && index_of(buffer) >= buffer_count);
  return kept &&
         (row.capacity == Capacity::BODIES || row.capacity == Capacity::SHAPES || row.capacity == Capacity::FILTERS);
}

} // namespace

/* Kernels name buffers that only some features fill. */
bool World::Implementation::is_filled(const std::vector<bool> &touched, Buffer buffer) const
{
  const Features feature = row_of(buffer).feature;
  return touched[index_of(buffer)] && (feature == 0 || (feature & special.features) != 0);
}

std::vector<BodyRows> World::Implementation::body_rows(const std::vector<bool> &touched) const
{
  std::vector<BodyRows> rows;
  for (size_t i = 0; i < touched.size(); ++i)
    if (is_filled(touched, buffer_at(i)) && follows_bodies(buffer_at(i)))
      rows.push_back({buffer_at(i), {buffer_at(i)}});
  for (const CarriedBuffer &carried : buffers.carried())
    if (is_filled(touched, carried.now) && row_of(carried.now).capacity == Capacity::BODIES)
      rows.push_back({carried.now, {carried.now, carried.previous}});
  return rows;
}

std::vector<CarriedBuffer> World::Implementation::pair_rows(const std::vector<bool> &touched) const
{
  std::vector<CarriedBuffer> rows;
  for (const CarriedBuffer &carried : buffers.carried())
    if (is_filled(touched, carried.now) && row_of(carried.now).capacity == Capacity::PAIRS) rows.push_back(carried);
  return rows;
}

/* Records what falling asleep and waking launch. */
void World::Implementation::note_sleep(Recorder &recorder) const
{
  StepLaunches step(recorder, plan, settings_in_use);
  append_sleepers(step, plan.bodies);
  renumber_sleepers(recorder, plan.bodies, plan.bodies);
  place_awake_first(step, plan.capacity_pairs);
  recorder.note(Kernel::disturb_rest);
  const std::vector<bool> touched = recorder.touched;
  for (const BodyRows &rows : body_rows(touched)) move_body_rows(recorder, rows, COUNT_LENGTH, plan.bodies);
  for (const BodyRows &rows : joint_rows(touched)) launch_moves_of_joints(recorder, rows, plan.bodies);
  for (const CarriedBuffer &rows : pair_rows(touched))
    move_pair_rows(recorder, rows.now, rows.previous, plan.capacity_pairs);
}

/* Kernels see the bodies that are awake, or for queries all of them. */
void World::Implementation::count_bodies(uint32_t awake)
{
  scene_entries = entries_of({awake, special.unbounded, special.large, bodies() - awake});
  for (const auto &[entry, value] : scene_entries) {
    set_count(memory, static_cast<uint32_t>(entry), value);
    plan.known[static_cast<size_t>(entry)] = value;
  }
  counted_bodies = awake;
}

void World::Implementation::count_awake_bodies()
{
  if (counted_bodies != special.awake) count_bodies(special.awake);
}

/* To be called when other bodies sleep than before. */
void World::Implementation::sleepers_changed(bool sort_anew)
{
  set_of_sleepers = ++sets_of_sleepers;
  tell_sleepers(sort_anew);
}

/* The launches that have ended made the table anew, unless it was right before. */
void World::Implementation::note_sorted()
{
  if (plan.other_sleepers) sorted_sleepers = listed_sleepers = sleepers.count();
  plan.other_sleepers = false;
}

/* Whether so many more may stand in the table unsorted. */
bool World::Implementation::fits_table(uint32_t more) const
{
  return uint64_t{listed_sleepers} + more - sorted_sleepers <= MOST_UNSORTED_SLEEPERS;
}

/* The bodies that fell asleep in the last step lie behind those awake, of which there were so many before. */
void World::Implementation::append_fallen(uint32_t before)
{
  const uint32_t fallen = before - special.awake;
  begin_launches();
  set_length(memory, before);
  StepLaunches step(launcher, plan, settings_in_use);
  append_sleepers(step, fallen);
  launches_ended = true;
  listed_sleepers += fallen;
  set_count(memory, COUNT_LISTED_SLEEPERS, listed_sleepers);
}

void World::Implementation::tell_sleepers(bool sort_anew)
{
  if (sort_anew) set_count(memory, COUNT_SLEEPER_REACH, 0);
  count_bodies(special.awake);
  plan.hits = 0; /* rows of bodies have moved */
  plan.known[COUNT_COMMIT_BODIES] = special.awake;
  plan.known[COUNT_COMMIT_BODIES_PLUS_ONE] = special.awake + 1;
  plan.sleepers = !sleepers.empty();
  plan.other_sleepers = plan.other_sleepers || sort_anew;
  launcher.set_keeps_sleepers(plan.sleepers);
  memory.download(Buffer::cached_start, &cached_pairs, sizeof cached_pairs, special.awake * sizeof cached_pairs);
  forget_kept(memory);
  ++state;
}

/* For buffers that are laid out anew, after those given. Pairs of sleepers have no values in buffers that were not
 * there before. */
Sleepers World::Implementation::sleepers_with(const std::vector<CarriedBuffer> &old_rows) const
{
  std::vector<Sleepers::Part> parts;
  for (const CarriedBuffer &rows : pair_rows(buffers.needs().touched)) {
    Sleepers::Part part{Sleepers::no_words, words_of(rows.now)};
    size_t at = 0;
    for (const CarriedBuffer &old : old_rows) {
      if (old.now == rows.now) part.first = at;
      at += words_of(old.now);
    }
    parts.push_back(part);
  }
  Sleepers rearranged = sleepers;
  rearranged.rearrange(parts);
  return rearranged;
}

/* Their hash is that of rows of four impulses and of features, as hash_carried has it: zeros where pairs of single
 * points leave them out. Pairs that fell asleep before the scene had others have an impulse beside the row. */
uint64_t World::Implementation::hash_sleepers(uint64_t seed) const
{
  if (sleepers.count() == 0) return seed;
  const bool several = (special.features & FEATURE_SEVERAL_POINTS) != 0;
  std::vector<Sleepers::Part> parts;
  size_t at = 0, single = Sleepers::no_words, rows_of_points = Sleepers::no_words;
  for (const CarriedBuffer &rows : buffers.carried()) {
    const std::vector<bool> &touched = buffers.needs().touched;
    if (row_of(rows.now).capacity != Capacity::PAIRS || !touched[index_of(rows.now)]) continue;
    const bool filled = is_filled(touched, rows.now);
    const size_t words = words_of(rows.now);
    const Features feature = row_of(rows.now).feature & ~FEATURE_SEVERAL_POINTS;
    const bool is_of_scene = feature == 0 || (feature & scene_features) != 0; /* others are there unspecialised */
    if (filled && rows.now == Buffer::cached_single_impulse) single = at;
    if (filled && rows.now == Buffer::cached_normal_impulse) rows_of_points = at;
    if (rows.now == Buffer::cached_normal_impulse && !filled) parts.push_back({Sleepers::no_words, words - 1});
    else if (rows.now == Buffer::cached_feature && !filled) parts.push_back({Sleepers::no_words, words});
    else if (filled && is_of_scene && !(several && rows.now == Buffer::cached_single_impulse))
      parts.push_back({at, words});
    if (filled) at += words;
  }
  Sleepers whole = sleepers;
  if (single != Sleepers::no_words && rows_of_points != Sleepers::no_words) whole.join_impulses(single, rows_of_points);
  whole.rearrange(parts);
  return whole.hash(seed);
}

/* What the host knows of motion, found anew: after a state has been put back. */
void World::Implementation::recount_motion()
{
  awake_dynamics = 0;
  moving_kinematics.clear();
  for (uint32_t index = 0; index < bodies(); ++index) {
    const uint32_t slot = special.order[index];
    if (slots.status()[slot] != BodyStatus::present) continue;
    if (scene.bodies[slot].type == BodyType::dynamic && index < special.awake) ++awake_dynamics;
    if (scene.bodies[slot].type != BodyType::kinematic) continue;
    const BodyState now = download_body(memory, index);
    note_motion(slot, {now.linear_velocity, now.angular_velocity});
  }
}

void World::Implementation::keep_order_of_events()
{
  const bool listed = settings.events || settings.pair_events || settings.moved_bodies;
  if (order_of_events.empty() && listed) order_of_events = special.order;
}

namespace {

/* The rows of pairs from `first` to `end`, as host/world/sleepers.h keeps them. */
std::vector<std::vector<uint32_t>> read_pairs(Memory &memory, const std::vector<CarriedBuffer> &rows, uint32_t first,
                                              uint32_t end)
{
  std::vector<std::vector<uint32_t>> pairs(end - first);
  for (const CarriedBuffer &row : rows) {
    const size_t words = words_of(row.now);
    const auto values = memory.read<uint32_t>(row.now, pairs.size() * words, first * words);
    for (size_t k = 0; k < pairs.size(); ++k)
      pairs[k].insert(pairs[k].end(), &values[k * words], &values[k * words] + words);
  }
  return pairs;
}

} // namespace

/* The last step chose who falls asleep; its lists are still in the buffers. */
void World::Implementation::put_to_sleep()
{
  if (plan.known[COUNT_FALLING_ASLEEP] == 0) return;
  const uint32_t before = special.awake, pairs = plan.known[COUNT_COMMIT_PAIRS];
  const auto falls = memory.read<uint32_t>(Buffer::falls_asleep, before),
             labels = memory.read<uint32_t>(Buffer::island_label, before);
  keep_order_of_events();
  begin_launches();
  set_length(memory, pairs);
  StepLaunches step(launcher, plan, settings_in_use);
  place_awake_first(step, pairs);
  const std::vector<CarriedBuffer> of_pairs = pair_rows(buffers.needs().touched);
  for (const CarriedBuffer &rows : of_pairs) {
    move_pair_rows(launcher, rows.now, rows.previous, pairs);
    memory.exchange(rows.now, rows.previous);
  }
  for (const BodyRows &rows : body_rows(buffers.needs().touched)) move_body_rows(launcher, rows, COUNT_BODIES, before);
  take_fallen(falls, labels);
  put_joints_to_sleep();
  launches_ended = true;
  const bool appends = is_table_right() && fits_table(before - special.awake);
  sleepers_changed(!appends);
  if (appends) append_fallen(before);
}

/* Reorders the tables of the host as the kernels have reordered the buffers, and takes the pairs of those who fell
 * asleep. */
void World::Implementation::take_fallen(const std::vector<uint32_t> &falls, const std::vector<uint32_t> &labels)
{
  const uint32_t before = special.awake;
  std::map<uint32_t, SleepingIsland> islands; /* by label */
  std::vector<uint32_t> order, fallen, label_of_fallen;
  for (uint32_t i = 0; i < before; ++i) {
    if (!falls[i]) order.push_back(special.order[i]);
    if (falls[i]) fallen.push_back(special.order[i]), label_of_fallen.push_back(labels[i]);
    if (falls[i]) islands[labels[i]].bodies.push_back(special.order[i]);
  }
  special.large -= static_cast<uint32_t>(std::count(falls.begin(), falls.begin() + special.large, 1u));
  special.awake = static_cast<uint32_t>(order.size());
  order.insert(order.end(), fallen.begin(), fallen.end());
  std::copy(order.begin(), order.end(), special.order.begin());
  for (uint32_t i = 0; i < before; ++i) index_of_body[order[i]] = i;

  const uint32_t first = memory.read<uint32_t>(Buffer::cached_start, 1, special.awake).front(),
                 end = plan.known[COUNT_COMMIT_PAIRS];
  const auto owners = memory.read<uint32_t>(Buffer::pair_a, end - first, first),
             others = memory.read<uint32_t>(Buffer::cached_b, end - first, first);
  auto words = read_pairs(memory, pair_rows(buffers.needs().touched), first, end);
  for (size_t k = 0; k < words.size(); ++k) {
    const uint32_t one = owners[k] >= special.awake ? owners[k] : others[k];
    islands[label_of_fallen[one - special.awake]].pairs.push_back(
        {order[owners[k]], order[others[k]], std::move(words[k])});
  }
  for (auto &[label, island] : islands) {
    for (const uint32_t slot : island.bodies) sleep_events_to_come.push_back({slots.id_of(slot), true});
    sleepers.add(std::move(island));
  }
  awake_dynamics -= static_cast<uint32_t>(fallen.size());
}

/* Moves rows of bodies from one place to another on the devices, all at once; carried: also the rows that steps hand
 * on. */
void World::Implementation::move_rows(const std::vector<uint32_t> &from, const std::vector<uint32_t> &to, bool carried)
{
  if (from.empty()) return;
  const auto moved = static_cast<uint32_t>(from.size());
  memory.upload(Buffer::move_from, from.data(), moved * sizeof(uint32_t));
  memory.upload(Buffer::move_to, to.data(), moved * sizeof(uint32_t));
  set_length(memory, moved);
  for (const BodyRows &rows : body_rows(buffers.needs().touched))
    if (carried || !is_carried(row_of(rows.from).lifetime)) move_body_rows(launcher, rows, COUNT_LENGTH, moved);
}

/* Moves bodies that lie behind those awake to the end of those awake; what lies there takes their places. Returns how
 * many have moved: those listed in move_from and move_to. */
uint32_t World::Implementation::bring_forward(const std::vector<uint32_t> &woken)
{
  const auto first = special.awake, count = static_cast<uint32_t>(woken.size());
  if (first + count == bodies()) { /* all that sleep; they lie there already */
    special.awake = bodies();
    return 0;
  }
  const std::set<uint32_t> moving(woken.begin(), woken.end());
  std::vector<uint32_t> from, to, vacated;
  for (uint32_t k = 0; k < count; ++k) {
    from.push_back(index_of_body[woken[k]]);
    to.push_back(first + k);
    if (from.back() >= first + count) vacated.push_back(from.back());
  }
  std::sort(vacated.begin(), vacated.end());
  for (uint32_t i = first; i < first + count; ++i)
    if (!moving.contains(special.order[i])) from.push_back(i);
  to.insert(to.end(), vacated.begin(), vacated.end());

  move_rows(from, to, true);
  std::vector<uint32_t> moved;
  for (const uint32_t place : from) moved.push_back(special.order[place]);
  for (size_t k = 0; k < to.size(); ++k) {
    special.order[to[k]] = moved[k];
    index_of_body[moved[k]] = to[k];
  }
  special.awake += count;
  return static_cast<uint32_t>(from.size());
}

namespace {

/* A pair that returns to the cache, by the present indices of its bodies. */
struct ReturningPair {
  uint32_t a, b;
  const std::vector<uint32_t> *words;
  bool turned; /* a has become the lower one */
};

} // namespace

/* Appends the pairs of bodies that have come to the end of those awake. Contacts of a pair whose bodies have changed
 * their order begin anew, because their features belong to the other order. */
void World::Implementation::return_pairs(const std::vector<SleepingIsland> &islands, uint32_t first)
{
  std::vector<ReturningPair> pairs;
  for (const SleepingIsland &island : islands)
    for (const SleepingPair &pair : island.pairs) {
      const uint32_t a = index_of_body[pair.a], b = index_of_body[pair.b];
      pairs.push_back({std::max(a, b), std::min(a, b), &pair.words, a < b});
    }
  std::stable_sort(pairs.begin(), pairs.end(), [](const ReturningPair &one, const ReturningPair &other) {
    return std::pair(one.a, one.b) < std::pair(other.a, other.b);
  });
  const uint32_t cached = memory.read<uint32_t>(Buffer::cached_start, 1, first).front();
  std::vector<uint32_t> starts;
  size_t pair = 0;
  for (uint32_t body = first; body < special.awake; ++body) {
    while (pair < pairs.size() && pairs[pair].a == body) ++pair;
    starts.push_back(cached + static_cast<uint32_t>(pair));
  }
  memory.upload(Buffer::cached_start, starts.data(), starts.size() * sizeof(uint32_t), (first + 1) * sizeof(uint32_t));
  size_t at = 0;
  for (const CarriedBuffer &rows : pair_rows(buffers.needs().touched)) {
    const size_t words = words_of(rows.now);
    std::vector<uint32_t> values;
    for (const ReturningPair &one : pairs) {
      if (rows.now == Buffer::cached_b) values.push_back(one.b);
      else if (one.turned && !is_symmetric(rows.now)) values.insert(values.end(), words, 0u);
      else
        values.insert(values.end(), one.words->begin() + static_cast<ptrdiff_t>(at),
                      one.words->begin() + static_cast<ptrdiff_t>(at + words));
    }
    at += words;
    if (!values.empty())
      memory.upload(rows.now, values.data(), values.size() * sizeof(uint32_t), cached * words * sizeof(uint32_t));
  }
}

/* islands: numbers, in ascending order. */
void World::Implementation::wake(const std::set<uint32_t> &islands)
{
  if (islands.empty()) return;
  count_awake_bodies();
  size_t pairs = memory.read<uint32_t>(Buffer::cached_start, 1, special.awake).front();
  for (const uint32_t island : islands) pairs += sleepers.all().at(island).pairs.size();
  if (pairs > plan.capacity_pairs) {
    forget_contacts();
    enlarge({static_cast<uint32_t>(std::min<uint64_t>(room_for(pairs), most_pairs)), plan.capacity_candidates});
  }
  keep_order_of_events();
  std::vector<SleepingIsland> woken;
  std::vector<uint32_t> bodies_woken;
  for (const uint32_t island : islands) {
    woken.push_back(sleepers.take(island));
    bodies_woken.insert(bodies_woken.end(), woken.back().bodies.begin(), woken.back().bodies.end());
  }
  const uint32_t first = special.awake;
  const uint32_t moved = bring_forward(bodies_woken);
  if (moved > 0 && is_table_right()) renumber_sleepers(launcher, special.awake, moved);
  return_pairs(woken, first);
  wake_joints(bodies_woken);
  const std::vector<uint32_t> none(bodies_woken.size());
  memory.upload(Buffer::resting_steps, none.data(), none.size() * sizeof(uint32_t), first * sizeof(uint32_t));
  for (const uint32_t slot : bodies_woken) sleep_events_to_come.push_back({slots.id_of(slot), false});
  awake_dynamics += static_cast<uint32_t>(bodies_woken.size());
  rows_bring_wishes();
  sleepers_changed(!is_table_right() || sleepers.count() < sorted_sleepers / 2); /* many entries would be empty */
}

void World::Implementation::wake_all()
{
  std::set<uint32_t> islands;
  for (const auto &[number, island] : sleepers.all()) islands.insert(number);
  wake(islands);
}

/* The islands of these bodies and of what is joined to them, and of those beside them if asked. A body that cannot
 * sleep may have a joint with one that does. */
void World::Implementation::wake_bodies(std::span<const uint32_t> of_slots, bool beside)
{
  if (sleepers.empty()) return;
  std::set<uint32_t> islands;
  for (const uint32_t slot : of_slots) {
    if (sleepers.sleeps(slot)) islands.insert(sleepers.island_of(slot));
    islands.merge(islands_joined_to(slot));
    if (!beside) continue;
    const std::vector<uint32_t> found = sleepers.beside(slot);
    islands.insert(found.begin(), found.end());
  }
  wake(islands);
}

/* The narrowphase has found contacts with these sleepers (STATUS_WAKE). */
void World::Implementation::wake_touched()
{
  std::set<uint32_t> islands;
  for (const uint32_t index : memory.read<uint32_t>(Buffer::touched_sleeper, plan.known[COUNT_SLEEPER_PAIRS]))
    if (index != INDEX_NONE) islands.insert(sleepers.island_of(special.order[index]));
  wake(islands);
}

/* True if no body would move in the next step. */
bool World::Implementation::nothing_moves() const
{
  return settings.sleeping && awake_dynamics == 0 && moving_kinematics.empty() && settings.extensions.empty() &&
         state == quiet_state && commands.empty() && force_commands.empty() && !pending_joints && whole;
}

} // namespace tandem
