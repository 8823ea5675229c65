/* scenes.cpp - `tandem scenes`: lists the built-in scenes and their parameters. */
#include <memory>

#include <fmt/format.h>

#include "host/catalog/catalog.h"
#include "tools/command/command.h"
#include "tools/command/output.h"

namespace tandem {
namespace {

Json number_json(const SceneParameter &parameter, double value)
{
  return parameter.type == SceneParameter::Type::integer ? Json(static_cast<int64_t>(value)) : Json(value);
}

Json scenes_json()
{
  Json list = Json::array();
  for (const BuiltInScene &scene : built_in_scenes()) {
    Json parameters = Json::array();
    for (const SceneParameter &parameter : scene.parameters)
      parameters.push_back({{"name", parameter.name},
                            {"type", parameter.type == SceneParameter::Type::integer ? "integer" : "real"},
                            {"default", number_json(parameter, parameter.default_value)},
                            {"min", number_json(parameter, parameter.minimum)},
                            {"max", number_json(parameter, parameter.maximum)},
                            {"description", parameter.description}});
    list.push_back({{"name", scene.name}, {"description", scene.description}, {"parameters", parameters}});
  }
  return {{"scenes", list}};
}

void print_scenes()
{
  for (const BuiltInScene &scene : built_in_scenes()) {
    fmt::print("{} - {}\n", scene.name, scene.description);
    if (scene.parameters.empty()) continue;
    Table table({"parameter", "default", "range", "what"}, false);
    for (const SceneParameter &parameter : scene.parameters)
      table.add({parameter.name, fmt::format("{:.10g}", parameter.default_value),
                 fmt::format("{:.10g} to {:.10g}", parameter.minimum, parameter.maximum), parameter.description});
    fmt::print("{}\n", table.text("  "));
  }
  fmt::print("Use: tandem run NAME:parameter=value,parameter=value\n");
}

} // namespace

Command scenes_command(CLI::App &parser)
{
  CLI::App *command = parser.add_subcommand("scenes", "list the built-in scenes and their parameters");
  auto json = std::make_shared<JsonOutput>();
  command->add_option("--json", json->path, "write the list as JSON; - for standard output")->type_name("FILE");
  return {command, [json] {
            json->check();
            if (!json->takes_standard_output()) print_scenes();
            json->write(scenes_json());
            return 0;
          }};
}

} // namespace tandem
