/* bench_starts_test.cpp - the real program: `tandem bench starts` measures starts in processes of their own and refuses
 * bad use in one line; `tandem run --start cpu` has the bits of any other run. */
#ifdef TANDEM_COMMAND
#include "tests/host/runtime/opencl/pocl.h"
#include "tests/tools/command/command_line.h"

namespace command_line {

/* One ball has the fewest kernels, which a compiler starts on three times. */
TEST_CASE("command: bench starts has a row for each start and writes its table into a page", "[command]")
{
  tandem::parity::require_pocl();
  const Scratch scratch;
  const std::string page = scratch.file("page.md"), before = "text\n<!-- table starts cl:pocl: begin -->\n",
                    after = "<!-- table starts cl:pocl: end -->\nmore\n";
  std::ofstream(page) << before << after;
  const Json json = json_of("bench starts --on cl:pocl --scene spheres:n=1 --table-in " + page);
  check_keys(json, {"what", "backend", "starts"});
  REQUIRE(json["starts"].size() == 4);
  for (size_t k = 0; k < 4; ++k) {
    const Json &start = json["starts"][k];
    check_keys(start, {"scene", "cached", "start", "kernels", "made_ms", "first_step_ms", "device_step_ms",
                       "longest_step_ms", "steps_on_cpu", "hash"});
    CHECK(start["scene"] == "spheres:n=1");
    CHECK(start["cached"] == (k >= 2));
    CHECK(start["start"] == (k % 2 ? "cpu" : "device"));
    CHECK(start["hash"] == json["starts"][0]["hash"]);
    CHECK(start["made_ms"].get<double>() > 0);
    CHECK(start["made_ms"] < start["first_step_ms"]);
    CHECK(start["first_step_ms"] <= start["device_step_ms"]);
    if (k % 2 == 0) CHECK(start["steps_on_cpu"] == 0);
  }
  const std::string written = contents(page);
  CHECK(written.find(before + "```\ntandem bench starts --on cl:pocl --scene spheres:n=1 --table-in ") == 0);
  CHECK(written.find("\n| spheres:n=1 | off | cpu | ") != std::string::npos);
  CHECK(written.find("\n| spheres:n=1 | filled | device | ") != std::string::npos);
  CHECK(written.find(after) == written.size() - after.size());
}

TEST_CASE("command: bench starts refuses what it cannot do", "[command]")
{
  const Scratch scratch;
  const std::string page = scratch.file("page.md");
  std::ofstream(page) << "text\n";
  check_refused("bench starts", "--on 'tbb'");
  check_refused("bench starts --on serial --scene spheres", "--on 'serial'");
  check_refused("bench starts --on cl:no-such-device", "no-such-device");
  check_refused("bench starts --on cl --n 100", "--n");
  check_refused("bench starts --on cl --inexact", "only on backends that are exact");
  check_refused("bench starts --on cl --steps 5", "--steps is of bench scenes");
  check_refused("bench starts --on cl --table-in " + page, "<!-- table starts cl: begin -->");
}

TEST_CASE("command: bench starts refuses scenes that do not exist, with their parameters", "[command]")
{
  tandem::parity::require_pocl();
  check_refused("bench starts --on cl:pocl --scene nonsense", "nonsense");
  check_refused("bench starts --on cl:pocl --scene box-grid:nx=2,ny=2,bricks=3", "bricks");
}

TEST_CASE("command: run --start has the same hash from either start, and says what ran where", "[command]")
{
  check_refused("run spheres:n=2 --start gpu", "--start 'gpu'");
  const Json cpu = json_of("run spheres:n=9 --steps 4 --on serial");
  CHECK(cpu["placement"]["building"]["steps_on_cpu"] == 0);
  tandem::parity::require_pocl();
  const std::string device = "run spheres:n=9 --steps 4 --on cl:pocl ";
  for (const char *start : {"--start device", "--start cpu"}) {
    const Json json = json_of(device + start);
    CAPTURE(start);
    CHECK(json["hash"] == cpu["hash"]);
    const Json &building = json["placement"]["building"];
    check_keys(building, {"steps_on_cpu", "moved_after", "ms", "built", "kernels"});
    if (std::string(start) == "--start cpu") CHECK(building["kernels"] > 10);
    else CHECK(building["steps_on_cpu"] == 0);
  }
  CHECK(command(device + "--start cpu").out.find("\n  start           ") != std::string::npos);
  CHECK(command(device).out.find("\n  start           ") == std::string::npos);
  const Result worlds = command("run spheres:n=4 --worlds 3 --steps 4 --on cl:pocl --start cpu");
  CHECK(worlds.status == 0);
  CHECK(worlds.out.find("\n  start ") != std::string::npos);
}

} // namespace command_line
#endif
