/* A region runs every item of a series once, launch after launch, whoever comes, late or not at all. */
#include <algorithm>
#include <chrono>
#include <numeric>
#include <thread>

#include "host/base/random.h"
#include "minicl/parallel_region.h"
#include "tests/catch.h"

using namespace tandem;
using namespace tandem::minicl;

namespace {

/* Each launch computes its items from all that the one before wrote, which also says how many items it has. */
class Chain : public LaunchesOfRegion {
public:
  Chain(size_t launches, uint64_t seed) : items_(launches), written_(launches), runs_(launches)
  {
    Random random(seed);
    for (size_t launch = 0; launch < launches; ++launch) {
      most_.push_back(random.below(3) == 0 ? 0 : random.below(900));
      items_of_part_.push_back(1 + random.below(60));
      stays_.push_back(random.uniform(0, 1) < 0.5);
    }
  }
  size_t count() const override { return most_.size(); }
  Range range_of(size_t launch) const override
  {
    items_[launch] = items_after_last(launch);
    return {offset, offset + items_[launch], items_of_part_[launch], stays_[launch]};
  }
  void run(size_t launch, uint32_t first, uint32_t last) override
  {
    if (launch == slow_launch) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::vector<uint64_t> &numbers = numbers_[launch % 2];
    for (uint32_t item = first - offset; item < last - offset; ++item)
      numbers[item] = 6364136223846793005u * (sum_before(launch, item) + item) + launch;
    written_[launch].fetch_add(last - first);
    ++runs_[launch];
  }

  uint64_t result()
  {
    uint64_t sum = 0;
    for (size_t launch = 0; launch < count(); ++launch) {
      REQUIRE(written_[launch] == items_[launch]);
      sum = 31 * sum + items_[launch];
    }
    for (const auto &numbers : numbers_) sum = std::accumulate(numbers.begin(), numbers.end(), sum);
    return sum;
  }
  uint32_t most_runs_of_a_launch() const
  {
    uint32_t most = 0;
    for (const auto &runs : runs_) most = std::max(most, runs.load());
    return most;
  }

private:
  static constexpr uint32_t offset = 5;
  static constexpr size_t slow_launch = 40;

  uint32_t items_after_last(size_t launch) const
  {
    if (launch == 0) return most_[0];
    return most_[launch] == 0
               ? 0
               : most_[launch] - static_cast<uint32_t>(numbers_[(launch + 1) % 2][0] % (most_[launch] / 2 + 1));
  }
  uint64_t sum_before(size_t launch, uint32_t item) const
  {
    const std::vector<uint64_t> &before = numbers_[(launch + 1) % 2];
    return before[item] + before[(item * 7) % before.size()] + before[(item * 13 + 1) % before.size()];
  }

  std::vector<uint32_t> most_, items_of_part_;
  mutable std::vector<uint32_t> items_; /* of each launch, as they were when it began */
  std::vector<bool> stays_;
  std::vector<std::atomic<uint32_t>> written_, runs_;
  std::vector<uint64_t> numbers_[2] = {std::vector<uint64_t>(1000, 1), std::vector<uint64_t>(1000, 2)};
};

uint64_t in_order(size_t launches, uint64_t seed)
{
  Chain chain(launches, seed);
  for (size_t launch = 0; launch < launches; ++launch) {
    const Chain::Range range = chain.range_of(launch);
    if (range.first < range.last) chain.run(launch, range.first, range.last);
  }
  return chain.result();
}

/* One launch whose items stay on their threads, each taking longer than the one before; by share, in the order run. */
class Rising : public LaunchesOfRegion {
public:
  explicit Rising(uint32_t items) : items_(items) {}
  size_t count() const override { return 1; }
  Range range_of(size_t) const override { return {0, items_, 1, true}; }
  void run(size_t, uint32_t first, uint32_t last) override { pieces.emplace_back(first, last); }

