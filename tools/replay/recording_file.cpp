/* recording_file.cpp - see recording_file.h. */
#include "tools/replay/recording_file.h"

#include <cstring>
#include <vector>

#include "host/base/printable.h"
#include "host/io/input_file.h"

namespace tandem {

WorldRecording read_recording(const std::string &path, DistinctFiles &files)
{
  files.reads("the recording", path);
  const std::string text = read_file(path);
  std::vector<std::byte> bytes(text.size());
  if (!text.empty()) std::memcpy(bytes.data(), text.data(), text.size());
  return WorldRecording(std::move(bytes), printable(path));
}

} // namespace tandem
