/* step_attempts.cpp - runs a step until it succeeds. Buffers that overflow grow, bodies that stop being finite are
 * quarantined, and a step that fails leaves the state before it. */
#include <algorithm>
#include <new>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "host/base/out_of_memory.h"
#include "host/pipeline/broadphases/broadphase.h"
#include "host/pipeline/scene_counts.h"
#include "host/world/answers.h"
#include "host/world/batch_fault.h"
#include "host/world/implementation.h"
#include "host/world/quarantine_limits.h"

namespace tandem {
namespace {

/* Each repetition fixes one cause; many repetitions in one step mean that something is wrong. */
constexpr size_t most_repetitions = 64;

constexpr uint32_t least_rounds = 4, most_rounds = 1 << 20;

} // namespace

void World::Implementation::step(const StepLimits &limits)
{
  attempt_step(limits);
  complete_step();
}

void World::Implementation::attempt_step(const StepLimits &limits)
{
  check_lost();
  plan.hits = 0;
  if (nothing_moves()) return;
  launcher.set_step(statistics.steps);
  if (automatic) place_as_chosen();
  if (pending_joints)
    answer("new joints", slots.existing(), [&] {
      restore_bodies();
      settle_joints();
    });
  ++state;
  attempt.emplace(Attempt{plan, statistics, first_outgrown, quarantined.size()});
  try {
    if (backends.is_waiting()) place_again();
    if (automatic) automatic->begin_step(backends, static_cast<bool>(launcher.observer()));
    settle();
    if (!is_still_right()) choose_again();
    buffers.make_ready(sizes());
    count_awake_bodies();
    run_until_whole(limits);
    if (settings.check && !fault) fault = find_batch_fault(memory, plan.known, special.order, statistics.steps);
  } catch (...) {
    abandon_step();
    tell_why_step_failed();
  }
}

void World::Implementation::abandon_step() noexcept
{
  if (!attempt) return;
  if (automatic) automatic->abandon_step(backends);
  undo(*attempt);
  attempt.reset();
}

/* Without an attempt nothing moves. */
void World::Implementation::complete_step()
{
  if (!attempt) return sleep_on();
  accept();
  attempt.reset();
  whole = true;
  idle = false;
  backends.note_step(statistics.steps);
  end_step();
  if (automatic) end_timed_step();
  sleep_events = std::exchange(sleep_events_to_come, {});
  quiet_state = state;
  keep_state_of_step();
}

/* Bodies fall asleep as the step has chosen, and joints break, which wakes what hangs on them. Rows move in place, so
 * half of it cannot be undone. */
void World::Implementation::end_step()
{
  try {
    const std::vector<uint32_t> broken = list_broken_joints();
    if (settings.sleeping) put_to_sleep();
    if (!broken.empty()) break_joints(broken);
  } catch (const std::exception &error) {
    lost =
        fmt::format("joints could not break or bodies could not be put to sleep after step {} ({}); the world cannot "
                    "go on, and restore() makes it what it was when it was saved",
                    statistics.steps - 1, error.what());
    throw std::runtime_error(lost);
  }
}

void World::Implementation::check_lost() const
{
  if (!lost.empty()) throw std::runtime_error(lost);
}

/* A step in which nothing moves launches nothing. */
void World::Implementation::sleep_on()
{
  if (backends.is_waiting()) place_again();
  ++statistics.steps;
  idle = true;
  sleep_events.clear();
  joint_breaks.clear();
  keep_state_of_step();
}

/* An attempt without room for all pairs has counted them, and has coloured only some. */
void World::Implementation::check_limits(const StepLimits &limits) const
{
  const auto &known = plan.known;
  const auto check = [](const char *least, uint32_t needed, uint32_t limit, const char *what) {
    if (needed > limit)
      throw LimitExceeded(fmt::format("{}{} {} are needed, and {} are the most that the limits of this step allow",
                                      least, needed, what, limit));
  };
  const bool overflows = (known[COUNT_STATUS] & lacks_pairs) != 0, goes_on = (known[COUNT_STATUS] & STATUS_ROUNDS) != 0;
  if (overflows) check(candidates_overflow() ? "at least " : "", pairs_needed(), limits.pairs, "pairs");
  if (overflows) return;
  if (goes_on && (plan.apart || plan.rounds == 0)) return; /* it coloured nothing, whatever is needed */
  check("", known[COUNT_PAIRS], limits.pairs, "pairs");
  check(goes_on ? "at least " : "", known[COUNT_ROUNDS] + (goes_on ? 1 : 0), limits.rounds, "rounds of colouring");
  if (goes_on) return;
  check("", sequential_contacts(), limits.sequential_contacts, "contacts beyond the last colour");
}

void World::Implementation::run_until_whole(const StepLimits &limits)
{
  bool may_forget = launches_ended && plan.known[COUNT_KEPT] != 0;
  for (size_t repetition = 0; repetition < most_repetitions + taken_one_by_one; ++repetition) {
    tell_substeps();
    begin_launches();
    launch_whole_step();
    memory.download(Buffer::counts, plan.known.data(), sizeof plan.known);
    launches_ended = true;
    plan.forgets_wishes = false;
    if (!(plan.known[COUNT_STATUS] & STATUS_DEADLOCK)) check_limits(limits);
    if (plan.known[COUNT_STATUS] == 0) return;
    turn_back();
    prepare_repetition(plan.known[COUNT_STATUS], may_forget);
  }
  std::set<uint32_t> bodies;
  for (const auto &[index, record] : taken_out) bodies.insert(index);
  throw std::runtime_error(
      fmt::format("it did not complete in {} repetitions, in which {} bodies did not stay finite (status {})",
                  most_repetitions + taken_one_by_one, bodies.size(), plan.known[COUNT_STATUS]));
}

/* Between steps buffers move whole: calls read and write what no launch has described. */
void World::Implementation::launch_whole_step()
{
  if (!launcher.observer()) buffers.forget_scratch();
  parts.begin_step(bodies(), cached_pairs, special.features);
  launcher.set_parts(&parts);
  try {
    launcher.launch_in_series(counts_expected(), [this] { launch_step(launcher, plan, settings_in_use); });
  } catch (...) {
    launcher.set_parts(nullptr);
    throw;
  }
  launcher.set_parts(nullptr);
}

/* Only worlds that choose their substeps ever tell them anew. */
void World::Implementation::tell_substeps()
{
  plan.islands_apart = may_part_islands() && plan.substeps.now > fewest_substeps(settings);
  if (plan.islands_apart) plan.apart = false; /* colours know no classes yet */
  else plan.classes = 0;
  if (plan.islands_apart && plan.classes == 0) plan.classes = FEW_SUBSTEPS | MANY_SUBSTEPS;
  const ToldSubsteps wanted = {plan.substeps.now, plan.substeps.of_cache, plan.islands_apart};
  if (wanted == told_substeps) return;
  Settings before = std::exchange(settings_in_use, with_substeps(settings, choice_of_others()));
  try {
    upload_parameters();
  } catch (...) {
    settings_in_use = std::move(before);
    throw;
  }
  told_substeps = wanted;
}

void World::Implementation::turn() noexcept
{
  turn_carried(memory, buffers.carried());
  turned = true;
}

void World::Implementation::turn_back() noexcept
{
  if (turned) turn_carried(memory, buffers.carried());
  turned = false;
}

void World::Implementation::undo(const Attempt &before) noexcept
{
  turn_back();
  launches_ended = whole = false;
  joint_breaks.clear();
  statistics = before.statistics;
  first_outgrown = before.first_outgrown;
  for (size_t i = before.quarantined; i < quarantined.size(); ++i) {
    slots.release(quarantined[i].body);
    if (scene.bodies[quarantined[i].body].type == BodyType::dynamic) ++awake_dynamics;
  }
  quarantined.erase(quarantined.begin() + static_cast<ptrdiff_t>(before.quarantined), quarantined.end());
  const PairCapacity grown = capacity();
  plan = before.plan;
  plan.apart = false; /* an attempt may have left lists and colours of other pairs */
  rows_bring_wishes();
  if (plan.substeps.automatic) told_substeps = {}; /* it may have left the parameters of some islands */
  set_capacity(grown);
  plan.sleepers = !sleepers.empty();
  plan.other_sleepers = true;
  for (const auto &[entry, value] : scene_entries) plan.known[static_cast<size_t>(entry)] = value;
  plan_joints(); /* the attempt may have woken some */
  if (grown.pairs != before.plan.capacity_pairs) guess_counts();
  try {
    restore_bodies();
  } catch (const std::exception &) { /* the next step restores them before anything else */
  }
}

/* Restores the bodies that were quarantined by an attempt that failed later. */
void World::Implementation::restore_bodies()
{
  if (!taken_out.empty()) tell_articulations();
  for (; !taken_out.empty(); taken_out.pop_back()) write_body(memory, taken_out.back().first, taken_out.back().second);
}

/* Must be called from the handler of the exception. */
void World::Implementation::tell_why_step_failed() const
{
  const auto told = [&](const char *why) {
    return fmt::format("step {}: {}; of {} bodies, with room for {} pairs, in {} bytes of buffers; the state is that "
                       "before the step",
                       statistics.steps, why, slots.existing(), plan.capacity_pairs, memory.total_bytes());
  };
  try {
    throw;
  } catch (const OutOfMemory &error) {
    throw OutOfMemory(told(error.what()));
  } catch (const InputError &error) {
    throw InputError(told(error.what()));
  } catch (const LimitExceeded &error) {
    throw LimitExceeded(told(error.what()));
  } catch (const std::bad_alloc &) {
    throw OutOfMemory(told("out of memory"));
  } catch (const std::runtime_error &error) {
    throw std::runtime_error(told(error.what()));
  }
}

/* The counts of a step of few bodies say nothing of the pairs of many that woke or came since: one work-group would
 * have to do them all. Nothing is expected then. */
std::span<const uint32_t> World::Implementation::counts_expected() const
{
  constexpr uint32_t few_bodies = 1024;
  if (special.awake > std::max(few_bodies, 2 * awake_at_last)) return {};
  return plan.known;
}

/* If launches were interrupted by an exception that the caller handled, what broadphases kept may belong to no complete
 * launch. */
void World::Implementation::begin_launches()
{
  if (!launches_ended) forget_kept(memory);
  launches_ended = false;
}

/* Plans some rounds and one colour more than were needed, so that a growing scene does not repeat every step, and none
 * where the colours have settled. */
void World::Implementation::plan_colors() noexcept
{
  const uint32_t rounds = plan.known[COUNT_ROUNDS], colors = plan.known[COUNT_COLORS];
  plan.settled.note_step(rounds, colors);
  const bool settled = plan.settled.are_kept();
  plan.rounds = settled ? 0 : std::clamp<uint32_t>(rounds + 3, least_rounds, most_rounds);
  plan.colors = std::min(colors + (settled ? 0 : 1), COLOR_LIMIT);
  if (colors > COLOR_LIMIT) plan.colors = COLOR_LIMIT + 1;
  plan.apart = settled && plan.known[COUNT_PAIRS] == 0 && may_skip_contacts();
}

/* Sleepers have contacts of their own, which share the lists; modules may read what was skipped. */
bool World::Implementation::may_skip_contacts() const noexcept
{
  return !settings.sleeping && settings.extensions.empty() && !is_batch();
}

void World::Implementation::plan_more_colors(uint32_t status)
{
  const bool lacked_rounds = (status & STATUS_ROUNDS) != 0, lacked_colors = (status & STATUS_COLORS) != 0;
  if (lacked_colors) plan.colors = plan.known[COUNT_COLORS];
  if (!lacked_rounds && !lacked_colors) return;
  if (plan.settled.are_kept()) plan.colors = std::max(plan.colors, std::min(plan.known[COUNT_COLORS] + 1, COLOR_LIMIT));
  plan.settled.note_repetition();
  plan.apart = false;
  if (lacked_rounds) plan.rounds = std::clamp(2 * plan.rounds, least_rounds, most_rounds);
}

void World::Implementation::accept() noexcept
{
  keep_unwritten();
  turned = false;
  taken_out.clear();
  order_of_events.clear();
  moved_before.reset();
  ++statistics.steps;
  cached_pairs = plan.known[COUNT_PAIRS];
  awake_at_last = special.awake;
  plan_colors();
  if (plan.drowsy || plan.islands_apart)
    plan.island_rounds = std::max<uint32_t>(plan.known[COUNT_ISLAND_ROUNDS] + 2, 4);
  plan.drowsy = plan.known[COUNT_DROWSY] > 0;
  trees_trial.note_step(settings.broadphase == Broadphase::trees, plan.known[COUNT_INSERTED] > 0,
                        cached_pairs / std::max(1.0, double(special.awake)));
  note_start(plan.substeps, plan.known[COUNT_BRACED_LAYERS]);
  settle_substeps(plan.substeps, plan.known[COUNT_LOAD_RATE], settings);
  settle_islands();
  note_sorted();
}

/* To be called where rows come among those awake that no step has cleared: steps clear only where wishes may be. */
void World::Implementation::rows_bring_wishes() noexcept
{
  plan.forgets_wishes = true;
  plan.wishes_left = sides_of_wishes;
}

/* Impulses of islands apart are those of the fewest substeps. Other steps leave the wishes of those that want more. */
void World::Implementation::settle_islands() noexcept
{
  SubstepChoice &choice = plan.substeps;
  if (!choice.automatic) return;
  if (plan.islands_apart) {
    plan.classes = classes_needed();
    choice.of_cache = fewest_substeps(settings);
    plan.wishes_left = sides_of_wishes;
    return;
  }
  if (plan.wishes_left > 0) --plan.wishes_left;
  const SubstepChoice few = choice_of_few(choice, settings);
  if (plan.known[COUNT_LOAD_RATE] > highest_load_rate(few, settings)) plan.forgets_wishes = true;
}

/* Bodies that move nowhere are with the few; and which classes there are, steps of one do not tell. */
uint32_t World::Implementation::classes_needed() const noexcept
{
  if (!plan.islands_apart) return 0;
  const uint32_t classes = plan.known[COUNT_SUBSTEP_CLASSES];
  return classes != 0 ? classes : FEW_SUBSTEPS;
}

/* An attempt that left a class of bodies out, or did not find whole islands, says nothing of what joints bear. Whether
 * there was one depends on what the host guessed, so it must leave no trace. Passes for bodies that are not there do no
 * harm to that. */
bool World::Implementation::divides_wrongly(uint32_t status) const noexcept
{
  return plan.islands_apart && ((status & STATUS_ISLANDS) || (classes_needed() & ~plan.classes) != 0);
}

void World::Implementation::prepare_repetition(uint32_t status, bool &may_forget)
{
  const bool tells_loads = !(status & lacks_contacts) && !divides_wrongly(status);
  if (!tells_loads || (status & STATUS_DEADLOCK)) plan.forgets_wishes = true;
  if (status & STATUS_DEADLOCK) {
    if (plan.substeps.automatic) told_substeps = {};
    return backends.do_without_resident_groups();
  }
  plan_more_colors(status);
  if (status & STATUS_ISLANDS) plan.island_rounds = std::min(2 * plan.island_rounds, most_rounds);
  if ((status & STATUS_SUBSTEPS) && tells_loads) raise_substeps(plan.substeps, plan.known[COUNT_LOAD_RATE], settings);
  const bool is_late = tells_loads && plan.known[COUNT_LATE_WISHES] != 0;
  plan.classes = is_late ? FEW_SUBSTEPS | MANY_SUBSTEPS : classes_needed();
  if (plan.colors > COLOR_LIMIT && !(status & lacks_pairs)) enlarge(capacity());
  if (status & STATUS_NONFINITE) quarantine_from(plan.known[COUNT_NONFINITE], status);
  note_sorted();
  if (status & STATUS_WAKE) wake_touched();
  plan.known[COUNT_COMMIT_BODIES] = special.awake;
  plan.known[COUNT_COMMIT_BODIES_PLUS_ONE] = special.awake + 1;
  plan.known[COUNT_COMMIT_PAIRS] = plan.known[COUNT_PAIRS];
  plan.known[COUNT_COMMIT_CONSTRAINTS] = plan.known[COUNT_CONSTRAINTS];
  if (status & lacks_pairs) grow_pairs(may_forget); /* late, because it forgets the counts */
  if (!is_still_right()) choose_again();            /* the same, where many woke */
}

/* code: COUNT_NONFINITE, which holds the first body that is not finite, and the stage. An attempt that lacked contacts
 * or substeps says nothing of who is not finite after them; the repetition does, which has them. */
void World::Implementation::quarantine_from(uint32_t code, uint32_t status)
{
  if (is_batch()) return quarantine_in_worlds(status);
  const uint32_t first = code & (body_numbers - 1), stage = code / body_numbers;
  if ((status & (lacks_contacts | STATUS_SUBSTEPS)) && stage > 0) return;
  quarantine(first, stage);
  if (taken_out.size() > taken_one_by_one)
    for (const uint32_t body : bodies_not_finite(memory, special.awake))
      if (body != first) quarantine(body, stage);
  forget_kept(memory);
}

void World::Implementation::quarantine(uint32_t index, uint32_t stage)
{
  static const char *const stages[] = {"start", "solve", "integrate"};
  const uint32_t body = special.order[index];
  ring.prepare_changes(1);
  const bool is_out = slots.status()[body] == BodyStatus::quarantined; /* and was set to what is not finite again */
  if (!is_out) quarantined.push_back({body, scene.bodies[body].name, stages[stage], statistics.steps});
  if (!is_out) ++statistics.nonfinite;
  taken_out.emplace_back(index, tandem::read_body(memory, index)); /* first, so that it can be restored */
  quarantine_body(memory, index);
  if (is_out) return;
  slots.quarantine(body);
  if (scene.bodies[body].type == BodyType::dynamic) --awake_dynamics; /* others may leave the range of numbers too */
  ring.note({body, std::nullopt, std::nullopt});
  if (links.has_body(body)) quarantine_tree(body, stage);
}

/* The other links go with one, because a tree moves as a whole. */
void World::Implementation::quarantine_tree(uint32_t body, uint32_t stage)
{
  for (const uint32_t other : links.trees[links.of_body[body]])
    if (slots.status()[other] != BodyStatus::quarantined) quarantine(index_of_body[other], stage);
  tell_articulations();
}

} // namespace tandem
