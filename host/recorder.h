/* recorder.h - a launcher that runs nothing: which kernels a series of launches needs, and which buffers they touch. */
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "host/launcher.h"

namespace tandem {

class Recorder : public Launcher {
public:
  void launch(const Launch &launch) override
  {
    for (Buffer slot : launch.slots) touched[index_of(slot)] = true;
    if (std::find(kernels.begin(), kernels.end(), launch.kernel) != kernels.end()) return;
    kernels.push_back(launch.kernel);
    for (const Argument &argument : row_of(launch.kernel).arguments)
      if (argument.kind == Argument::Kind::buffer) touched[index_of(argument.buffer)] = true;
  }

  std::vector<Kernel> kernels; /* each once, in the order of their first launches */
  std::array<bool, buffer_count> touched{};
};

} // namespace tandem
