/* Enumerated settings: their names, the way back from a name, and the names that are refused. */
#include <algorithm>

#include <tandem/scene.h>
#include <tandem/settings.h>

#include "tests/catch.h"

using namespace tandem;
using Catch::Matchers::Equals;

namespace {

template <Choice T> void check_names(size_t count, const std::string &first)
{
  REQUIRE(choices<T>().size() == count);
  REQUIRE(choice_names<T>().size() == count);
  CHECK(choices<T>().front() == T{});
  CHECK(choice_names<T>().front() == first);
  for (size_t k = 0; k < count; ++k) {
    const std::string name = choice_names<T>()[k];
    CHECK(name == name_of(choices<T>()[k]));
    CHECK(parse_setting<T>(name) == choices<T>()[k]);
    CHECK(std::count(name.begin(), name.end(), '_') == 0);
    CHECK_THROWS_AS(parse_setting<T>(name + "x"), InputError);
  }
  CHECK_THROWS_AS(parse_setting<T>(""), InputError);
  CHECK_THROWS_AS(name_of(static_cast<T>(200)), InputError);
}

/* Refused with this value in place of that of the defaults. */
template <Choice T> void check_refused(T Settings::*member, const std::string &message)
{
  Settings settings;
  settings.*member = static_cast<T>(200);
  CHECK_THROWS_WITH(validate(settings), Equals(message));
  if constexpr (!std::is_same_v<T, Broadphase>) {
    settings.*member = static_cast<T>(choices<T>().size());
    CHECK_THROWS_AS(validate(settings), InputError);
  }
  for (const T choice : choices<T>()) {
    settings.*member = choice;
    CHECK_NOTHROW(validate(settings));
  }
}

} // namespace

TEST_CASE("settings: every choice has a name that leads back to it, the default first")
{
  check_names<Solver>(7, "soft-step");
  check_names<Broadphase>(13, "grid");
  check_names<Bounds>(2, "affine");
  check_names<Midphase>(2, "walk");
  check_names<Narrowphase>(5, "sat");
  check_names<Support>(3, "brute-force");
  check_names<Batching>(5, "coloring");
  CHECK(parse_setting<Broadphase>("auto") == Broadphase::automatic);
  CHECK(name_of(Broadphase::automatic) == std::string("auto"));
  CHECK(Settings{}.broadphase == Broadphase::automatic);
}

TEST_CASE("settings: a name that is unknown is refused in one line that lists those that there are")
{
  CHECK_THROWS_WITH(parse_setting<Solver>("magic"),
                    Equals("solver 'magic' is unknown; use soft-step, pgs, nncg, xpbd, avbd, jacobi, direct"));
  CHECK_THROWS_WITH(parse_setting<Broadphase>(""),
                    Equals("broadphase '' is unknown; use grid, grid-bitonic, grid-14, brute-force, sap, sap-pca, "
                           "sap-plain, sap3, hybrid, bvh, bvh-stack, bvh-history, trees, auto"));
  CHECK_THROWS_WITH(parse_setting<Narrowphase>("gjk"),
                    Equals("narrowphase 'gjk' is unknown; use sat, gjk-epa, gjk-sampled, sat-split, cube-map"));
}

TEST_CASE("settings: a number that is no choice is refused, and every choice is taken")
{
  check_refused(&Settings::solver,
                "solver number 200 is unknown; use soft-step, pgs, nncg, xpbd, avbd, jacobi, direct");
  check_refused(&Settings::broadphase,
                "broadphase number 200 is unknown; use grid, grid-bitonic, grid-14, brute-force, sap, sap-pca, "
                "sap-plain, sap3, hybrid, bvh, bvh-stack, bvh-history, trees, auto");
  check_refused(&Settings::bounds, "bounds number 200 is unknown; use affine, tight");
  check_refused(&Settings::midphase, "midphase number 200 is unknown; use walk, subtrees");
  check_refused(&Settings::narrowphase,
                "narrowphase number 200 is unknown; use sat, gjk-epa, gjk-sampled, sat-split, cube-map");
  check_refused(&Settings::support, "support number 200 is unknown; use brute-force, hill-climbing, cube-map");
  check_refused(&Settings::batching,
                "batching number 200 is unknown; use coloring, sequential, single-group, iterative, two-stage");
}

TEST_CASE("settings: a solver brings its own substeps and iterations")
{
  CHECK(settings_for(Solver::pgs).solver == Solver::pgs);
  CHECK(settings_for(Solver::pgs).substeps == 1);
  CHECK(settings_for(Solver::pgs).iterations == 10);
  CHECK(settings_for(Settings{}.solver).substeps == Settings{}.substeps);
  CHECK(settings_for(Settings{}.solver).iterations == Settings{}.iterations);
}
