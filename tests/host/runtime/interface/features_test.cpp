/* Features beyond the 32nd: kernels compiled ahead of time, the reference in double, and OpenCL test their bits,
 * too. */
#include <cstddef>
#include <cstring>

#include "host/runtime/interface/kernel_list.h"
#include "host/runtime/opencl/program.h"
#include "minicl/reference_storage.h"
#include "shared/parameters.h"
#include "tests/catch.h"
#include "tests/host/runtime/opencl/opencl_device.h"

using namespace tandem;

namespace {

/* As features.def would give them, had it so many rows; one that would be mistaken for the other in 32 bits. */
enum { FEATURE_INDEX_NINTH = 8, FEATURE_INDEX_FORTY_FIRST = 40, FEATURE_INDEX_SIXTY_FOURTH = 63 };

static_assert(feature_of_index(FEATURE_INDEX_FORTY_FIRST) == 0x10000000000u);
static_assert(HAS_BIT(feature_of_index(FEATURE_INDEX_FORTY_FIRST), FEATURE_INDEX_FORTY_FIRST));
static_assert(!HAS_BIT(feature_of_index(FEATURE_INDEX_FORTY_FIRST), FEATURE_INDEX_NINTH));
static_assert(!HAS_BIT(feature_of_index(FEATURE_INDEX_NINTH), FEATURE_INDEX_FORTY_FIRST));
static_assert(with_needs(FEATURE_HULL | FEATURE_DAMPING) == (FEATURE_HULL | FEATURE_DAMPING | FEATURE_CONVEX));
static_assert(with_needs(FEATURE_DAMPING) == FEATURE_DAMPING);

bool has_forty_first(const Parameters *parameters) { return HAS_FEATURE(parameters, FORTY_FIRST); }
bool has_sixty_fourth(const Parameters *parameters) { return HAS_FEATURE(parameters, SIXTY_FOURTH); }
bool has_ninth(const Parameters *parameters) { return HAS_FEATURE(parameters, NINTH); }

/* shared/features.h as every program has it, then a kernel that writes what the tests say. */
EmbeddedProgram program_with_many_features()
{
  static const std::string source = opencl::headers_of(opencl::embedded_program("parallel")) + R"(
enum { FEATURE_INDEX_NINTH = 8, FEATURE_INDEX_FORTY_FIRST = 40, FEATURE_INDEX_SIXTY_FOURTH = 63 };
__kernel void many_features(__global uint *found)
{
  found[0] = HAS_FEATURE(parameters, NINTH) ? 1u : 0u;
  found[1] = HAS_FEATURE(parameters, FORTY_FIRST) ? 1u : 0u;
  found[2] = MAY_OCCUR(SIXTY_FOURTH) ? 1u : 0u;
}
)";
  return {"many_features", {source.c_str()}, {}};
}

std::vector<cl_uint> found_on_device(const opencl::DeviceContext &context, const std::string &mask)
{
  std::vector<cl_uint> found(3, 7);
  const cl::Program program = opencl::build_program(context, program_with_many_features(), "-D FEATURES=" + mask);
  cl::Kernel kernel(program, "many_features");
  cl::Buffer buffer(context.context, CL_MEM_READ_WRITE, found.size() * sizeof(cl_uint));
  kernel.setArg(0, buffer);
  context.queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(1), cl::NDRange(1));
  context.queue.enqueueReadBuffer(buffer, CL_TRUE, 0, found.size() * sizeof(cl_uint), found.data());
  return found;
}

} // namespace

TEST_CASE("features: a kernel that is compiled ahead sees each of 64 bits for itself")
{
  Parameters parameters{};
  parameters.features = feature_of_index(FEATURE_INDEX_FORTY_FIRST);
  CHECK(has_forty_first(&parameters));
  CHECK(!has_ninth(&parameters));
  CHECK(!has_sixty_fourth(&parameters));
  parameters.features = feature_of_index(FEATURE_INDEX_NINTH) | feature_of_index(FEATURE_INDEX_SIXTY_FOURTH);
  CHECK(!has_forty_first(&parameters));
  CHECK(has_ninth(&parameters));
  CHECK(has_sixty_fourth(&parameters));
}

TEST_CASE("features: parameters in double keep all 64 bits")
{
  Parameters parameters{}, back{};
  parameters.step = 0.25f;
  parameters.inverse_batch_cell = 3;
  parameters.features = 0xfedcba9876543210u;
  Storage &storage = minicl::reference_storage();
  void *handle = storage.allocate(Element::Parameters, sizeof parameters, nullptr);
  storage.write(handle, 0, &parameters, sizeof parameters);
  storage.read(handle, 0, &back, sizeof back);
  CHECK(back.features == parameters.features);
  CHECK(back.inverse_batch_cell == 3);
  constexpr size_t reals = offsetof(Parameters, sleep_steps) / sizeof(float),
                   wholes = offsetof(Parameters, features) - offsetof(Parameters, sleep_steps);
  Features wide = 0; /* where the kernels in double look for it */
  std::memcpy(&wide, static_cast<const char *>(handle) + reals * sizeof(double) + wholes, sizeof wide);
  CHECK(wide == parameters.features);
  storage.release(handle);
}

TEST_CASE("features: a kernel of an OpenCL device sees each of 64 bits for itself")
{
  const opencl::DeviceContext context(test_device());
  CHECK(found_on_device(context, "0x10000000000ul") == std::vector<cl_uint>{0, 1, 0});
  CHECK(found_on_device(context, "0x8000000000000100ul") == std::vector<cl_uint>{1, 0, 1});
  CHECK(found_on_device(context, "0x7ffffeffffffffff"
                                 "ul") == std::vector<cl_uint>{1, 0, 0});
}

TEST_CASE("features: a program is built anew for those alone that its text tests")
{
  const EmbeddedProgram program{"some",
                                {"#define MAY_OCCUR(name) 1\n",
                                 "uint f() { return HAS_FEATURE(scene->parameters, TREES) && MAY_OCCUR(HULL); }\n",
                                 "/* FILTER, CONVEX_HALF_SPACE */ uint g() { return HAS_FEATURE(p, CONVEX); }\n"},
                                {}};
  CHECK(opencl::features_read(program) == (FEATURE_TREES | FEATURE_HULL | FEATURE_CONVEX));
  CHECK((opencl::features_read(opencl::embedded_program("parallel")) & (FEATURE_HULL | FEATURE_ROUND)) == 0);
  const Features integrate = opencl::features_read(opencl::embedded_program("integrate"));
  CHECK((integrate & (FEATURE_GYROSCOPIC | FEATURE_DAMPING)) == (FEATURE_GYROSCOPIC | FEATURE_DAMPING));
}
