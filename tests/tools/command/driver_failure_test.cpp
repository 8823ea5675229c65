/* driver_failure_test.cpp - OpenCL drivers that abort, crash, exit or hang when their devices are queried: the command
 * reports it in one line, and everything that needs no OpenCL works. */
#include <csignal>
#include <cstdlib>
#include <stdexcept>

#include <unistd.h>

#include "host/runtime/opencl/probe.h"
#include "tests/catch.h"

#if defined(TANDEM_COMMAND) && defined(TANDEM_FAILING_DRIVER)
#include "tests/tools/command/command_line.h"

using namespace command_line;

namespace {

/* A folder of drivers with the failing one alone. */
struct FailingDriver {
  Scratch folder;
  std::string environment;
  explicit FailingDriver(const std::string &displacement)
  {
    std::ofstream(folder.file("failing.icd")) << TANDEM_FAILING_DRIVER << "\n";
    environment =
        "FAILING_DRIVER=" + displacement + " TANDEM_OPENCL_TIMEOUT=1 OCL_ICD_VENDORS=" + folder.path.string() + "/";
  }
};

const char *const paths[][2] = {{"abort", "crashed (Aborted) while it was asked for its devices"},
                                {"crash", "crashed (Segmentation fault) while it was asked for its devices"},
                                {"exit", "ended the process (status 3) while it was asked for its devices"},
                                {"hang", "gave no answer in 1 s while it was asked for its devices"}};

} // namespace

TEST_CASE("failing drivers: what asks for OpenCL is refused in one line", "[command]")
{
  for (const auto &[displacement, said] : paths) {
    const FailingDriver driver(displacement);
    check_refused("run box-grid:nx=1,ny=1,nz=1 --steps 1 --on cl", said, driver.environment);
    check_refused("diff box-grid:nx=1,ny=1,nz=1 --steps 1 --between serial,cl:0.0", said, driver.environment);
  }
}

TEST_CASE("failing drivers: the list of devices goes on without OpenCL and says why", "[command]")
{
  for (const auto &[displacement, said] : paths) {
    const FailingDriver driver(displacement);
    const Result result = command("devices", driver.environment);
    INFO(result.out << result.error);
    CHECK(result.status == 0);
    CHECK(result.out.find("serial ") == 0);
    CHECK(result.out.find(std::string("No OpenCL device: an OpenCL driver ") + said) != std::string::npos);
    CHECK(result.error.empty());
    const Json json = Json::parse(command("devices --json -", driver.environment).out);
    CHECK(json["backends"].size() == 3);
    CHECK(json["opencl_fault"].get<std::string>().find(said) != std::string::npos);
  }
}

TEST_CASE("failing drivers: a run on the CPU asks no driver, and one without platforms is as none", "[command]")
{
  CHECK(command("run box-grid:nx=1,ny=1,nz=1 --steps 1 --on serial", FailingDriver("abort").environment).status == 0);
  const FailingDriver none("");
  check_refused("run box-grid:nx=1,ny=1,nz=1 --steps 1 --on cl", "no OpenCL platform is installed", none.environment);
}
#endif

#if defined(TANDEM_COMMAND) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_CASE("failing drivers: an installed driver that does not load is no missing one", "[command]")
{
  const command_line::Scratch folder;
  std::ofstream(folder.file("gone.icd")) << "/nowhere/libgone.so\n";
  const std::string environment = "OCL_ICD_VENDORS=" + folder.path.string() + "/";
  command_line::check_refused("run box-grid:nx=1,ny=1,nz=1 --steps 1 --on cl",
                              "gone.icd: /nowhere/libgone.so: cannot open shared object file", environment);
  CHECK(command_line::command("devices", environment).out.find("gone.icd: /nowhere/libgone.so") != std::string::npos);
}

TEST_CASE("failing drivers: without descriptors nobody says that none is installed", "[command]")
{
  const std::string without_inherited =
      "exec 3>&- 4>&- 5>&- 6>&- 7>&- 8>&- 9>&-; "; /* CTest leaves one open, and the loader of libraries needs one */
  for (const char *descriptors : {"4", "5", "6", "7"}) {
    const command_line::Result result = command_line::command("run box-grid:nx=1,ny=1,nz=1 --steps 1 --on cl",
                                                              without_inherited + "ulimit -n " + descriptors + ";");
    CAPTURE(descriptors, result.error);
    CHECK(result.status == 2);
    CHECK(result.error.find("Too many open files") != std::string::npos);
  }
}
#endif

TEST_CASE("the probe tells what came back from what did not")
{
  using tandem::opencl::driver_fault;
  CHECK(driver_fault([] {}).empty());
  CHECK(driver_fault([] { throw std::runtime_error("known to the parent"); }).empty());
  CHECK(driver_fault([] { throw tandem::opencl::DriverFault("known to the child alone"); }) ==
        "known to the child alone");
  CHECK(driver_fault([] { std::abort(); }).find("crashed (Aborted)") != std::string::npos);
  CHECK(driver_fault([] { std::raise(SIGSEGV); }).find("crashed (Segmentation fault)") != std::string::npos);
  CHECK(driver_fault([] { _exit(0); }).find("ended the process (status 0)") != std::string::npos);
}
