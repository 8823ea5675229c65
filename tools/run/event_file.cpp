/* event_file.cpp - see event_file.h. Each event is on a line of its own, so that other tools can read the file line by
 * line. */
#include "tools/run/event_file.h"

#include <fmt/format.h>

#include "tools/command/output.h"

namespace tandem {
namespace {

template <class Vector> std::string text(const Vector &v) { return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]); }

std::string line_of(uint64_t step, const ContactEvent &event)
{
  std::string line = fmt::format(R"({{"step": {}, "kind": "{}", "a": {}, "b": {}, "trigger": {})", step,
                                 name_of(event.kind), event.a, event.b, event.trigger);
  if (event.kind == ContactEvent::Kind::end) return line + "}";
  return line + fmt::format(R"(, "points": {}, "impulse": {}, "separation": {}, "point": {}, "normal": {}}})",
                            event.points, event.impulse, event.separation, text(event.point), text(event.normal));
}

std::string json_quoted(const std::string &text)
{
  return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

} // namespace

/* Names are written one by one, because a Json list would allocate in its destructor; without memory the process would
 * end there, with the file half written. */
EventFile::EventFile(const std::string &path, const std::string &scene, const World &world)
    : file_(path, fmt::format("--events {}", path))
{
  file_.write(fmt::format("{{\"scene\": {}, \"dt\": {}, \"bodies\": [", json_quoted(scene), world.settings().step));
  const char *separator = "";
  for (const Body &body : world.scene().bodies) {
    file_.write(separator + json_quoted(body.name));
    separator = ",";
  }
  file_.write("], \"events\": [");
}

void EventFile::add_step(uint64_t step, World &world)
{
  for (const ContactEvent &event : world.contact_events()) {
    file_.write((first_ ? "\n" : ",\n") + line_of(step, event));
    first_ = false;
  }
}

void EventFile::finish()
{
  file_.write("\n]}\n");
  file_.commit();
}

} // namespace tandem
