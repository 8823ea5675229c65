/* recorder.h - a launcher that runs nothing and records which kernels a series of launches needs and which buffers each
 * touches. Worlds use it to allocate only those. */
#pragma once

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "host/runtime/launcher.h"

namespace tandem {

class Recorder : public Launcher {
public:
  void launch(const Launch &launch) override
  {
    for (Buffer slot : launch.slots) touch(launch.kernel, slot);
    note(launch.kernel);
  }
  /* Records the kernel as if it were launched, except for its slots. */
  void note(Kernel kernel)
  {
    if (std::find(kernels.begin(), kernels.end(), kernel) != kernels.end()) return;
    kernels.push_back(kernel);
    for (const Argument &argument : row_of(kernel).arguments)
      if (argument.kind == Argument::Kind::buffer) touch(kernel, argument.buffer);
  }

  std::vector<Kernel> kernels; /* each once, in the order of their first launches */
  std::vector<bool> touched = std::vector<bool>(all_buffers());
  std::set<std::pair<Kernel, Buffer>> uses;

private:
  void touch(Kernel kernel, Buffer buffer)
  {
    touched[index_of(buffer)] = true;
    uses.emplace(kernel, buffer);
  }
};

} // namespace tandem
