/* recorder.h - a launcher that runs nothing and records which kernels a series of launches needs and which buffers each
 * touches, and from when to when. Worlds use it to allocate only those, and to let some share memory. */
#pragma once

#include <algorithm>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "host/runtime/launcher.h"

namespace tandem {

/* The launches of a step that touch a buffer lie from the first to the last of these numbers. Those of branches have
 * one number, because they may run side by side. */
struct Span {
  static constexpr uint32_t never = UINT32_MAX;
  uint32_t first = never, last = 0;

  bool is_empty() const { return first == never; }
  bool overlaps(const Span &other) const { return first <= other.last && other.first <= last; }
};

class Recorder : public Launcher {
public:
  void launch(const Launch &launch) override
  {
    if (in_step_ && !(launch.branch > 0 && in_branches_)) ++launches_;
    in_branches_ = launch.branch > 0;
    for_each_buffer(launch, [&](Buffer buffer, Access) {
      Span &span = spans[index_of(buffer)];
      span = {std::min(span.first, launches_), launches_};
    });
    for (Buffer slot : launch.slots) touch(launch.kernel, slot);
    note(launch.kernel);
  }
  void begin_commit() override { first_of_commit = launches_ + 1; }
  /* What is recorded from here on is launched between steps. */
  void end_step() { in_step_ = false; }
  /* Records the kernel as if it were launched, except for its slots. */
  void note(Kernel kernel)
  {
    const bool known = std::find(kernels.begin(), kernels.end(), kernel) != kernels.end();
    if (known && in_step_) return;
    if (!known) kernels.push_back(kernel);
    for (const Argument &argument : row_of(kernel).arguments)
      if (argument.kind == Argument::Kind::buffer) touch(kernel, argument.buffer);
  }

  std::vector<Kernel> kernels; /* each once, in the order of their first launches */
  std::vector<bool> touched = std::vector<bool>(all_buffers());
  std::set<std::pair<Kernel, Buffer>> uses;
  std::vector<Span> spans = std::vector<Span>(all_buffers());
  std::vector<bool> between_steps = std::vector<bool>(all_buffers()); /* touched there, too */
  uint32_t first_of_commit = Span::never;

private:
  void touch(Kernel kernel, Buffer buffer)
  {
    touched[index_of(buffer)] = true;
    if (!in_step_) between_steps[index_of(buffer)] = true;
    uses.emplace(kernel, buffer);
  }

  uint32_t launches_ = 0;
  bool in_step_ = true, in_branches_ = false;
};

} // namespace tandem
