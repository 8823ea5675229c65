/* stage_cut.h - finds the stages that are better run on the CPU while a device runs the others, or the reverse.
 *
 * What a cut would take is estimated: the times of the stages on either side, and what crosses between them, found by
 * following the buffers through the launches of a step as Memory would move them.
 */
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "host/runtime/launcher.h"

namespace tandem {

/* The launches of a step in their order, with the buffers that they read and write. */
class TANDEM_API LaunchRecord : public Launcher {
public:
  struct Use {
    Buffer buffer;
    bool writes;
  };
  struct Entry {
    Stage stage;
    bool host; /* runs on the CPU wherever its stage is placed */
    std::vector<Use> uses;
  };
  void launch(const Launch &launch) override;
  void begin_commit() override { commit_ = entries_.size(); }
  const std::vector<Entry> &entries() const { return entries_; }
  size_t commit() const { return commit_; } /* the first entry after it */

private:
  std::vector<Entry> entries_;
  size_t commit_ = SIZE_MAX;
};

struct Crossings {
  uint64_t bytes = 0, buffers = 0;
};

/* What moves in each step if these stages run on the device. bytes_of: of a buffer, those in use. */
TANDEM_API Crossings crossings_of(const LaunchRecord &record, const std::vector<bool> &stages_on_device,
                                  const std::function<uint64_t(Buffer)> &bytes_of);

struct StageCut {
  std::vector<bool> on_device; /* by stage */
  double milliseconds = 0;     /* expected of a step */
};

/* The fastest of all cuts in which consecutive stages run on one side and the others on the other one, by the times of
 * each stage on either side and the time that crossings take. None with fewer than two stages. */
TANDEM_API std::optional<StageCut>
find_cut(const std::vector<double> &on_cpu, const std::vector<double> &on_device,
         const std::function<double(const std::vector<bool> &stages_on_device)> &crossing_milliseconds);

} // namespace tandem
