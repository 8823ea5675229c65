/* Which device a text means, and what is said when it means none. */
#include "tests/host/opencl_device.h"

#include <fmt/format.h>

#include "host/scene.h"

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

} // namespace

TEST_CASE("every listed device has a verdict, and an address that opens it")
{
  const auto devices = opencl::list_devices();
  if (devices.empty()) {
    WARN("no OpenCL device: this test did not run");
    return;
  }
  for (const opencl::DeviceInfo &info : devices) {
    const std::string text = fmt::format("cl:{}.{}", info.platform, info.device);
    INFO(text << " " << info.device_name << ": " << info.reason);
    REQUIRE((info.supported || !info.reason.empty()));
    if (info.supported) REQUIRE(make_backend(text)->name() == text);
    else REQUIRE(refusal_of(text).find(info.reason) != std::string::npos);
  }
}

TEST_CASE("devices are found by part of a name, in any case")
{
  const opencl::Candidate *device = test_device();
  if (!device) return;
  const std::string platform = device->info.platform_name;
  REQUIRE(refusal_of("cl") == "accepted");
  REQUIRE(refusal_of("cl:" + platform.substr(1)) == "accepted");
  REQUIRE(refusal_of("cl:" + device->info.type) == "accepted");
  if (platform == "Portable Computing Language") {
    REQUIRE(refusal_of("cl:pocl") == "accepted");
    REQUIRE(refusal_of("cl:PORTABLE comp") == "accepted");
  }
}

TEST_CASE("an unknown device is refused in one line that lists what there is")
{
  const opencl::Candidate *device = test_device();
  if (!device) return;
  for (const char *text : {"cl:no-such-device", "cl:99.0", "cl:0.99", "cl:0"}) {
    const std::string refusal = refusal_of(text);
    INFO(refusal);
    REQUIRE(refusal.find(std::string("backend '") + text + "'") == 0);
    REQUIRE(refusal.find(device->info.device_name) != std::string::npos);
    REQUIRE(refusal.find('\n') == std::string::npos);
  }
}
