/* compare.h - runs one scene on several backends in lockstep and compares every kernel's outputs bit for bit. It
 * belongs to the library Tandem::verify.
 *
 * Exactness is a claim about every kernel, so it is checked after every launch and not only at the end: the first
 * buffer that differs names the kernel at fault. The first backend is the reference. Each step it runs once and
 * records one hash for each buffer that each launch wrote; the other backends compare their hashes launch by launch.
 * Only if a hash differs does the reference run again up to that launch, so that the two buffers can be compared
 * number by number. Two numbers that are both NaN count as the same (host/verify/buffer_location.h), because every
 * backend takes a body that stops being finite out at the end of the step.
 *
 * Several threads may compare at once.
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tandem/export.h>
#include <tandem/world.h>

namespace tandem {

/* Changes memory after a launch on one of the worlds, so that tests can prove that a difference is found. */
using FaultInjector = std::function<void(size_t world, uint64_t step, World &, const Launch &)>;

/* Changes one number by the least possible amount after the first launch of `kernel` in `step` on `world`. `scalar`
 * counts in scalars of the buffer. */
struct InjectedFault {
  size_t world = 1; /* index into ComparisonRequest::backends */
  Kernel kernel{};
  uint64_t step = 0;
  Buffer buffer{};
  size_t scalar = 0;
};
/* While nothing has been changed, `missing` holds the reason; it becomes empty once the fault is injected. It must
 * outlive the returned injector. */
TANDEM_API FaultInjector inject_fault(const InjectedFault &error, std::string *missing = nullptr);

struct ComparisonRequest {
  Settings settings{};
  Placement placement{};               /* `on` is replaced by each of the backends */
  std::vector<std::string> backends{}; /* two or more; the first is the reference */
  uint64_t steps = 1;
  /* Optional: World::save(). The worlds begin as it says, with its settings in place of those above; `scene` is then
   * that of the snapshot. It must outlive the comparison. */
  std::span<const std::byte> snapshot{};
  FaultInjector inject_fault{}; /* optional */
  /* Optional: what a program does with each of the worlds before a step. It must do the same to equal worlds, because
   * worlds are stepped in turn, and again from the start where they differ. */
  std::function<void(World &world, uint64_t step)> before_step{};
  std::function<void(uint64_t done)> after_step{}; /* optional: progress */
};

/* What one number inside a buffer means. */
struct BufferLocation {
  size_t element;    /* index of the row, real, uint or ulong in the buffer */
  size_t item;       /* body, pair, constraint, cell, ... */
  uint32_t part;     /* which record row or plane of the item */
  std::string field; /* "separation", "linear.x"; with the part where the name alone is ambiguous */
};

/* One number in decimal and as its bits: "0.125" / "0x3e000000", "17" / "0x00000011". */
struct BufferValue {
  std::string decimal, bits;
};

/* The first difference. If `buffer` is empty, the note alone says what differed. */
struct Difference {
  uint64_t step = 0;   /* 0 in the first */
  uint32_t launch = 0; /* which launch of the step, 0 the first */
  std::string backends[2];
  std::optional<Kernel> kernel;
  std::optional<Buffer> buffer;
  size_t scalar = 0; /* index of the number in the buffer, in scalars */
  BufferLocation location{};
  BufferValue values[2];
  std::optional<uint64_t> ulps;
  uint64_t differing = 0;       /* numbers of this buffer that differ */
  std::vector<uint32_t> bodies; /* of the scene: the item's body, or the two of its pair */
  std::string breakpoint;       /* for gdb on the serial backend: function and condition */
  std::string note;             /* further remarks; empty if none */
};

struct Comparison {
  bool equal = true;
  Broadphase broadphase{};    /* of the last step, on every backend; `automatic` is decided as for the first */
  std::string broadphase_why; /* what decided it, in one line */
  uint64_t steps = 0;         /* run on every backend; the last may have differed */
  uint64_t kernels_compared = 0;
  uint64_t bytes_compared = 0;
  std::optional<Difference> first_difference;
  std::vector<Quarantine> quarantined;   /* on the first backend */
  std::optional<BatchFault> batch_fault; /* the first on any backend; only with Settings::check */
};

/* Throws InputError if there are fewer than two backends, and whatever World's constructor throws. */
TANDEM_API Comparison compare_backends(const Scene &scene, const ComparisonRequest &request);

/* The buffers that a launch writes, slots included, in the order of its kernel's arguments. */
TANDEM_API std::vector<Buffer> buffers_written(const Launch &launch);

} // namespace tandem
