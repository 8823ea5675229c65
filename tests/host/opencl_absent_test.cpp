/* Without any OpenCL platform: the ICD loader is pointed at an empty folder in a process of its own. */
#include <array>
#include <cstdio>
#include <string>

#include <sys/wait.h>

#include "tests/catch.h"

#ifdef TANDEM_COMMAND
TEST_CASE("without an OpenCL platform the refusal is one clear line and status 2")
{
  const std::string command =
      "OCL_ICD_VENDORS=/nonexistent OPENCL_VENDOR_PATH=/nonexistent " TANDEM_COMMAND " run box-grid:nx=1,ny=1,nz=1 --on cl --steps 1 2>&1";
  std::FILE *pipe = popen(command.c_str(), "r");
  REQUIRE(pipe);
  std::string output;
  std::array<char, 256> piece;
  while (std::fgets(piece.data(), piece.size(), pipe)) output += piece.data();
  const int status = pclose(pipe);
  INFO(output);
  REQUIRE(WEXITSTATUS(status) == 2);
  REQUIRE(output.find("no OpenCL platform is installed") != std::string::npos);
  REQUIRE(output.find('\n') == output.size() - 1);
}
#endif
