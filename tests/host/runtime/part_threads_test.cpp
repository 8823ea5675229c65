/* Threads that take parts of their own again and again, phase after phase. */
#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include "host/runtime/part_threads.h"
#include "tests/catch.h"

using namespace tandem;

namespace {

/* Notes how often each part of each phase ran, and whether one of an earlier phase was still to come then. */
class CountedPhases : public PhasesOfParts {
public:
  explicit CountedPhases(std::vector<size_t> parts) : parts_(std::move(parts))
  {
    for (const size_t count : parts_) runs_.emplace_back(count);
  }
  size_t phases() const override { return parts_.size(); }
  size_t parts_of(size_t phase) override
  {
    if (phase == refuses) throw std::runtime_error("phase " + std::to_string(phase));
    for (size_t before = 0; before < phase; ++before)
      for (const std::atomic<int> &count : runs_[before])
        if (count != 1) early = true;
    return parts_[phase];
  }
  void run(size_t phase, size_t part) override
  {
    ++runs_[phase][part];
    if (phase == fails && part % 3 == 1) throw std::runtime_error("part " + std::to_string(part));
  }
  bool have_all_run(size_t phase) const
  {
    for (const std::atomic<int> &count : runs_[phase])
      if (count != 1) return false;
    return true;
  }

  size_t fails = size_t(-1), refuses = size_t(-1);
  std::atomic<bool> early = false;

private:
  std::vector<size_t> parts_;
  std::vector<std::vector<std::atomic<int>>> runs_;
};

} // namespace

TEST_CASE("threads of parts: every part of every phase runs once, after the phases before", "[sanitizer]")
{
  for (const uint32_t count : {1u, 2u, 3u, 8u}) {
    PartThreads threads(count);
    for (int turn = 0; turn < 20; ++turn) {
      CountedPhases phases({5, 0, 64, 1, 2, size_t(turn)});
      threads.run(phases);
      for (size_t phase = 0; phase < phases.phases(); ++phase) CHECK(phases.have_all_run(phase));
      CHECK(!phases.early);
    }
  }
}

TEST_CASE("threads of parts: the lowest part that fails is told, all others of its phase run, and no phase after it")
{
  for (const uint32_t count : {1u, 4u}) {
    PartThreads threads(count);
    CountedPhases phases({4, 9, 4});
    phases.fails = 1;
    CHECK_THROWS_WITH(threads.run(phases), "part 1");
    CHECK(phases.have_all_run(1));
    CHECK(!phases.have_all_run(2));
    CountedPhases refused({4, 9});
    refused.refuses = 1;
    CHECK_THROWS_WITH(threads.run(refused), "phase 1");
    CHECK(refused.have_all_run(0));
    CHECK(!refused.have_all_run(1));
    CHECK_NOTHROW(threads.run(3, PartFunction([](size_t) {})));
  }
}
