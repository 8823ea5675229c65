/* The pair capacity has a limit: a step that needs more fails as a whole with a message, and the world continues. */
#include <fmt/format.h>

#include <tandem/world.h>

#include "host/catalog/catalog.h"
#include "host/pipeline/broadphases/broadphase.h"
#include "host/pipeline/layout.h"
#include "tests/catch.h"
#include "tests/physics/physics.h"

using namespace tandem;
using namespace tandem::physics_tests;

namespace {

constexpr uint32_t spheres = 40, all_pairs = spheres * (spheres - 1) / 2;

/* In one place where `apart` is 0. */
Scene dense_cluster(double apart)
{
  Scene scene = empty_scene({0, 0, 0});
  for (uint32_t i = 0; i < spheres; ++i) add_body(scene, BodyType::dynamic, sphere_shape(0.5f), {apart * i, 0, 0});
  return scene;
}

BodyState at(double x) { return {{x, 0, 0}, {0, 0, 0, 1}, {0, 0, 0}, {0, 0, 0}}; }

Settings limited(Broadphase broadphase, uint32_t most)
{
  Settings settings;
  settings.broadphase = broadphase;
  settings.max_pairs = most;
  return settings;
}

std::string failure_of(World &world)
{
  try {
    world.step();
  } catch (const std::runtime_error &error) {
    return error.what();
  }
  return "";
}

} // namespace

TEST_CASE("a step with more pairs than are allowed fails whole with every broadphase, and the world goes on")
{
  for (const Broadphase broadphase : choices<Broadphase>())
    for (const char *on : {"serial", "tbb:threads=2"}) {
      CAPTURE(broadphase, on);
      World world(dense_cluster(2), limited(broadphase, all_pairs / 2), Placement{on, {}, false});
      world.step();
      for (uint32_t body = 0; body < spheres; ++body) world.set_body(body, at(0));
      const uint64_t before = world.state_hash();
      const std::string message = failure_of(world);
      INFO(message);
      CHECK(message.find(fmt::format("{} are the most (--max-pairs", all_pairs / 2)) != std::string::npos);
      CHECK(message.find(fmt::format("room for {} pairs", all_pairs)) != std::string::npos);
      CHECK(message.find("step 1: ") != std::string::npos);
      CHECK(world.state_hash() == before);
      CHECK(failure_of(world) == message);
      for (uint32_t body = 0; body < spheres; ++body) world.set_body(body, at(2.0 * body));
      CHECK(failure_of(world).empty());
      CHECK(world.statistics().steps == 2);
    }
}

TEST_CASE("a message names all pairs that need room, or says that it names the least")
{
  for (const Broadphase broadphase : choices<Broadphase>()) {
    World world(dense_cluster(0), limited(broadphase, 10), Placement{"serial", {}, false});
    const std::string message = failure_of(world), begin = "step 0: room for ";
    CAPTURE(broadphase, message);
    REQUIRE(message.find(begin) == 0);
    const bool is_least = message.find("at least ") == begin.size();
    const uint64_t needed = std::stoull(message.substr(begin.size() + (is_least ? 9 : 0)));
    CHECK(is_least == (broadphase == Broadphase::trees));
    CHECK((is_least ? needed > 10 && needed < all_pairs : needed == all_pairs));
  }
}

TEST_CASE("as many pairs as are allowed are found, none fewer, and they change no bit")
{
  for (const Broadphase broadphase : choices<Broadphase>()) {
    CAPTURE(broadphase);
    World exact(dense_cluster(0.001), limited(broadphase, all_pairs), Placement{"serial", {}, false}),
        free(dense_cluster(0.001), limited(broadphase, most_pairs), Placement{"serial", {}, false});
    exact.step();
    free.step();
    CHECK(exact.statistics().pairs == all_pairs);
    CHECK(exact.state_hash() == free.state_hash());
    World one_less(dense_cluster(0.001), limited(broadphase, all_pairs - 1), Placement{"serial", {}, false});
    CHECK_FALSE(failure_of(one_less).empty());
  }
}

namespace {

constexpr double in_a_row = 0.7; /* apart, so that each overlaps the next */

/* All in a row, in another order of neighbours than before. */
void exchange_neighbours(World &world)
{
  for (uint32_t body = 0; body < spheres; ++body) world.set_body(body, at(in_a_row * (body * 17 % spheres)));
}

struct InRows {
  uint32_t most; /* pairs, in the row as it stands and in the other order */
  uint64_t hash;
};

InRows in_rows_by_brute_force()
{
  World world(dense_cluster(in_a_row), limited(Broadphase::brute_force, most_pairs), Placement{"serial", {}, false});
  world.step();
  const uint32_t pairs = world.statistics().pairs;
  exchange_neighbours(world);
  world.step();
  return {std::max(pairs, world.statistics().pairs), world.state_hash()};
}

} // namespace

/* The list of changes may be longer than that of the pairs, as where every pair parts and every new one meets: then all
 * that is kept is forgotten, and the step runs again. */
