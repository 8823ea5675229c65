/* rounding.cpp - runs launches on the reference backend and collects the differences; see rounding.h. */
#include "host/verify/rounding.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <set>
#include <tuple>
#include <utility>

#include <tandem/compare.h>
#include <tandem/round_to_float.h>

#include "host/runtime/launcher.h"
#include "host/runtime/make_backend.h"
#include "host/runtime/memory.h"
#include "host/verify/buffer_location.h"
#include "host/world/carried.h"
#include "shared/counts.h"
#include "shared/platform.h"

namespace tandem {
namespace {

/* The name of a field without its plane: "separation[2]" becomes "separation". */
std::string field_of(const BufferLocation &location) { return location.field.substr(0, location.field.find('[')); }

/* UNBOUNDED of records.h stands for infinity and is not measured. */
constexpr double unbounded = 1e29;

/* The unit in the last place of a float of this size. */
double unit_of(double size) { return std::ldexp(1.0, size == 0 ? -149 : std::max(std::ilogb(size) - 23, -149)); }

/* A coordinate is the sum of two numbers (shared/records.h), so the rounding of the sum is measured. */
void join_places(std::vector<double> &numbers)
{
  for (size_t k = 0; k + 8 <= numbers.size(); k += 8)
    for (size_t axis = 0; axis < 3; ++axis) numbers[k + axis] += std::exchange(numbers[k + 4 + axis], 0.0);
}

std::vector<double> numbers_of(Buffer buffer, const std::vector<char> &bytes)
{
  std::vector<float> floats(bytes.size() / sizeof(float));
  std::memcpy(floats.data(), bytes.data(), floats.size() * sizeof(float));
  std::vector<double> numbers(floats.begin(), floats.end());
  if (buffer == Buffer::body_position) join_places(numbers);
  return numbers;
}

class Samples {
public:
  void add(double value, double exact)
  {
    if (!std::isfinite(value) || !std::isfinite(exact)) {
      ++row_.nonfinite;
      return;
    }
    if (std::abs(exact) > unbounded) return;
    const double distance = std::abs(value - exact);
    ulps_.push_back(round_to_float(ulps_from(value, exact)));
    launch_distance_ = std::max(launch_distance_, distance);
    launch_largest_ = std::max(launch_largest_, std::abs(exact));
    row_.max_absolute = std::max(row_.max_absolute, distance);
    if (exact != 0) row_.max_relative = std::max(row_.max_relative, distance / std::abs(exact));
  }

  void end_launch()
  {
    row_.max_field_ulps = std::max(row_.max_field_ulps, launch_distance_ / unit_of(launch_largest_));
    launch_distance_ = launch_largest_ = 0;
  }

  RoundingRow row()
  {
    row_.numbers = ulps_.size();
    if (ulps_.empty()) return row_;
    std::sort(ulps_.begin(), ulps_.end());
    row_.median_ulps = ulps_[ulps_.size() / 2];
    row_.high_ulps =
        ulps_[std::min(ulps_.size() - 1, static_cast<size_t>(std::ceil(0.999 * static_cast<double>(ulps_.size()))))];
    row_.max_ulps = ulps_.back();
    return row_;
  }

private:
  RoundingRow row_{};
  double launch_distance_ = 0, launch_largest_ = 0;
  std::vector<float> ulps_;
};

/* The reference's copy of the buffers, as the float world's were before the next launch. */
class Mirror {
public:
  Mirror() : backend_(make_backend("reference:threads=1")) { backend_->prepare(0, {}); }

  void copy_all(World &world)
  {
    for (size_t i = 0; i < buffer_count; ++i) copy(world, buffer_at(i));
  }
  void copy(World &world, Buffer buffer)
  {
    const size_t bytes = world.memory().bytes(buffer);
    memory_.resize(buffer, bytes);
    const std::vector<char> contents = world.memory().read<char>(buffer, bytes);
    memory_.upload(buffer, contents.data(), bytes);
  }
  bool fits(World &world) const
  {
    for (size_t i = 0; i < buffer_count; ++i)
      if (memory_.bytes(buffer_at(i)) != world.memory().bytes(buffer_at(i))) return false;
    return true;
  }
  void run(const Launch &launch) { DirectLauncher(memory_, *backend_).launch(launch); }
  Memory &memory() { return memory_; }

private:
  std::unique_ptr<Backend> backend_; /* outlives the memory */
  Memory memory_;
};

class Measurer {
public:
  Measurer(World &world) : world_(world) {}

