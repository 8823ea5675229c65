/* stage_cut.cpp - see stage_cut.h. */
#include "host/world/stage_cut.h"

#include <utility>

#include "host/world/carried.h"

namespace tandem {
namespace {

constexpr uint8_t on_the_cpu = 1, on_the_device = 2, on_both = 3;

/* Where each buffer is valid while the launches of a step pass. */
class Validity {
public:
  explicit Validity(const std::function<uint64_t(Buffer)> &bytes_of) : bytes_of_(bytes_of) {}
  void forget_scratch()
  {
    for (size_t i = 0; i < valid_.size(); ++i)
      if (row_of(buffer_at(i)).lifetime == Lifetime::SCRATCH) valid_[i] = on_both;
  }
  void turn_carried()
  {
    for (const CarriedBuffer &buffer : carried_)
      std::swap(valid_[index_of(buffer.now)], valid_[index_of(buffer.previous)]);
  }
  void use(const LaunchRecord::Use &use, uint8_t side, Crossings &crossings)
  {
    uint8_t &valid = valid_[index_of(use.buffer)];
    const uint64_t bytes = valid & side ? 0 : bytes_of_(use.buffer);
    crossings.bytes += bytes;
    crossings.buffers += bytes > 0;
    valid = use.writes ? side : valid | side;
  }

private:
  const std::function<uint64_t(Buffer)> &bytes_of_;
  std::vector<CarriedBuffer> carried_ = carried_buffers();
  std::vector<uint8_t> valid_ = std::vector<uint8_t>(all_buffers(), on_both);
};

Crossings pass(const LaunchRecord &record, const std::vector<bool> &stages_on_device, Validity &validity)
{
  Crossings crossings;
  validity.forget_scratch();
  for (size_t i = 0; i < record.entries().size(); ++i) {
    if (i == record.commit()) validity.turn_carried();
    const LaunchRecord::Entry &entry = record.entries()[i];
    const bool on_device = !entry.host && stages_on_device[static_cast<size_t>(entry.stage)];
    for (const LaunchRecord::Use &use : entry.uses)
      validity.use(use, on_device ? on_the_device : on_the_cpu, crossings);
  }
  return crossings;
}

} // namespace

void LaunchRecord::launch(const Launch &launch)
{
  const KernelRow &row = row_of(launch.kernel);
  Entry entry{row.stage, row.execution == Execution::host, {{Buffer::counts, false}}};
  for_each_buffer(launch, [&](Buffer buffer, Access access) { entry.uses.push_back({buffer, access != Access::in}); });
  entries_.push_back(std::move(entry));
}

/* The first pass finds where a step leaves the buffers, from which the next one starts. */
Crossings crossings_of(const LaunchRecord &record, const std::vector<bool> &stages_on_device,
                       const std::function<uint64_t(Buffer)> &bytes_of)
{
  Validity validity(bytes_of);
  pass(record, stages_on_device, validity);
  return pass(record, stages_on_device, validity);
}

std::optional<StageCut>
find_cut(const std::vector<double> &on_cpu, const std::vector<double> &on_device,
         const std::function<double(const std::vector<bool> &stages_on_device)> &crossing_milliseconds)
{
  std::vector<size_t> stages;
  for (size_t s = 0; s < on_cpu.size(); ++s)
    if (on_cpu[s] > 0 || on_device[s] > 0) stages.push_back(s);
  std::optional<StageCut> best;
  const auto consider = [&](size_t first, size_t last, bool inside) {
    StageCut cut{std::vector<bool>(on_cpu.size(), !inside), 0};
    for (size_t k = first; k < last; ++k) cut.on_device[stages[k]] = inside;
    for (const size_t s : stages) cut.milliseconds += cut.on_device[s] ? on_device[s] : on_cpu[s];
    cut.milliseconds += crossing_milliseconds(cut.on_device);
    if (!best || cut.milliseconds < best->milliseconds) best = std::move(cut);
  };
  for (size_t first = 0; first < stages.size(); ++first)
    for (size_t last = first + 1; last <= stages.size(); ++last)
      for (const bool inside : {false, true})
        if (last - first < stages.size()) consider(first, last, inside);
  return best;
}

} // namespace tandem
