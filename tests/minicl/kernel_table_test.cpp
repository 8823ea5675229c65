/* The widths and ranges of MiniCL, tested with the simplest kernel. */
#include "minicl/kernel_table.h"
#include "tests/catch.h"

TEST_CASE("the tables of lanes have each kernel that runs in lanes, and those of trees where they are wide")
{
  using namespace tandem;
  for (const uint32_t lanes : {4u, 8u, 16u}) {
    if (lanes > minicl::widest_lanes()) continue;
    const minicl::KernelTable &table = *minicl::lanes_table(lanes);
    for (size_t k = 0; k < kernel_count; ++k) {
      const KernelRow &row = row_of(kernel_at(k));
      if (row.execution != Execution::lanes && row.execution != Execution::lanes_padded) continue;
      INFO(row.name << " in " << lanes << " lanes");
      if (row.stage != Stage::articulations) CHECK(table.run[k] != nullptr);
      else if (lanes >= 8) CHECK(table.run[k] != nullptr);
    }
    for (const Kernel kernel :
         {Kernel::follow_boxes, Kernel::follow_capsules, Kernel::follow_sphere_capsules, Kernel::follow_box_capsules})
      CHECK(table.run[index_of(kernel)] != nullptr);
    CHECK(table.run[index_of(Kernel::follow_convexes)] == nullptr);
  }
}

TEST_CASE("the scalar table has every kernel but the stages of the host")
{
  for (size_t k = 0; k < tandem::kernel_count; ++k)
    CHECK((tandem::minicl::scalar_kernels.run[k] != nullptr) ==
          (tandem::row_of(tandem::kernel_at(k)).execution != tandem::Execution::host));
}
