/* The choice of a placement by times, which are given here: what runs when, what is taken, and when it is measured
 * again. */
#include <algorithm>
#include <vector>

#include "host/world/placement_choice.h"
#include "host/world/stage_cut.h"
#include "tests/catch.h"

using namespace tandem;

namespace {

/* Steps of constant times; a cut is offered at its time if one is given. */
struct Machine {
  double cpu, device;
  std::optional<double> cut = std::nullopt;
  PlacementChoice choice = {};
  uint64_t size = 1000;

  double time_of(Candidate candidate) const
  {
    if (candidate == Candidate::cut) return cut.value_or(0);
    return candidate == Candidate::cpu ? cpu : device;
  }
  Candidate step(double extra = 0)
  {
    const Candidate ran = choice.next();
    choice.note_step(time_of(ran) + extra, size);
    if (choice.awaits_cut()) choice.offer_cut(cut);
    return ran;
  }
  std::vector<Candidate> measure()
  {
    std::vector<Candidate> ran;
    while (!choice.is_settled()) ran.push_back(step());
    return ran;
  }
  void steps(int n)
  {
    for (int k = 0; k < n; ++k) step();
  }
};

} // namespace

TEST_CASE("placement choice: the CPU runs until the device is built, then both are measured and the faster stays")
{
  for (const auto &[cpu, device] : {std::pair(1.0, 3.0), {3.0, 1.0}, {1.0, 1.01}, {1.01, 1.0}}) {
    CAPTURE(cpu, device);
    Machine machine{cpu, device};
    for (int step = 0; step < 10; ++step) CHECK(machine.step() == Candidate::cpu);
    CHECK(machine.choice.is_building());
    machine.choice.device_is_built();
    std::vector<Candidate> expected(10, Candidate::device);
    std::fill_n(expected.begin(), 5, Candidate::cpu);
    CHECK(machine.measure() == expected);
    CHECK(machine.choice.chosen() == (cpu < device ? Candidate::cpu : Candidate::device));
    CHECK(machine.choice.milliseconds_of(Candidate::cpu) == cpu);
    CHECK(machine.choice.milliseconds_of(Candidate::device) == device);
    CHECK_FALSE(machine.choice.milliseconds_of(Candidate::cut));
    CHECK(machine.choice.next() == machine.choice.chosen());
  }
}

TEST_CASE("placement choice: the step that warms up and the one that is profiled do not count, of others the shortest")
{
  Machine machine{2, 3};
  machine.choice.device_is_built();
  for (const double extra : {100.0, 7.0, 0.5, 1.0}) {
    CHECK_FALSE(machine.choice.profiles_next());
    machine.step(extra);
  }
  CHECK(machine.choice.profiles_next());
  machine.step(-1);
  machine.measure();
  CHECK(machine.choice.milliseconds_of(Candidate::cpu) == 2.5);
}

TEST_CASE("placement choice: a cut is tried where it is expected to gain more than the margin, and taken if it does")
{
  Machine no_gain{2, 3, 1.9};
  no_gain.choice.device_is_built();
  CHECK(no_gain.measure().size() == 10);
  CHECK(no_gain.choice.chosen() == Candidate::cpu);

  Machine gain{2, 3, 1.5};
  gain.choice.device_is_built();
  CHECK(gain.measure().size() == 14);
  CHECK(gain.choice.chosen() == Candidate::cut);

  Machine disappoints{2, 3};
  disappoints.choice.device_is_built();
  while (!disappoints.choice.awaits_cut())
    disappoints.choice.note_step(disappoints.time_of(disappoints.choice.next()), 1);
  disappoints.choice.offer_cut(0.5);
  CHECK(disappoints.choice.next() == Candidate::cut);
  disappoints.cut = 2.5;
  disappoints.measure();
  CHECK(disappoints.choice.chosen() == Candidate::cpu);
  CHECK(disappoints.choice.milliseconds_of(Candidate::cut) == 2.5);
}

TEST_CASE("placement choice: measured again when the scene is twice or half as large, with a margin against noise")
{
  Machine machine{1, 1.04};
  machine.choice.device_is_built();
  machine.measure();
  machine.steps(1000); /* pays for what the first measurement has lost */
  machine.size = 1999;
  machine.steps(10);
  CHECK(machine.choice.is_settled());
  machine.size = 2000;
  machine.step();
  CHECK_FALSE(machine.choice.is_settled());
  machine.device = 0.95; /* faster, but by less than the margin */
  machine.measure();
  CHECK(machine.choice.chosen() == Candidate::cpu);
  CHECK(machine.choice.size_when_chosen() == 2000);

  machine.size = 1000;
  machine.step();
  machine.device = 0.9;
  const std::vector<Candidate> ran = machine.measure();
  CHECK(ran.front() == Candidate::cpu); /* what runs is measured first, without a move */
  CHECK(machine.choice.chosen() == Candidate::device);

  machine.size = 4000;
  machine.step();
  machine.cpu = 0.85;
  CHECK(machine.measure().front() == Candidate::device);
  CHECK(machine.choice.chosen() == Candidate::device);
}

