/* A build on a thread of its own hands over what it has built, whether or not it came to its end. */
#include <stdexcept>
#include <string>

#include "host/runtime/opencl/background_build.h"
#include "tests/catch.h"

namespace tandem::opencl {
namespace {

const ProgramKey first{Stage::parallel, 0}, second{Stage::solve, 0}, third{Stage::integrate, 0};

/* Sorted by stage, as they are built. */
MissingPrograms three_programs()
{
  return {{first, {Kernel::fill, Kernel::copy}}, {second, {Kernel::solve_contacts}}, {third, {Kernel::finish_step}}};
}

void build_nothing(const ProgramKey &, const std::vector<Kernel> &kernels, KernelPrograms &programs)
{
  for (const Kernel kernel : kernels) programs[kernel];
}

} // namespace

TEST_CASE("a build in the background counts its kernels and hands the programs over once")
{
  BackgroundBuild build;
  CHECK_FALSE(build.is_running());
  CHECK(build.take().empty());
  build.begin(three_programs(), build_nothing);
  const Programs programs = build.take();
  REQUIRE(programs.size() == 3);
  CHECK(programs.at(first).size() == 2);
  CHECK(build.progress().built == 4);
  CHECK(build.progress().wanted == 4);
  CHECK_FALSE(build.has_failed());
  CHECK(build.take().empty());
}

TEST_CASE("a build in the background that fails keeps what was built before, says why once, and may begin again")
{
  BackgroundBuild build;
  build.begin(three_programs(), [](const ProgramKey &key, const auto &kernels, KernelPrograms &programs) {
    if (key == second) throw std::runtime_error("no such register");
    build_nothing(key, kernels, programs);
  });
  const Programs programs = build.take();
  CHECK(programs.at(first).size() == 2);
  CHECK_FALSE(programs.contains(third));
  CHECK(build.progress().built == 2);
  CHECK(build.has_failed());
  CHECK_THROWS_WITH(build.tell_failure(), "no such register");
  CHECK_FALSE(build.has_failed());
  CHECK_NOTHROW(build.tell_failure());
  build.begin(three_programs(), build_nothing);
  CHECK(build.take().size() == 3);
}

} // namespace tandem::opencl
