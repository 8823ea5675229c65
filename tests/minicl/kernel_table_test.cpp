/* The widths and ranges of MiniCL, tested with the simplest kernel. */
#include "minicl/kernel_table.h"
#include "tests/catch.h"

TEST_CASE("the tables of lanes have the kernels of groups that take lists in lanes")
{
  using tandem::Kernel;
  for (const Kernel kernel :
       {Kernel::follow_boxes, Kernel::follow_capsules, Kernel::follow_sphere_capsules, Kernel::follow_box_capsules})
    CHECK(tandem::minicl::lanes4_kernels.run[tandem::index_of(kernel)] != nullptr);
  CHECK(tandem::minicl::lanes4_kernels.run[tandem::index_of(Kernel::follow_convexes)] == nullptr);
}

TEST_CASE("the scalar table has every kernel but the stages of the host")
{
  for (size_t k = 0; k < tandem::kernel_count; ++k)
    CHECK((tandem::minicl::scalar_kernels.run[k] != nullptr) ==
          (tandem::row_of(tandem::kernel_at(k)).execution != tandem::Execution::host));
}
