/* distinct_files.cpp - compares files by identity and not by name; see distinct_files.h. */
#include "tools/command/distinct_files.h"

#include <fmt/format.h>

#include <tandem/scene.h>

#include "host/io/output_file.h"
#include "tools/command/output.h"

namespace tandem {

void DistinctFiles::reads(const std::string &name, const std::string &path)
{
  for (const Use &use : written_)
    if (is_same_file(path, use.path))
      throw InputError(fmt::format("{} {}: {} reads this file; write to another one", use.name, use.path, name));
  read_.push_back({name, path});
}

void DistinctFiles::writes(const std::string &option, const std::string &path)
{
  if (path.empty()) return;
  if (path == "-") throw InputError(fmt::format("{} -: a file is needed; standard output is for --json alone", option));
  if (is_same_file(path, "/dev/stdout")) /* otherwise printed text would be lost, or mixed into the file */
    throw InputError(fmt::format("{} {}: this is standard output, where the command prints; write to a file of its own",
                                 option, path));
  for (const Use &use : read_)
    if (is_same_file(path, use.path))
      throw InputError(fmt::format("{} {}: {} reads this file; write to another one", option, path, use.name));
  for (const Use &use : written_)
    if (is_same_file(path, use.path))
      throw InputError(
          fmt::format("{} {}: {} writes this file too; each output needs one of its own", option, path, use.name));
  check_writable(option, path);
  written_.push_back({option, path});
}

} // namespace tandem
