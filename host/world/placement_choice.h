/* placement_choice.h - decides by times on which candidate the next step runs: on the CPU, on a device, or cut by
 * stages between both. It has no clock and places nothing, so that tests give it times.
 *
 * All candidates give the same bits. The CPU runs until the device's kernels are built. Then each candidate runs some
 * steps, and the fastest goes on; it is measured again when the scene has become twice or half as large.
 */
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <tandem/export.h>

namespace tandem {

enum class Candidate : uint8_t { cpu, device, cut };
constexpr size_t candidates = 3;

class TANDEM_API PlacementChoice {
public:
  /* Of each candidate, a step whose time does not count, because buffers move and drivers build in it; steps whose
   * shortest time counts; and, but of a cut, one that is measured stage by stage. */
  static constexpr uint32_t warming_steps = 1, timed_steps = 3;
  /* Another candidate takes over only where it is faster by so much, so that noise changes nothing. */
  static constexpr double margin = 1.1;
  /* The most of all time that steps on slower candidates may have cost before these are measured again. */
  static constexpr double share_for_measuring = 0.05;
  static constexpr uint64_t least_size = 64; /* scenes that are smaller count as equal */

  Candidate next() const;
  bool is_building() const { return state_ == State::building; }
  bool is_settled() const { return state_ == State::settled; }
  bool profiles_next() const;
  /* CPU and device have been measured: offer_cut() has to come before the next step. */
  bool awaits_cut() const { return state_ == State::awaiting; }
  void offer_cut(std::optional<double> expected_milliseconds);
  void device_is_built();
  void stay_on_cpu(); /* for good: there is no device, or it fails */
  /* The last step, on next(), took so long; size: bodies awake and pairs. */
  void note_step(double milliseconds, uint64_t size);
  /* As if the scene had another size now; what a device needs for a launch may have changed. */
  void measure_again();

  Candidate chosen() const { return chosen_; }
  std::optional<double> milliseconds_of(Candidate candidate) const { return of(candidate); }
  uint64_t size_when_chosen() const { return size_when_chosen_; }

private:
  enum class State : uint8_t { building, measuring, awaiting, settled };
  std::optional<double> of(Candidate candidate) const { return times_[static_cast<size_t>(candidate)]; }
  std::optional<double> &of(Candidate candidate) { return times_[static_cast<size_t>(candidate)]; }
  void begin_measuring();
  void note_trial(double milliseconds);
  void end_trial();
  void settle();
  Candidate fastest() const;
  bool must_measure_again() const;

  State state_ = State::building;
  Candidate chosen_ = Candidate::cpu, trial_ = Candidate::cpu;
  uint32_t steps_of_trial_ = 0;
  bool measured_before_ = false, has_device_ = true;
  std::array<std::optional<double>, candidates> times_; /* of the last measurement */
  uint64_t size_ = 0, size_when_chosen_ = 0;
  double spent_ = 0;            /* in steps of this measurement, */
  uint32_t spent_steps_ = 0;    /* of which there were so many */
  double lost_ = 0, total_ = 0; /* by measurements, and in all */
};

} // namespace tandem
