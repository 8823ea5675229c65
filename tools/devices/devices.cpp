/* devices.cpp - `tandem devices`: lists what can run kernels on this machine, and whether its results are exact. */
#include <memory>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <oneapi/tbb/info.h>

#include "host/runtime/opencl/device.h"
#include "minicl/kernel_table.h"
#include "tools/command/command.h"
#include "tools/command/output.h"

namespace tandem {
namespace {

std::vector<uint32_t> lane_widths()
{
  std::vector<uint32_t> widths;
  for (const uint32_t width : {1u, 4u, 8u, 16u})
    if (width == 1 || minicl::lanes_table(width)) widths.push_back(width);
  return widths;
}

std::string short_name(const opencl::DeviceInfo &device)
{
  return fmt::format("cl:{}.{}", device.platform, device.device);
}

std::string verdict(const opencl::DeviceInfo &device)
{
  if (!device.supported) return "refused: " + device.reason;
  return device.reason.empty() ? "exact" : "exact (" + device.reason + ")";
}

Json device_json(const opencl::DeviceInfo &device)
{
  return {{"name", short_name(device)},
          {"kind", "opencl"},
          {"platform", device.platform_name},
          {"platform_version", device.platform_version},
          {"device", device.device_name},
          {"driver", device.driver_version},
          {"type", device.type},
          {"exact", device.supported},
          {"note", device.reason}};
}

/* The devices of OpenCL, or the reason why there are none. */
struct Offer {
  std::vector<opencl::DeviceInfo> devices;
  std::string fault;
};

Offer opencl_offer()
{
  try {
    return {opencl::list_devices(), ""};
  } catch (const std::runtime_error &error) {
    return {{}, error.what()};
  }
}

Json devices_json(const Offer &offer)
{
  Json list = Json::array();
  list.push_back({{"name", "serial"}, {"kind", "cpu"}, {"threads", 1}, {"lanes", {1}}, {"exact", true}});
  list.push_back({{"name", "tbb"},
                  {"kind", "cpu"},
                  {"threads", tbb::info::default_concurrency()},
                  {"lanes", lane_widths()},
                  {"exact", true}});
  list.push_back({{"name", "reference"},
                  {"kind", "cpu"},
                  {"threads", tbb::info::default_concurrency()},
                  {"lanes", {1}},
                  {"exact", false},
                  {"note", "double precision"}});
  for (const opencl::DeviceInfo &device : offer.devices) list.push_back(device_json(device));
  return {{"backends", list}, {"opencl_fault", offer.fault.empty() ? Json(nullptr) : Json(offer.fault)}};
}

void print_devices(const Offer &offer)
{
  fmt::print("serial   one thread, one item at a time: what every other is compared with, and the one for gdb\n");
  fmt::print("reference  the same kernels in double: for measuring errors, never compared bit for bit\n");
  fmt::print("tbb      {} threads, {} lanes\n", tbb::info::default_concurrency(), fmt::join(lane_widths(), ", "));
  for (const opencl::DeviceInfo &device : offer.devices) {
    fmt::print("{:<8} {} {}\n", short_name(device), device.type, device.device_name);
    fmt::print("         {}, {}, driver {}\n", device.platform_name, device.platform_version, device.driver_version);
    fmt::print("         {}\n", verdict(device));
  }
  if (!offer.fault.empty()) fmt::print("No OpenCL device: {}\n", offer.fault);
  else if (offer.devices.empty())
    fmt::print("No OpenCL device: no platform is installed, or none has one. serial and tbb need none.\n");
}

} // namespace

Command devices_command(CLI::App &parser)
{
  CLI::App *command =
      parser.add_subcommand("devices", "list backends, with the exactness self-test of each OpenCL device");
  auto json = std::make_shared<JsonOutput>();
  command->add_option("--json", json->path, "write the list as JSON; - for standard output")->type_name("FILE");
  return {command, [json] {
            json->check();
            const Offer offer = opencl_offer();
            if (!json->takes_standard_output()) print_devices(offer);
            json->write(devices_json(offer));
            return 0;
          }};
}

} // namespace tandem
