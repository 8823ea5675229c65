/* Broadphases that keep data from step to step find the oracle's pairs in every one of 200 steps: boxes drift, race,
 * jump across the world, stop and start again, grow and shrink, and become NaN. Some steps are run again, and queries
 * between steps rebuild the hierarchy for their own use. */
#include <algorithm>
#include <cmath>
#include <limits>

#include "host/runtime/make_backend.h"
#include "host/runtime/opencl/device_backend.h"
#include "tests/host/runtime/opencl/opencl_device.h"
#include "tests/parity/parity.h"
#include "tests/shared/broadphase/random_boxes.h"

using namespace tandem;

namespace {

/* Random boxes that move. Places are whole multiples of `grain` where it is not 0, so that many ends fall together. */
class MovingBoxes {
public:
  MovingBoxes(uint32_t n, double speed, double grain, uint64_t seed)
      : random_(seed), speed_(speed), grain_(grain), side_(std::cbrt(2.0 * n))
  {
    boxes.add_half_space();
    for (uint32_t i = 0; i < n; ++i) {
      center_.push_back({random_.uniform(0, side_), random_.uniform(0, side_), random_.uniform(0, side_)});
      half_.push_back(
          {i % 50 == 0 ? 0.0 : random_.uniform(0.3, 0.5), i % 40 == 0 ? 4.0 : 0.4, random_.uniform(0.3, 0.5)});
      way_.push_back({0, 0, 0});
      boxes.add({0, 0, 0}, {0, 0, 0}, random_.below(8) == 0 ? BODY_TYPE_FIXED : BODY_TYPE_DYNAMIC,
                1u << random_.below(3), random_.below(8) == 0 ? 2u : 0xffffffffu);
    }
    boxes.large = 1 + std::min(n, 3u);
    place();
  }

  /* Most stand for a while, then start; a few jump; one leaves the numbers for some steps. */
  void move(uint32_t step)
  {
    for (size_t i = 0; i < center_.size(); ++i) {
      if (random_.below(10) == 0) way_[i] = random_.below(2) ? std::array<double, 3>{0, 0, 0} : any_displacement();
      const bool everyone_rests = step % 100 > 50;
      for (size_t axis = 0; axis < 3; ++axis) center_[i][axis] += everyone_rests && i % 16 != 0 ? 0 : way_[i][axis];
      if (random_.below(400) == 0)
        center_[i] = {random_.uniform(-side_, 2 * side_), random_.uniform(0, side_), random_.uniform(0, side_)};
      if (random_.below(400) == 0) half_[i][1] = random_.uniform(0, 3);
    }
    lost_ = step % 20 < 5 ? step / 20 % uint32_t(center_.size()) : uint32_t(center_.size());
    place();
  }

  std::vector<float4> velocities() const
  {
    std::vector<float4> rows(2 * boxes.size(), float4{0, 0, 0, 0});
    for (size_t i = 0; i < way_.size(); ++i)
      rows[2 * (i + 1)] = {float(way_[i][0]), float(way_[i][1]), float(way_[i][2]), 1};
    return rows;
  }

  RandomBoxes boxes;

private:
  std::array<double, 3> any_displacement()
  {
    return {random_.uniform(-speed_, speed_), random_.uniform(-speed_, speed_), random_.uniform(-speed_, speed_)};
  }
  double on_grain(double x) const { return grain_ > 0 ? grain_ * std::floor(x / grain_) : x; }

  void place()
  {
    for (uint32_t i = 0; i < center_.size(); ++i) {
      float4 &low = boxes.bounds[2 * (i + 1)], &high = boxes.bounds[2 * (i + 1) + 1];
      const auto &c = center_[i], &h = half_[i];
      low = {float(on_grain(c[0] - h[0])), float(on_grain(c[1] - h[1])), float(on_grain(c[2] - h[2])), 0};
      high = {float(on_grain(c[0] + h[0])), float(on_grain(c[1] + h[1])), float(on_grain(c[2] + h[2])), 0};
      if (i == lost_) low.y = std::numeric_limits<float>::quiet_NaN();
    }
  }

