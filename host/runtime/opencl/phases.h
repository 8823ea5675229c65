/* phases.h - decides when series of launches of few items run as one launch (cl/phases.cl).
 *
 * The program has a case for each kind of phase that has occurred, and is built on a thread of its own once a world has
 * made enough launches that would gain from it. Until then, and where a kind is missing, launches are made one by one.
 * The bits are the same either way.
 */
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <set>
#include <span>

#include "host/runtime/opencl/phase_program.h"

namespace tandem::opencl {

/* What TANDEM_PHASES in the environment says, for tests: "separate" never joins launches; "together" joins launches of
 * any number of items in one work-group, on every device, and waits for the program; "resident" does so with a group
 * for each compute unit, and all but the smallest phases take all of them. Without it, GPUs join those of few items.
 * Other words throw InputError. */
enum class PhaseMode { automatic, separate, together, resident };
PhaseMode phase_mode_of_tests();

/* The phases of one device and one set of features. */
class Phases {
public:
  Phases(const DeviceContext &context, Features features, PhaseMode mode, size_t group_size);

  /* Runs a series in its order: parts of it joined, each of which adds one to `launches`, and the rest by `run_alone`.
   * Throws DeviceError. */
  using RunAlone = std::function<void(const BoundLaunch &)>;
  void run(std::span<const BoundLaunch> series, void *counts, const RunAlone &run_alone, uint64_t &launches);

  /* The most items of launches that a program may join. */
  uint32_t most_items() const;

  /* How many work-groups take part in a launch that joins others, at most. */
  uint32_t resident_groups() const { return program_ ? program_->resident_groups() : 1; }

  void do_without_resident_groups();

  /* Builds for all kinds that have occurred, now. Throws DeviceError or BuildError, and then keeps what it had. */
  void build();

private:
  /* What a program is built for. */
  struct Wanted {
    std::set<PhaseKind> kinds;
    bool many_items = false; /* more than one work-group takes in time */
    bool operator==(const Wanted &) const = default;
  };

  size_t joinable(std::span<const BoundLaunch> series) const;
  void note(std::span<const BoundLaunch> series);
  void build_if_worthwhile();
  void take_built();
  void begin_to_count();
  bool joins_all() const { return mode_ == PhaseMode::together || mode_ == PhaseMode::resident; }
  bool may_have_resident_groups() const;
  bool joins(const BoundLaunch &bound) const;
  void note_sizes(std::span<const BoundLaunch> series);
  bool lacks(const BoundLaunch &bound) const;
  std::unique_ptr<PhaseProgram> built(const Wanted &wanted, bool only_from_cache) const;
  std::unique_ptr<PhaseProgram> built(const PhaseText &text, bool only_from_cache) const;

  const DeviceContext &context_;
  Features features_;
  PhaseMode mode_;
  size_t group_size_;
  /* What occurred, what of it a program is being built for, and what one was built for. */
  Wanted known_, building_, tried_;
  double share_of_many_items_ = 0; /* of the launches of late */
  size_t missed_ = 0;              /* launches since the last build, of series with kinds that were not tried */
  bool looked_ = false;            /* in the cache of programs, since then */
  bool deadlocked_ = false;
  bool failed_ = false;            /* the last build in the background */
  std::unique_ptr<PhaseProgram> program_;
  std::future<std::unique_ptr<PhaseProgram>> ahead_; /* the last member, because its thread uses the others */
};

} // namespace tandem::opencl
