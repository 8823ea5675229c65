/* The device that a text selects, and the message if it selects none. */
#include <fmt/format.h>

#include <tandem/scene.h>

#include "host/runtime/make_backend.h"
#include "host/runtime/opencl/program.h"
#include "tests/host/runtime/opencl/opencl_device.h"

using namespace tandem;

namespace {

std::string refusal_of(const std::string &text)
{
  try {
    make_backend(text);
  } catch (const InputError &error) {
    return error.what();
  }
  return "accepted";
}

/* The verdict of a self-test in which `from` reads `to` on the device: a stand-in for a device that errs so. */
std::string with_planted(const opencl::DeviceContext &context, const std::string &from, const std::string &to)
{
  std::string source = opencl::headers_of(opencl::embedded_program("self_test"));
  const size_t at = source.find(from);
  REQUIRE(at != std::string::npos);
  source.replace(at, from.size(), to);
  return opencl::self_test(context, 1024, EmbeddedProgram{"self_test", {source.c_str()}, {}});
}

} // namespace

TEST_CASE("every listed device has a verdict, and an address that opens it")
{
  const auto devices = opencl::list_devices();
  if (devices.empty()) tests::skip_device("no OpenCL device");
  for (const opencl::DeviceInfo &info : devices) {
    const std::string text = fmt::format("cl:{}.{}", info.platform, info.device);
    INFO(text << " " << info.device_name << ": " << info.reason);
    REQUIRE((info.supported || !info.reason.empty()));
    if (info.supported) REQUIRE(make_backend(text)->name() == text);
    else REQUIRE(refusal_of(text).find(info.reason) != std::string::npos);
  }
}

TEST_CASE("this program's own arithmetic is that of IEEE 754") { REQUIRE(opencl::host_self_test() == ""); }

TEST_CASE("the self-test names every operation that a device gets wrong")
{
  const opencl::Candidate &device = test_device();
  const opencl::DeviceContext context(device);
  REQUIRE(with_planted(context, "", "") == "");
  using Catch::Matchers::ContainsSubstring;
  CHECK_THAT(with_planted(context, "square_root(real x) { return", "square_root(real x) { return 1.0000001f *"),
             ContainsSubstring("square root") && !ContainsSubstring("division"));
  CHECK_THAT(with_planted(context, "a / b)", "a * (1.0f / b))"),
             ContainsSubstring("division") && !ContainsSubstring("square root"));
  CHECK_THAT(with_planted(context, ", a + b)", ", (fabs(a + b) < 1.17549435e-38f ? 0.0f : a + b))"),
             ContainsSubstring("addition") && !ContainsSubstring("subtraction"));
  CHECK_THAT(with_planted(context, ", a * b + c)", ", fma(a, b, c))"),
             ContainsSubstring("contraction of a * b + c") && !ContainsSubstring("contraction of a * b - c"));
  CHECK_THAT(with_planted(context, " atomic_max(", " atomic_min("), ContainsSubstring("integer atomics"));
  CHECK_THAT(with_planted(context, "= (ulong)p * q", "= (ulong)(p * q)"),
             ContainsSubstring("64-bit product") && !ContainsSubstring("32-bit"));
  CHECK_THAT(with_planted(context, "memory[TILE - 1u - i]", "memory[TILE - 1u - i / 2u]"),
             ContainsSubstring("local memory and barriers"));
}

TEST_CASE("devices are found by part of a name, in any case")
{
  const opencl::Candidate &device = test_device();
  const std::string platform = device.info.platform_name;
  REQUIRE(refusal_of("cl") == "accepted");
  REQUIRE(refusal_of("cl:" + platform.substr(1)) == "accepted");
  REQUIRE(refusal_of("cl:" + device.info.type) == "accepted");
  if (platform == "Portable Computing Language") {
    REQUIRE(refusal_of("cl:pocl") == "accepted");
    REQUIRE(refusal_of("cl:PORTABLE comp") == "accepted");
  }
}

TEST_CASE("an unknown device is refused in one line that lists what there is")
{
  const opencl::Candidate &device = test_device();
  for (const char *text : {"cl:no-such-device", "cl:99.0", "cl:0.99", "cl:0"}) {
    const std::string refusal = refusal_of(text);
    INFO(refusal);
    REQUIRE(refusal.find(std::string("backend '") + text + "'") == 0);
    REQUIRE(refusal.find(device.info.device_name) != std::string::npos);
    REQUIRE(refusal.find('\n') == std::string::npos);
  }
}