TEST_CASE("placement choice: small scenes count as equal, and a change of size alone decides nothing")
{
  Machine machine{1, 1.5};
  machine.size = 1;
  machine.choice.device_is_built();
  machine.measure();
  machine.steps(1000);
  machine.size = 2 * PlacementChoice::least_size - 1;
  machine.steps(10);
  CHECK(machine.choice.is_settled());
  machine.size = 2 * PlacementChoice::least_size;
  machine.step();
  CHECK_FALSE(machine.choice.is_settled());
  machine.measure();
  CHECK(machine.choice.chosen() == Candidate::cpu);
}

/* However often the scene doubles, steps on the slower candidate cost no more than their share, and one measurement. */
TEST_CASE("placement choice: measuring costs no more than its share of all time")
{
  for (const double slower : {1.5, 10.0, 1000.0}) {
    Machine machine{1, slower};
    machine.choice.device_is_built();
    double total = 0, best = 0, first = 0;
    for (int step = 0; step < 20000; ++step) {
      machine.size = step / 20 % 2 ? 1000 : 3000;
      const Candidate ran = machine.step();
      total += machine.time_of(ran);
      best += machine.cpu;
      if (step < 10) first = total - best; /* of which one step warms up */
    }
    CAPTURE(slower);
    CHECK(total - best <= PlacementChoice::share_for_measuring * total + first + 5 * slower);
    CHECK(total - best >= first);
  }
}

TEST_CASE("placement choice: without a device, or with one that fails, the CPU runs for good")
{
  Machine machine{5, 1};
  machine.choice.stay_on_cpu();
  machine.choice.device_is_built();
  for (int step = 0; step < 100; ++step) {
    machine.size *= step % 2 ? 2 : 1;
    CHECK(machine.step() == Candidate::cpu);
  }
  machine.choice.measure_again();
  CHECK(machine.choice.is_settled());

  Machine fails{5, 1};
  fails.choice.device_is_built();
  fails.measure();
  CHECK(fails.choice.next() == Candidate::device);
  fails.choice.stay_on_cpu();
  CHECK(fails.choice.next() == Candidate::cpu);
}

namespace {

std::vector<double> stages(std::initializer_list<double> times)
{
  std::vector<double> all(all_stages(), 0.0);
  std::copy(times.begin(), times.end(), all.begin());
  return all;
}

} // namespace

TEST_CASE("stage cut: the fastest of the cuts, with what crosses")
{
  const std::vector<double> cpu = stages({1, 0, 5, 9, 1}), device = stages({4, 0, 2, 1, 6});
  const auto free = [](const std::vector<bool> &) { return 0.0; };
  const std::optional<StageCut> cut = find_cut(cpu, device, free);
  REQUIRE(cut);
  CHECK(cut->milliseconds == 1 + 2 + 1 + 1);
  CHECK_FALSE(cut->on_device[0]);
  CHECK(cut->on_device[2]);
  CHECK(cut->on_device[3]);
  CHECK_FALSE(cut->on_device[4]);

  const auto dear = [](const std::vector<bool> &on_device) { return on_device[0] != on_device[2] ? 100.0 : 0.5; };
  const std::optional<StageCut> other = find_cut(cpu, device, dear);
  REQUIRE(other);
  CHECK(other->milliseconds == 4 + 2 + 1 + 1 + 0.5);

  CHECK_FALSE(find_cut(stages({1}), stages({2}), free));
}

TEST_CASE("stage cut: what crosses follows from who reads what was written where")
{
  const auto bytes_of = [](Buffer buffer) -> uint64_t { return buffer == Buffer::counts ? 4 : 100; };
  std::vector<bool> nowhere(all_stages(), false), everywhere(all_stages(), true), parallel = nowhere;
  parallel[static_cast<size_t>(Stage::parallel)] = true;
  const auto bytes = [&](const LaunchRecord &record, const std::vector<bool> &on_device) {
    return crossings_of(record, on_device, bytes_of).bytes;
  };
  LaunchRecord apart; /* neither reads what the other writes */
  apart.launch({Kernel::fill, {Buffer::fat_bounds}, {1}});
  apart.launch({Kernel::integrate_velocities, {}, {}});
  CHECK(bytes(apart, parallel) == 0);
  LaunchRecord scratch = apart; /* it crosses once, and what the last step left in it does not */
  scratch.launch({Kernel::copy, {Buffer::solver_velocity, Buffer::fat_bounds}, {}});
  CHECK(bytes(scratch, parallel) == 100);
  LaunchRecord kept = apart; /* what one side writes for the other in each step crosses in each */
  kept.launch({Kernel::copy, {Buffer::fat_bounds, Buffer::parameters}, {}});
  CHECK(bytes(kept, parallel) == 100);
  for (const LaunchRecord &record : {apart, scratch, kept}) {
    CHECK(bytes(record, nowhere) == 0);
    CHECK(bytes(record, everywhere) == 0);
  }
}
