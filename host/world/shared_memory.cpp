/* shared_memory.cpp - see shared_memory.h. Buffers that must have memory of their own come first. Each of the
 * others takes the smallest memory that is free while it matters, or has its own, too. They choose in two orders, large
 * ones or those that matter for long before others; the one that saves more holds. */
#include "host/world/shared_memory.h"

#include <algorithm>
#include <iterator>

#include "host/world/carried.h"

namespace tandem {
namespace {

/* What the host reads after any step: statistics, events, quarantine, sleepers. These keep their contents. Others are
 * kept only for who asks for them (World::keep_after_steps). */
constexpr Buffer read_after_steps[] = {
    Buffer::pair_b,
    Buffer::pair_color,
    Buffer::manifold_count,
    Buffer::manifold_points,
    Buffer::constraint_pair,
    Buffer::constraint_a,
    Buffer::constraint_b,
    Buffer::constraint_normal,
    Buffer::constraint_points,
    Buffer::constraint_normal_impulse,
    Buffer::constraint_friction_impulse,
    Buffer::constraint_restitution,
    Buffer::solver_velocity,
    Buffer::solver_delta_pose,
    Buffer::solver_orientation,
    Buffer::touched_sleeper,
    Buffer::island_label,
    Buffer::falls_asleep,
    Buffer::body_failed,
    Buffer::pair_event,
    Buffer::event_bodies,
    Buffer::event_contact,
    Buffer::moved_body,
};

bool is_read_after_steps(Buffer buffer)
{
  return std::find(std::begin(read_after_steps), std::end(read_after_steps), buffer) != std::end(read_after_steps);
}

/* The others are small, or of no step. */
bool grows_with_scene(Capacity capacity)
{
  constexpr Capacity growing[] = {Capacity::BODIES,        Capacity::BODIES_PLUS_ONE,
                                  Capacity::PAIRS,         Capacity::PAIRS_PLUS_ONE,
                                  Capacity::EVENTS,        Capacity::CELLS,
                                  Capacity::SORTABLE,      Capacity::CANDIDATE_PAIRS,
                                  Capacity::TREE_CONTACTS, Capacity::TREE_CONTACT_FREEDOMS};
  return std::find(std::begin(growing), std::end(growing), capacity) != std::end(growing);
}

struct Room {
  Buffer buffer;
  size_t bytes;
  Span span;
  bool may_move; /* into the memory of another */
};

void add_scratch(std::vector<Room> &rooms, const StepSpans &spans, const Memory &memory, const std::vector<bool> &apart)
{
  for (size_t i = 0; i < buffer_count; ++i) {
    const Buffer buffer = buffer_at(i);
    const BufferRow &row = row_of(buffer);
    const bool matters = !spans.of[i].is_empty() && memory.bytes(buffer) > 0;
    if (!matters || row.lifetime != Lifetime::SCRATCH || !grows_with_scene(row.capacity)) continue;
    if (apart[i] || spans.between_steps[i]) continue;
    const bool is_read = is_read_after_steps(buffer);
    rooms.push_back(
        {buffer, memory.bytes(buffer), {spans.of[i].first, is_read ? Span::never : spans.of[i].last}, !is_read});
  }
}

/* Where bodies may sleep, both sides have the rows of those that do, and launches between steps move them. Rows of
 * pairs pass through the side that the commit will write, which then changes places with the other. */
bool is_idle_till_commit(Buffer buffer, const StepSpans &spans)
{
  const BufferRow &row = row_of(buffer);
  if (index_of(buffer) >= buffer_count || !grows_with_scene(row.capacity)) return false;
  return row.capacity == Capacity::PAIRS || !spans.between_steps[index_of(buffer)];
}

/* The sides that the commit will write. */
void add_idle_sides(std::vector<Room> &rooms, const StepSpans &spans, const Memory &memory)
{
  for (const CarriedBuffer &carried : carried_buffers()) {
    const size_t bytes = memory.bytes(carried.previous);
    if (bytes == 0 || !is_idle_till_commit(carried.previous, spans)) continue;
    const uint32_t first = std::min(spans.of[index_of(carried.previous)].first, spans.first_of_commit);
    rooms.push_back({carried.previous, bytes, {first, Span::never}, false});
  }
}

uint32_t launches_of(const Room &room) { return room.span.last - room.span.first; }

bool is_larger(const Room &a, const Room &b) { return a.bytes > b.bytes; }

/* What matters for long finds a place only while few have chosen. */
bool matters_longer(const Room &a, const Room &b)
{
  return launches_of(a) != launches_of(b) ? launches_of(a) > launches_of(b) : a.bytes > b.bytes;
}

/* Those that must have memory of their own, then the others in the order in which they choose. */
std::vector<Room> rooms_of(const StepSpans &spans, const Memory &memory, const std::vector<bool> &apart,
                           bool (*chooses_before)(const Room &, const Room &))
{
  std::vector<Room> rooms;
  add_scratch(rooms, spans, memory, apart);
  add_idle_sides(rooms, spans, memory);
  std::stable_sort(rooms.begin(), rooms.end(), [&](const Room &a, const Room &b) {
    return a.may_move != b.may_move ? b.may_move : chooses_before(a, b);
  });
  return rooms;
}

/* A buffer with memory of its own, and when anyone uses that. */
struct Landlord {
  Buffer buffer;
  size_t bytes;
  std::vector<Span> taken;

  bool has_room_for(const Room &room) const
  {
    return room.bytes <= bytes &&
           std::none_of(taken.begin(), taken.end(), [&](const Span &other) { return other.overlaps(room.span); });
  }
};

/* The smallest memory that is large enough and free, or none. */
Landlord *landlord_for(const Room &room, std::vector<Landlord> &landlords)
{
  Landlord *best = nullptr;
  for (Landlord &landlord : landlords)
    if (landlord.has_room_for(room) && (!best || landlord.bytes < best->bytes)) best = &landlord;
  return best;
}

struct Placed {
  std::vector<Tenancy> tenancies;
  size_t saved = 0; /* bytes */
};

Placed placed_in_turn(const std::vector<Room> &rooms)
{
  Placed placed;
  std::vector<Landlord> landlords;
  for (const Room &room : rooms) {
    Landlord *const landlord = room.may_move ? landlord_for(room, landlords) : nullptr;
    if (landlord) {
      placed.tenancies.push_back({room.buffer, landlord->buffer});
      placed.saved += room.bytes;
      landlord->taken.push_back(room.span);
    } else landlords.push_back({room.buffer, room.bytes, {room.span}});
  }
  return placed;
}

} // namespace

std::vector<Tenancy> tenancies_of(const StepSpans &spans, const Memory &memory, const std::vector<bool> &apart)
{
  Placed by_size = placed_in_turn(rooms_of(spans, memory, apart, is_larger)),
         by_span = placed_in_turn(rooms_of(spans, memory, apart, matters_longer));
  return std::move(by_span.saved > by_size.saved ? by_span : by_size).tenancies;
}

} // namespace tandem