  Random random_;
  double speed_, grain_, side_;
  uint32_t lost_ = 0xffffffffu;
  std::vector<std::array<double, 3>> center_, half_, way_;
};

/* NaN has no place in the oracle's order. */
BodyPairs pairs_of(const RandomBoxes &boxes)
{
  RandomBoxes finite = boxes;
  for (uint32_t i = 0; i < boxes.size(); ++i)
    if (std::isnan(boxes.bounds[2 * i].y))
      finite.bounds[2 * i] = finite.bounds[2 * i + 1] = {1e29f + 1e25f * float(i), 1e29f, 1e29f, 0};
  BodyPairs pairs = expected_pairs(finite);
  std::erase_if(pairs, [&](const auto &pair) {
    return std::isnan(boxes.bounds[2 * pair.first].y) || std::isnan(boxes.bounds[2 * pair.second].y);
  });
  return pairs;
}

/* The boxes of a motion, and the oracle's pairs in each step: they take long, and are the same for every broadphase. */
struct Motion {
  Motion(uint32_t boxes, double speed_in_step, double grain_of_places, uint32_t steps)
      : n(boxes), speed(speed_in_step), grain(grain_of_places)
  {
    MovingBoxes moving = start();
    for (uint32_t step = 0; step < steps; ++step) {
      pairs.push_back(pairs_of(moving.boxes));
      moving.move(step);
    }
  }
  MovingBoxes start() const { return {n, speed, grain, 17}; }

  uint32_t n;
  double speed, grain;
  std::vector<BodyPairs> pairs; /* of each step */
};

/* Steps of motion, all of whose pairs are as they should be; many come and go on the way. */
void check_motion(BroadphaseRunner &runner, Broadphase broadphase, const Motion &motion)
{
  MovingBoxes moving = motion.start();
  runner.take(moving.boxes);
  BodyPairs before;
  size_t came = 0;
  for (uint32_t step = 0; step < motion.pairs.size(); ++step) {
    CAPTURE(broadphase, runner.name(), motion.n, motion.speed, motion.grain, step);
    runner.move_to(moving.boxes, moving.velocities());
    if (step % 7 == 3) runner.make_query_hierarchy();
    BodyPairs found = runner.find(row_of(broadphase));
    if (step % 5 == 2) found = runner.find(row_of(broadphase));
    REQUIRE(found == motion.pairs[step]);
    came += static_cast<size_t>(std::count_if(found.begin(), found.end(), [&](const auto &pair) {
      return !std::binary_search(before.begin(), before.end(), pair);
    }));
    before = found;
    moving.move(step);
  }
  if (motion.n > 100) CHECK(came > before.size() + 100);
}

constexpr Broadphase keeping[] = {Broadphase::sap3, Broadphase::trees, Broadphase::bvh, Broadphase::bvh_history};

} // namespace

TEST_CASE("broadphases that keep something are right in each of two hundred steps of motion", "[motion]")
{
  const char *backend = GENERATE("serial", "serial:order=backward", "tbb:threads=3");
  BroadphaseRunner runner(make_backend(backend));
  for (const double speed : {0.01, 0.4}) {
    const Motion motions[] = {
        {1, speed, 0, 60}, {2, speed, 0, 60}, {40, speed, 0, 60}, {500, speed, 0, 200}, {300, speed, 0.25, 200}};
    for (const Broadphase broadphase : keeping)
      for (const Motion &motion : motions) check_motion(runner, broadphase, motion);
  }
}

TEST_CASE("broadphases that keep something are right among many", "[motion]")
{
  BroadphaseRunner runner(make_backend("tbb"));
  const Motion motion(20000, 0.02, 0, 15);
  for (const Broadphase broadphase : keeping) check_motion(runner, broadphase, motion);
}

TEST_CASE("broadphases on OpenCL that keep something are right in each step of motion", "[motion]")
{
  parity::require_pocl();
  BroadphaseRunner runner(make_backend("cl:pocl"));
  const Motion motions[] = {{2, 0.1, 0, 20}, {400, 0.1, 0, 60}};
  for (const Broadphase broadphase : keeping)
    for (const Motion &motion : motions) check_motion(runner, broadphase, motion);
}
