/* Series of launches: which launches reach a backend together, in which order, and what interrupts a series. */
#include <array>

#include "host/runtime/launcher.h"
#include "tests/catch.h"

using namespace tandem;

namespace {

/* Notes the kernels of each call, as "run fill" or "series fill copy"; it runs nothing. */
class Noting : public Backend {
public:
  Noting(std::vector<std::string> &calls, uint32_t most) : calls_(calls), most_(most) {}
  const std::string &name() const override { return name_; }
  Storage &storage() override { return host_storage(); }
  void prepare(Features, const std::vector<Kernel> &) override {}
  void finish() override {}
  void set_profiling(bool) override {}
  std::vector<Time> take_kernel_times() override { return {}; }
  uint32_t most_items_of_series() const override { return most_; }
  void run(const Launch &launch, const std::vector<BoundArgument> &, void *) override
  {
    calls_.push_back(std::string("run ") + row_of(launch.kernel).name);
  }
  void run_series(std::span<const BoundLaunch> series, void *) override
  {
    std::string call = "series";
    for (const BoundLaunch &bound : series) call += std::string(" ") + row_of(bound.launch.kernel).name;
    calls_.push_back(call);
  }

private:
  std::string name_ = "noting";
  std::vector<std::string> &calls_;
  uint32_t most_;
};

/* Kernels named copy run on another backend than all others. */
struct Fixture {
  std::vector<std::string> calls;
  Noting few{calls, 10}, other{calls, 0};
  Memory memory;
  PlacedLauncher launcher{memory, [this](Kernel kernel) -> Backend & { return kernel == Kernel::copy ? other : few; }};
  std::array<uint32_t, COUNT_TOTAL> known{};

  Fixture()
  {
    for (const Buffer buffer : {Buffer::primitive_a, Buffer::primitive_b, Buffer::counts})
      memory.resize(buffer, 4 * COUNT_TOTAL);
    known[COUNT_SMALL] = 10;
    known[COUNT_LENGTH] = 11;
  }
  void fill(uint32_t last) { launcher.launch({Kernel::fill, {Buffer::primitive_a}, {1}, COUNT_ZERO, last, 1000}); }
  void sequence() { launcher.launch({Kernel::sequence, {Buffer::primitive_a}, {}, COUNT_ZERO, COUNT_SMALL, 1000}); }
  void copy()
  {
    launcher.launch({Kernel::copy, {Buffer::primitive_a, Buffer::primitive_b}, {}, COUNT_ZERO, COUNT_SMALL, 1});
  }
};

using Calls = std::vector<std::string>;

} // namespace

TEST_CASE("launches of few items reach their backend in series, by what is known and in order")
{
  Fixture f;
  f.launcher.launch_in_series(f.known, [&] {
    f.fill(COUNT_SMALL);
    f.sequence();
    f.fill(COUNT_LENGTH); /* one item too many */
    f.sequence();
    f.fill(COUNT_SMALL);
  });
  REQUIRE(f.calls == Calls{"series fill sequence", "run fill", "series sequence fill"});
}

TEST_CASE("outside of a series, and where an estimate is no number of items, launches go one by one")
{
  Fixture f;
  f.fill(COUNT_SMALL);
  f.launcher.launch_in_series(f.known, [&] {
    f.launcher.launch({Kernel::fill, {Buffer::primitive_a}, {1}, COUNT_LENGTH, COUNT_SMALL, 1}); /* 11 to 10 */
  });
  f.sequence();
  REQUIRE(f.calls == Calls{"run fill", "run fill", "run sequence"});
}

TEST_CASE("a series ends before another backend runs, and before the commit")
{
  Fixture f;
  f.launcher.set_on_commit([&] { f.calls.emplace_back("commit"); });
  f.launcher.launch_in_series(f.known, [&] {
    f.fill(COUNT_SMALL);
    f.copy();
    f.fill(COUNT_SMALL);
    f.launcher.begin_commit();
    f.sequence();
  });
  REQUIRE(f.calls == Calls{"series fill", "run copy", "series fill", "commit", "series sequence"});
}

TEST_CASE("an observer sees each launch by itself")
{
  Fixture f;
  f.launcher.set_observer([&](const Launch &) { f.calls.emplace_back("seen"); });
  f.launcher.launch_in_series(f.known, [&] {
    f.fill(COUNT_SMALL);
    f.sequence();
  });
  REQUIRE(f.calls == Calls{"run fill", "seen", "run sequence", "seen"});
}

TEST_CASE("a long series is handed over in parts, and no launch is lost or repeated")
{
  Fixture f;
  f.launcher.launch_in_series(f.known, [&] {
    for (int k = 0; k < 150; ++k) f.sequence();
  });
  size_t launches = 0;
  for (const std::string &call : f.calls) {
    REQUIRE(call.starts_with("series "));
    launches += (call.size() - std::string("series").size()) / std::string(" sequence").size();
  }
  REQUIRE(launches == 150);
  REQUIRE(f.calls.size() > 1);
}

TEST_CASE("what an interrupted series had collected is never launched")
{
  Fixture f;
  REQUIRE_THROWS_AS(f.launcher.launch_in_series(f.known,
                                                [&] {
                                                  f.fill(COUNT_SMALL);
                                                  throw std::runtime_error("out of memory");
                                                }),
                    std::runtime_error);
  REQUIRE(f.calls.empty());
  f.launcher.launch_in_series(f.known, [&] { f.sequence(); });
  f.fill(COUNT_SMALL);
  REQUIRE(f.calls == Calls{"series sequence", "run fill"});
}
