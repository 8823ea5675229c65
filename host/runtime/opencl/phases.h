/* phases.h - decides when series of launches of few items run as one launch of one work-group (cl/phases.cl).
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
 * any number of items, on every device, and waits for the program. Without it, GPUs join those of few items. Other
 * words throw InputError. */
enum class PhaseMode { automatic, separate, together };
PhaseMode phase_mode_of_tests();

/* The phases of one device and one set of features. */
class Phases {
public:
  Phases(const DeviceContext &context, Features features, PhaseMode mode, size_t group_size);

  /* Runs a series in its order: parts of it joined, each of which adds one to `launches`, and the rest by `run_alone`.
   * Throws DeviceError. */
  using RunAlone = std::function<void(const BoundLaunch &)>;
  void run(std::span<const BoundLaunch> series, void *counts, const RunAlone &run_alone, uint64_t &launches);

  /* Builds for all kinds that have occurred, now. Throws DeviceError or BuildError, and then keeps what it had. */
  void build();

private:
  size_t joinable(std::span<const BoundLaunch> series) const;
  void note(std::span<const BoundLaunch> series);
  void build_if_worthwhile();
  void take_built();
  void begin_to_count();
  std::unique_ptr<PhaseProgram> built(const std::set<PhaseKind> &kinds, bool only_from_cache) const;

  const DeviceContext &context_;
  Features features_;
  PhaseMode mode_;
  size_t group_size_;
  /* Kinds that occurred, those of them that a program is being built for, and those that one was built for. */
  std::set<PhaseKind> known_, building_, tried_;
  size_t missed_ = 0;   /* launches since the last build, of series with kinds that were not tried */
  bool looked_ = false; /* in the cache of programs, since then */
  bool failed_ = false; /* the last build in the background */
  std::unique_ptr<PhaseProgram> program_;
  std::future<std::unique_ptr<PhaseProgram>> ahead_; /* the last member, because its thread uses the others */
};

} // namespace tandem::opencl