TEST_CASE("a broadphase that keeps its list needs no more room for pairs than others")
{
  const auto [most, hash] = in_rows_by_brute_force();
  for (const Broadphase broadphase : {Broadphase::sap3, Broadphase::trees, Broadphase::grid}) {
    CAPTURE(broadphase, most);
    World world(dense_cluster(in_a_row), limited(broadphase, most), Placement{"serial", {}, false});
    CHECK(failure_of(world).empty());
    exchange_neighbours(world);
    CHECK(failure_of(world).empty());
    CHECK(world.statistics().pairs <= most);
    CHECK(world.state_hash() == hash);
  }
  World free(dense_cluster(in_a_row), limited(Broadphase::sap3, most_pairs), Placement{"serial", {}, false});
  free.step();
  exchange_neighbours(free);
  free.step();
  CHECK(free.memory().read<uint32_t>(Buffer::counts, COUNT_TOTAL)[COUNT_CHANGES_FOUND] >
        most); /* so there is something to forget for */
}

TEST_CASE("pairs of leaves count against the limit too")
{
  for (const Midphase midphase : {Midphase::walk, Midphase::subtrees}) {
    Settings settings = limited(Broadphase::grid, 20);
    settings.midphase = midphase;
    World world(load_scene("compounds:n=20"), settings, Placement{"serial", {}, false});
    std::string message;
    for (int k = 0; k < 120 && message.empty(); ++k) message = failure_of(world);
    INFO(message);
    CHECK(message.find("20 are the most") != std::string::npos);
  }
}

TEST_CASE("a limit of pairs that makes no sense is refused")
{
  CHECK_THROWS_AS(World(dense_cluster(2), limited(Broadphase::grid, 0)), InputError);
  CHECK_THROWS_AS(World(dense_cluster(2), limited(Broadphase::grid, most_pairs + 1)), InputError);
}

/* 12 x 256 x 256 words of cube maps a hull: 5,462 of them pass 2^32. */
TEST_CASE("tables past what kernels can number are refused by name before they are made")
{
  Sizes sizes;
  sizes.features = ~Features{0};
  sizes.hulls.links = 5461u * 12u * 65536ull;
  CHECK_NOTHROW(check_size(Buffer::hull_link, sizes));
  sizes.hulls.links = 5462u * 12u * 65536ull;
  CHECK_THROWS_WITH(check_size(Buffer::hull_link, sizes), Catch::Matchers::ContainsSubstring("hull_link") &&
                                                              Catch::Matchers::ContainsSubstring("4295491584"));
  sizes.pairs = 1u << 28;
  CHECK_NOTHROW(check_size(Buffer::split_point, sizes));
  sizes.pairs = (1u << 28) + 1;
  CHECK_THROWS_AS(check_size(Buffer::split_point, sizes), InputError);
}

namespace {

std::string excess_of(World &world, const StepLimits &limits)
{
  try {
    world.step(limits);
  } catch (const LimitExceeded &error) {
    return error.what();
  }
  return "";
}

/* A plate without gravity that so many balls touch, far from each other. */
Scene laden_plate(uint32_t balls)
{
  Scene scene = empty_scene({0, 0, 0});
  add_body(scene, BodyType::dynamic, box_shape(50, 1, 1), {0, 0, 0});
  for (uint32_t i = 0; i < balls; ++i)
    add_body(scene, BodyType::dynamic, sphere_shape(0.3f), {i - 0.5 * balls, 1.299, 0});
  return scene;
}

} // namespace

TEST_CASE("a step beyond its budget of pairs fails whole, and within it has the bits that it has without one")
{
  World world(dense_cluster(0.001), {}, {"serial", {}}), free(dense_cluster(0.001), {}, {"serial", {}});
  const uint64_t before = world.state_hash();
  const std::string message = excess_of(world, {.pairs = all_pairs - 1});
  CHECK(message.find(fmt::format("step 0: {} pairs are needed, and {} are the most that the limits of this step allow",
                                 all_pairs, all_pairs - 1)) == 0);
  CHECK(world.state_hash() == before);
  CHECK(world.statistics().steps == 0);
  CHECK(excess_of(world, {.pairs = all_pairs}).empty());
  free.step();
  CHECK(world.state_hash() == free.state_hash());
}

TEST_CASE("a step beyond its budget of colouring says how many contacts have to wait for others")
{
  constexpr uint32_t balls = 90, sequential = balls - 63; /* all are contacts of the plate, and 63 colours are there */
  World world(laden_plate(balls), {}, {"serial", {}}), free(laden_plate(balls), {}, {"serial", {}});
  const uint64_t before = world.state_hash();
  const std::string message = excess_of(world, {.sequential_contacts = sequential - 1});
  CHECK(message.find(fmt::format("{} contacts beyond the last colour", sequential)) != std::string::npos);
  const std::string rounds = excess_of(world, {.rounds = 1});
  CHECK(rounds.find("rounds of colouring are needed, and 1 are the most") != std::string::npos);
  CHECK(world.state_hash() == before);
  CHECK(excess_of(world, {.pairs = balls, .sequential_contacts = sequential}).empty());
  free.step();
  CHECK(world.state_hash() == free.state_hash());
}
