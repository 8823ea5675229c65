/* convert.cpp - `tandem convert`: writes any scene in Tandem's own format, which is read back without loss. */
#include <memory>

#include <fmt/format.h>

#include <tandem/load_scene.h>

#include "host/io/input_file.h"
#include "tools/command/command.h"
#include "tools/command/distinct_files.h"
#include "tools/command/scene_options.h"

namespace tandem {
namespace {

struct ConvertOptions {
  std::string scene, file, coordinates = "maximal";
  bool outside_files = false;
};

Scene read_scene(const ConvertOptions &options, DistinctFiles &files)
{
  const FilesRead read;
  const Scene scene = load_scene(options.scene, options.outside_files ? OutsideFiles::allowed : OutsideFiles::refused,
                                 coordinates_of(options.coordinates));
  for (const std::string &path : read.paths) files.reads("the scene", path);
  for (const std::string &warning : warnings_of(scene, options.scene)) fmt::print(stderr, "tandem: {}\n", warning);
  return scene;
}

int convert(const ConvertOptions &options)
{
  DistinctFiles files;
  files.writes("FILE", options.file);
  const Scene scene = read_scene(options, files);
  write_scene_json(scene, options.file);
  fmt::print("{}: {} bodies, {} joints, {} shapes\n", options.file, scene.bodies.size(), scene.joints.size(),
             scene.shapes.size());
  return 0;
}

} // namespace

Command convert_command(CLI::App &parser)
{
  CLI::App *command = parser.add_subcommand("convert", "write a scene of any format as JSON");
  auto options = std::make_shared<ConvertOptions>();
  command->add_option("scene", options->scene, "a file or a built-in scene")->required()->type_name("SCENE");
  command->add_option("file", options->file, "where to write it")->required()->type_name("FILE");
  command->add_flag("--allow-outside-files", options->outside_files, "let the scene name files outside its own folder");
  add_coordinates_option(*command, options->coordinates);
  return {command, [options] { return convert(*options); }};
}

} // namespace tandem
