/* contact_events.cpp - see contact_events.h. The device lists pairs by its own body indices, in which large bodies come
 * first; the host converts them to those of the scene and sorts the events. */
#include "host/world/contact_events.h"

#include <algorithm>
#include <utility>

#include "shared/events/event_codes.h"
#include "shared/platform.h"

namespace tandem {
namespace {

static_assert(EVENT_BEGIN == static_cast<int>(ContactEvent::Kind::begin) &&
              EVENT_PERSIST == static_cast<int>(ContactEvent::Kind::persist) &&
              EVENT_END == static_cast<int>(ContactEvent::Kind::end));

/* Combines the records of one event in event_bodies and event_contact. */
ContactEvent event_of(const uint32_t *bodies, const float4 *contact, const Scene &scene,
                      const std::vector<uint32_t> &order)
{
  ContactEvent event{};
  event.kind = static_cast<ContactEvent::Kind>(bodies[0]);
  event.a = order[bodies[1]];
  event.b = order[bodies[2]];
  event.trigger = scene.bodies[event.a].trigger || scene.bodies[event.b].trigger;
  event.points = bodies[3];
  event.point = {double{contact[0].x} + contact[1].x, double{contact[0].y} + contact[1].y,
                 double{contact[0].z} + contact[1].z};
  event.impulse = contact[0].w;
  event.separation = contact[1].w;
  event.normal = {contact[2].x, contact[2].y, contact[2].z};
  event.approach_speed = contact[2].w;
  if (event.a > event.b) {
    std::swap(event.a, event.b);
    for (float &x : event.normal) x = 0.0f - x;
  }
  return event;
}

} // namespace

std::vector<ContactEvent> download_events(Memory &memory, const Scene &scene, const std::vector<uint32_t> &order)
{
  const uint32_t n = memory.read<uint32_t>(Buffer::counts, 1, COUNT_EVENTS).front();
  const auto bodies = memory.read<uint32_t>(Buffer::event_bodies, 4 * size_t{n});
  const auto contacts = memory.read<float4>(Buffer::event_contact, 3 * size_t{n});
  std::vector<std::pair<uint64_t, uint32_t>> places(
      n); /* the two bodies as one number, and the index: cheaper to sort than events */
  for (uint32_t i = 0; i < n; ++i) {
    const auto [low, high] = std::minmax(order[bodies[4 * size_t{i} + 1]], order[bodies[4 * size_t{i} + 2]]);
    places[i] = {uint64_t{low} << 32 | high, i};
  }
  std::sort(places.begin(), places.end());
  std::vector<ContactEvent> events;
  events.reserve(n);
  for (const auto &[pair, i] : places)
    events.push_back(event_of(&bodies[4 * size_t{i}], &contacts[3 * size_t{i}], scene, order));
  return events;
}

std::vector<HitEvent> hits_among(const std::vector<ContactEvent> &events, float hit_speed)
{
  std::vector<HitEvent> hits;
  for (const ContactEvent &event : events)
    if (event.kind == ContactEvent::Kind::begin && !event.trigger && event.approach_speed > hit_speed)
      hits.push_back({event.a, event.b, event.point, event.normal, event.approach_speed});
  return hits;
}

std::vector<uint32_t> download_moved_bodies(Memory &memory, const std::vector<uint32_t> &order)
{
  const uint32_t n = memory.read<uint32_t>(Buffer::counts, 1, COUNT_MOVED).front();
  std::vector<uint32_t> bodies = memory.read<uint32_t>(Buffer::moved_body, n);
  for (uint32_t &body : bodies) body = order[body];
  std::sort(bodies.begin(), bodies.end());
  return bodies;
}

std::vector<PairEvent> download_pair_events(Memory &memory, const std::vector<uint32_t> &order)
{
  const uint32_t n = memory.read<uint32_t>(Buffer::counts, 1, COUNT_PAIR_EVENTS).front();
  const auto records = memory.read<uint32_t>(Buffer::pair_event, 3 * size_t{n});
  std::vector<PairEvent> events(n);
  for (size_t i = 0; i < n; ++i) {
    const auto [low, high] = std::minmax(order[records[3 * i + 1]], order[records[3 * i + 2]]);
    events[i] = {static_cast<ContactEvent::Kind>(records[3 * i]), low, high};
  }
  std::sort(events.begin(), events.end(),
            [](const PairEvent &p, const PairEvent &q) { return std::pair(p.a, p.b) < std::pair(q.a, q.b); });
  return events;
}

const char *name_of(ContactEvent::Kind kind)
{
  static const char *const names[] = {"begin", "persist", "end"};
  return names[static_cast<size_t>(kind)];
}

} // namespace tandem
