/* The widths and ranges of MiniCL, tested with the simplest kernel. */
#include "minicl/kernel_table.h"
#include "tests/catch.h"

TEST_CASE("the scalar table has every kernel but the stages of the host")
{
  for (size_t k = 0; k < tandem::kernel_count; ++k)
    CHECK((tandem::minicl::scalar_kernels.run[k] != nullptr) ==
          (tandem::row_of(tandem::kernel_at(k)).execution != tandem::Execution::host));
}
