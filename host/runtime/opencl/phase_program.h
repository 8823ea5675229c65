/* phase_program.h - a built program of phases, and its launches. */
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "host/runtime/opencl/phase_source.h"
#include "host/runtime/opencl/resident_groups.h"

namespace tandem::opencl {

/* Keeps the kernels that were launched last, each with a script and arguments of its own, so that a step like the one
 * before sets little. Its functions throw DeviceError. */
class PhaseProgram {
public:
  /* group_size: 0 for as many items as suit the device. Phases of more than `items_of_first_group` items, or of more
   * than one group of a GROUP kernel, take all groups of a launch. */
  PhaseProgram(const DeviceContext &context, const PhaseText &text, size_t group_size, uint32_t items_of_first_group);
  ~PhaseProgram();
  PhaseProgram(const PhaseProgram &) = delete;
  PhaseProgram &operator=(const PhaseProgram &) = delete;

  bool has(const Launch &launch) const { return case_of(launch).has_value(); }
  uint32_t resident_groups() const { return resident_ ? resident_->count() : 1; }
  bool has_resident_groups() const { return resident_groups() > 1; }
  /* Makes one launch of at most MOST_PHASES launches, all of which it has. */
  void run(std::span<const BoundLaunch> series, void *counts);

private:
  struct Script {
    cl::Kernel kernel;
    cl::Buffer buffer;
    std::vector<uint32_t> words;
    std::vector<uint64_t> arguments; /* the serials of the buffers set last */
    cl::Event written;
    uint64_t used = 0;
  };

  [[noreturn]] void fail(const char *what, cl_int code) const;
  std::optional<uint32_t> case_of(const Launch &launch) const;
  void bind(std::span<const BoundLaunch> series, void *counts);
  void bind(const BoundLaunch &bound);
  void write_words(std::span<const BoundLaunch> series);
  Script &script_with(const std::vector<uint32_t> &words);
  Script &unused_script();
  Script new_script() const;
  static void wait_for_words(const Script &script);
  void upload(Script &script, const std::vector<uint32_t> &words);
  bool takes_all_groups(const BoundLaunch &bound) const;
  uint32_t groups_for(std::span<const BoundLaunch> series) const;
  bool meet_after(std::span<const BoundLaunch> series, size_t phase) const;
  uint32_t meetings_of(size_t phases) const;
  void set_arguments(Script &script, uint32_t phases, void *counts);
  void set_meetings(Script &script);
  void set_handle(Script &script, cl_uint index, void *handle);
  void set(Script &script, cl_uint index, size_t bytes, const void *value);

  const DeviceContext &context_;
  std::vector<PhaseKind> kinds_;
  std::vector<Buffer> buffers_;
  std::vector<size_t> place_of_;             /* of each buffer among the arguments */
  std::vector<std::vector<uint32_t>> cases_; /* of each kernel */
  cl::Program program_;
  size_t group_size_ = 0;
  uint32_t items_of_first_group_;
  std::optional<ResidentGroups> resident_; /* in programs for them */
  std::vector<Script> scripts_;
  uint64_t uses_ = 0;
  std::vector<uint32_t> words_; /* of the series that is being launched, as are the handles */
  std::vector<void *> handles_;
};

} // namespace tandem::opencl
