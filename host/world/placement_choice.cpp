/* placement_choice.cpp - see placement_choice.h. */
#include "host/world/placement_choice.h"

#include <algorithm>

namespace tandem {

Candidate PlacementChoice::next() const
{
  if (state_ == State::measuring) return trial_;
  return state_ == State::building ? Candidate::cpu : chosen_;
}

bool PlacementChoice::profiles_next() const
{
  return state_ == State::measuring && steps_of_trial_ == warming_steps + timed_steps;
}

/* The candidate that runs already is measured first. */
void PlacementChoice::begin_measuring()
{
  times_ = {};
  spent_ = 0;
  spent_steps_ = steps_of_trial_ = 0;
  trial_ = chosen_ == Candidate::cut ? Candidate::device : chosen_;
  state_ = State::measuring;
}

void PlacementChoice::device_is_built()
{
  if (state_ == State::building) begin_measuring();
}

void PlacementChoice::stay_on_cpu()
{
  has_device_ = false;
  times_ = {};
  chosen_ = Candidate::cpu;
  state_ = State::settled;
}

void PlacementChoice::measure_again()
{
  if (state_ == State::settled && has_device_) begin_measuring();
}

void PlacementChoice::note_step(double milliseconds, uint64_t size)
{
  total_ += milliseconds;
  size_ = std::max(size, least_size);
  if (state_ == State::measuring) note_trial(milliseconds);
  else if (state_ == State::settled && must_measure_again()) begin_measuring();
}

/* What the very first steps on a device build is built once, so it is no cost of measuring. */
void PlacementChoice::note_trial(double milliseconds)
{
  const bool warms = steps_of_trial_ < warming_steps, profiles = profiles_next();
  if (!warms || measured_before_) {
    spent_ += milliseconds;
    ++spent_steps_;
  }
  if (!warms && !profiles) of(trial_) = std::min(milliseconds, of(trial_).value_or(milliseconds));
  ++steps_of_trial_;
  const uint32_t steps = warming_steps + timed_steps + (trial_ == Candidate::cut ? 0 : 1);
  if (steps_of_trial_ == steps) end_trial();
}

void PlacementChoice::end_trial()
{
  steps_of_trial_ = 0;
  if (trial_ == Candidate::cut) return settle();
  const Candidate other = trial_ == Candidate::cpu ? Candidate::device : Candidate::cpu;
  if (of(other)) state_ = State::awaiting;
  else trial_ = other;
}

void PlacementChoice::offer_cut(std::optional<double> expected_milliseconds)
{
  if (state_ != State::awaiting) return;
  state_ = State::measuring;
  trial_ = Candidate::cut;
  if (!expected_milliseconds || *expected_milliseconds * margin >= *of(fastest())) settle();
}

Candidate PlacementChoice::fastest() const
{
  Candidate best = Candidate::cpu;
  for (const Candidate candidate : {Candidate::device, Candidate::cut})
    if (of(candidate) && *of(candidate) < *of(best)) best = candidate;
  return best;
}

/* At first nothing is known, and the fastest is taken; later the one that ran before stays unless the margin is
 * reached. */
void PlacementChoice::settle()
{
  const Candidate best = fastest();
  const bool stays = measured_before_ && of(chosen_) && *of(chosen_) <= margin * *of(best);
  if (!stays) chosen_ = best;
  lost_ += std::max(0.0, spent_ - spent_steps_ * *of(chosen_));
  size_when_chosen_ = size_;
  measured_before_ = true;
  state_ = State::settled;
}

bool PlacementChoice::must_measure_again() const
{
  const bool changed = size_ >= 2 * size_when_chosen_ || 2 * size_ <= size_when_chosen_;
  return has_device_ && changed && lost_ <= share_for_measuring * total_;
}

} // namespace tandem
