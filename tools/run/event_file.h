/* event_file.h - the contact events of a run as JSON, written step by step: a pile has as many in each step as it has
 * contacts. */
#pragma once

#include <cstdint>
#include <string>

#include <tandem/world.h>

#include "host/io/output_file.h"

namespace tandem {

class EventFile {
public:
  /* InputError names --events where the file cannot be written. */
  EventFile(const std::string &path, const std::string &scene, const World &world);

  void add_step(uint64_t step, World &world); /* the events of the step just made */
  void finish();                              /* InputError where the disk did not take it all */

private:
  OutputFile file_;
  bool first_ = true;
};

} // namespace tandem
