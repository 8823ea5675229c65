/* The absence of any OpenCL platform: the ICD loader searches an empty folder, in a process of its own. */
#ifdef TANDEM_COMMAND
#include "tests/tools/command/command_line.h"

TEST_CASE("without an OpenCL platform the refusal is one clear line and status 2")
{
  command_line::check_refused("run box-grid:nx=1,ny=1,nz=1 --on cl --steps 1", "no OpenCL platform is installed",
                              "OCL_ICD_VENDORS=/nonexistent OPENCL_VENDOR_PATH=/nonexistent");
}
#endif
