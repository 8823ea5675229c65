/* trace.cpp - records launches and writes them as trace events; see trace.h. */
#include "tools/run/trace.h"

#include "host/runtime/interface/backend.h"
#include "tools/command/output.h"

namespace tandem {
namespace {

constexpr uint32_t step_track = 0, stage_track = 1, first_kernel_track = 2;

Json track_name(uint32_t track, const std::string &name)
{
  return {{"name", "thread_name"}, {"ph", "M"}, {"pid", 1}, {"tid", track}, {"args", {{"name", name}}}};
}

} // namespace

Trace::Trace(World &world) : world_(world), origin_(std::chrono::steady_clock::now())
{
  world_.set_observer([this](const Launch &launch) { record(launch); });
}

Trace::~Trace() { world_.set_observer(nullptr); }

double Trace::now() const
{
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - origin_).count();
}

uint32_t Trace::track_of(const std::string &backend)
{
  return tracks_.try_emplace(backend, first_kernel_track + static_cast<uint32_t>(tracks_.size())).first->second;
}

void Trace::begin_step()
{
  world_.finish();
  step_start_ = launch_start_ = now();
  stage_event_ = SIZE_MAX;
}

void Trace::record(const Launch &launch)
{
  Backend &backend = world_.backend_of(launch.kernel);
  backend.finish();
  const double end = now();
  const KernelRow &row = row_of(launch.kernel);
  events_.push_back(
      {row.name, name_of(row.stage), track_of(backend.name()), launch_start_, end - launch_start_, step_});
  if (stage_event_ != SIZE_MAX && events_[stage_event_].name == name_of(row.stage))
    events_[stage_event_].duration = end - events_[stage_event_].start;
  else {
    stage_event_ = events_.size();
    events_.push_back({name_of(row.stage), "stage", stage_track, launch_start_, end - launch_start_, step_});
  }
  launch_start_ = end;
}

void Trace::end_step(uint64_t step)
{
  world_.finish();
  events_.push_back({"step", "step", step_track, step_start_, now() - step_start_, step});
  step_ = step + 1;
}

std::string Trace::json() const
{
  Json list = Json::array({track_name(step_track, "steps"), track_name(stage_track, "stages")});
  for (const auto &[backend, track] : tracks_) list.push_back(track_name(track, "kernels on " + backend));
  for (const Event &event : events_)
    list.push_back({{"name", event.name},
                    {"cat", event.category},
                    {"ph", "X"},
                    {"pid", 1},
                    {"tid", event.track},
                    {"ts", event.start},
                    {"dur", event.duration},
                    {"args", {{"step", event.step}}}});
  return Json{{"displayTimeUnit", "ms"}, {"traceEvents", list}}.dump() + "\n";
}

} // namespace tandem
