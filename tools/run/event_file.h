/* event_file.h - writes the contact events of a run as JSON, step by step, because a pile has as many events in each
 * step as it has contacts. */
#pragma once

#include <cstdint>
#include <string>

#include <tandem/world.h>

#include "host/io/output_file.h"

namespace tandem {

class EventFile {
public:
  /* Throws InputError that names --events if the file cannot be written. */
  EventFile(const std::string &path, const std::string &scene, const World &world);

  void add_step(uint64_t step, World &world); /* the events of the step just made */
  void finish();                              /* InputError if the disk is full or fails */

private:
  OutputFile file_;
  bool first_ = true;
};

} // namespace tandem