  /* Shares begin where the front pieces of those before have ended; there are so many that have any items. */
  std::vector<uint32_t> items_of_shares(size_t shares) const
  {
    std::vector<uint32_t> items;
    uint32_t front = 0;
    for (const auto &[first, last] : pieces) {
      const bool begins = first == front && items.size() < shares;
      if (begins) items.push_back(0);
      if (begins) front = last;
      items.back() += last - first;
    }
    return items;
  }
  bool covers_once() const
  {
    std::vector<uint32_t> times(items_, 0);
    for (const auto &[first, last] : pieces)
      for (uint32_t item = first; item < last; ++item) ++times.at(item);
    return std::all_of(times.begin(), times.end(), [](uint32_t n) { return n == 1; });
  }

  std::vector<std::pair<uint32_t, uint32_t>> pieces;

private:
  uint32_t items_;
};

} // namespace

TEST_CASE("a parallel region gives each thread whole lanes, and as much of what takes long as the others")
{
  constexpr uint32_t threads = 4, lanes = 16, items = 160 * lanes + 5;
  ParallelRegion region(threads, 1);
  Rising rising(items);
  region.begin(rising, threads);
  region.take_part(0); /* alone, so the shares come one after another */
  REQUIRE(region.has_ended());
  REQUIRE(rising.pieces.size() == 2 * threads);
  std::vector<double> work(threads, 0.0);
  for (size_t k = 0; k < rising.pieces.size(); ++k) {
    const auto [first, last] = rising.pieces[k];
    CHECK(first % lanes == 0);
    CHECK((last % lanes == 0 || last == items));
    work[k / 2] += 0.5 * (last - first) * (first + last);
  }
  const double mean = std::accumulate(work.begin(), work.end(), 0.0) / threads;
  for (const double share : work) CHECK(share == Approx(mean).epsilon(0.05));
}

TEST_CASE("a parallel region parts any number of items into shares that differ by one instruction of lanes")
{
  constexpr uint32_t lanes = 16;
  for (const uint32_t threads : {2u, 3u, 4u, 7u, 16u}) {
    ParallelRegion region(threads, 1);
    for (uint32_t items = threads; items < 40 * lanes; items += 5) {
      CAPTURE(threads, items);
      Rising rising(items);
      region.begin(rising, threads);
      region.take_part(0);
      const uint32_t units = (items + lanes - 1) / lanes, most = (units + threads - 1) / threads * lanes;
      const std::vector<uint32_t> shares = rising.items_of_shares(std::min(threads, units));
      CHECK(*std::max_element(shares.begin(), shares.end()) <= most);
      CHECK(*std::min_element(shares.begin(), shares.end()) + 2 * lanes > most);
      CHECK(rising.covers_once());
    }
  }
}

TEST_CASE("a parallel region runs a series as one thread would, whoever comes")
{
  for (const uint32_t room : {1u, 2u, 3u, 8u})
    for (const uint32_t present : {1u, 2u, 8u}) {
      if (present > room) continue;
      CAPTURE(room, present);
      ParallelRegion region(room, 100);
      for (uint64_t seed = 1; seed <= 6; ++seed) {
        const size_t launches = 50 * seed;
        Chain chain(launches, seed);
        region.begin(chain, room);
        std::vector<std::thread> threads;
        for (uint32_t thread = 0; thread < present; ++thread)
          threads.emplace_back([&region, thread] {
            if (thread % 2 == 1) std::this_thread::sleep_for(std::chrono::microseconds(300 * thread));
            region.take_part(thread);
          });
        for (std::thread &thread : threads) thread.join();
        REQUIRE(region.has_ended());
        REQUIRE(chain.result() == in_order(launches, seed));
        if (room == 1) REQUIRE(chain.most_runs_of_a_launch() == 1);
      }
    }
}

TEST_CASE("a parallel region of no launches, and one of small ones, has ended when it begins")
{
  ParallelRegion region(4, 1);
  Chain none(0, 1);
  region.begin(none, 4);
  REQUIRE(region.has_ended());
  Chain alone(100, 2);
  region.begin(alone, 1);
  REQUIRE(region.has_ended());
  REQUIRE(alone.result() == in_order(100, 2));
}