  void compare(const Launch &launch)
  {
    world_.backend_of(launch.kernel).finish();
    /* Between steps the host may have written to buffers, and buffers may have grown, so each step starts from a full
     * copy. */
    if (launch.kernel == Kernel::begin_step || !mirror_.fits(world_)) return mirror_.copy_all(world_);
    const std::vector<Buffer> written = buffers_written(launch);
    if (launch.kernel == Kernel::commit_bodies)
      turn_carried(mirror_.memory(), carried_buffers()); /* as the step does just before */
    std::vector<std::vector<char>> before;
    for (const Buffer buffer : written)
      before.push_back(mirror_.memory().read<char>(buffer, mirror_.memory().bytes(buffer)));
    mirror_.run(launch);
    for (size_t k = 0; k < written.size(); ++k) {
      compare_buffer(launch.kernel, written[k], before[k]);
      mirror_.copy(world_, written[k]);
    }
    ++table_.launches;
  }

  RoundingTable table()
  {
    for (auto &[key, samples] : samples_) {
      RoundingRow row = samples.row();
      std::tie(row.kernel, row.buffer, row.field) = key;
      if (row.numbers + row.nonfinite > 0) table_.rows.push_back(row);
    }
    for (const auto &[key, decision] : decisions_) table_.decisions.push_back(decision);
    return table_;
  }

private:
  void compare_buffer(Kernel kernel, Buffer buffer, const std::vector<char> &before)
  {
    if (holds_reals(buffer)) return compare_reals(kernel, buffer, before);
    if (row_of(buffer).element == Element::Parameters) return;
    const size_t width = scalar_bytes(buffer), bytes = before.size();
    const std::vector<char> value = world_.memory().read<char>(buffer, bytes),
                            exact = mirror_.memory().read<char>(buffer, bytes);
    DecisionRow &row = decisions_.try_emplace({kernel, buffer}, DecisionRow{kernel, buffer}).first->second;
    for (size_t at = 0; at + width <= bytes; at += width) {
      const bool differs = std::memcmp(&value[at], &exact[at], width) != 0;
      row.numbers += differs || std::memcmp(&value[at], &before[at], width) != 0;
      row.differing += differs;
    }
  }

  void compare_reals(Kernel kernel, Buffer buffer, const std::vector<char> &before)
  {
    const size_t count = before.size() / sizeof(float), capacity = pair_capacity();
    const std::vector<double> value = numbers_of(buffer, world_.memory().read<char>(buffer, before.size())),
                              old = numbers_of(buffer, before);
    std::vector<double> exact = mirror_.memory().read_reals(buffer, count);
    if (buffer == Buffer::body_position) join_places(exact);
    std::set<Samples *> touched;
    for (size_t k = 0; k < count; ++k) {
      if (value[k] == old[k] && exact[k] == old[k]) continue;
      Samples &samples = samples_[{kernel, buffer, field_of(location_in(buffer, k, capacity))}];
      samples.add(value[k], exact[k]);
      touched.insert(&samples);
    }
    for (Samples *samples : touched) samples->end_launch();
  }

  size_t pair_capacity() { return world_.memory().read<uint32_t>(Buffer::counts, 1, CAPACITY_PAIRS).front(); }

  World &world_;
  Mirror mirror_;
  std::map<std::tuple<Kernel, Buffer, std::string>, Samples> samples_;
  std::map<std::pair<Kernel, Buffer>, DecisionRow> decisions_;
  RoundingTable table_;
};

} // namespace

double ulps_from(double value, double exact)
{
  return std::abs(value - exact) / unit_of(std::max(std::abs(exact), std::abs(value)));
}

RoundingTable measure_rounding(const Scene &scene, const RoundingRequest &request)
{
  World world(scene, request.settings, request.placement);
  Measurer measurer(world);
  for (uint64_t step = 0; step < request.steps; ++step) {
    if (step % request.every == 0) world.set_observer([&](const Launch &launch) { measurer.compare(launch); });
    world.step();
    world.set_observer(nullptr);
  }
  return measurer.table();
}

} // namespace tandem
