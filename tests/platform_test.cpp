/* Widths and ranges of MiniCL on the simplest kernel. */
#include "tests/catch.h"

#include "minicl/kernel_table.h"

TEST_CASE("the scalar table has every kernel")
{
  for (auto run : tandem::minicl::scalar_kernels.run) REQUIRE(run != nullptr);
}
