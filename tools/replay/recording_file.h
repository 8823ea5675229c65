/* recording_file.h - recordings as the files that a user names. */
#pragma once

#include <string>

#include <tandem/recording.h>

#include "tools/command/distinct_files.h"

namespace tandem {

inline bool names_recording(const std::string &path) { return path.ends_with(".tandem"); }

/* Throws InputError if the file is no whole recording, or an output. */
WorldRecording read_recording(const std::string &path, DistinctFiles &files);

} // namespace tandem
