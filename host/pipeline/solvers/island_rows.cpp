/* island_rows.cpp - reads what has changed, and writes back; see island_rows.h. */
#include "host/pipeline/solvers/island_rows.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace tandem {
namespace {

using in_double::float4;
using in_double::Parameters;

/* Room for so many, or for twice as many as before, so that bodies that come one by one allocate seldom. */
template <class T> void grow_to(std::vector<T> &list, size_t count)
{
  if (list.capacity() < count) list.reserve(std::max(count, 2 * list.capacity()));
}

void read_indices(Memory &memory, Buffer buffer, size_t count, std::vector<uint32_t> &indices)
{
  indices.resize(count);
  memory.download(buffer, indices.data(), count * sizeof(uint32_t));
}

void write_rows(Memory &memory, Buffer buffer, const float4 *rows, size_t count, size_t first = 0)
{
  memory.write_reals(buffer, reinterpret_cast<const double *>(rows), 4 * count, 4 * first);
}

Parameters read_parameters(Memory &memory)
{
  Parameters parameters{};
  constexpr size_t wholes_begin = offsetof(Parameters, sleep_steps);
  std::array<double, wholes_begin / sizeof(double)> reals{};
  memory.read_reals(Buffer::parameters, reals.data(), reals.size());
  std::memcpy(&parameters, reals.data(), sizeof reals);
  memory.download(Buffer::parameters, &parameters.sleep_steps, sizeof parameters - wholes_begin,
                  reals.size() * sizeof(float));
  return parameters;
}

/* Where the rows lie depends on these. */
bool same_layout(const std::array<uint32_t, COUNT_TOTAL> &one, const std::array<uint32_t, COUNT_TOTAL> &other)
{
  constexpr int entries[] = {COUNT_CONSTRAINTS, CAPACITY_PAIRS, CAPACITY_POINTS, COUNT_BODIES};
  return std::all_of(std::begin(entries), std::end(entries), [&](int entry) { return one[entry] == other[entry]; });
}

} // namespace

/* Planes are CAPACITY_PAIRS apart on the device and `count` apart here. */
void IslandRows::read_planes(Memory &memory, Buffer buffer, size_t planes, std::vector<float4> &rows)
{
  rows.resize(planes * count);
  memory.read_real_planes(buffer, reinterpret_cast<double *>(rows.data()), 4 * size_t{count}, planes,
                          4 * size_t{stride});
}

void IslandRows::read_changed(Memory &memory, Buffer buffer, size_t planes, std::vector<float4> &rows)
{
  if (changed_.take(memory, buffer)) read_planes(memory, buffer, planes, rows);
}

void IslandRows::read_bodies(Memory &memory, Buffer buffer, size_t planes, std::vector<float4> &rows)
{
  if (!changed_.take(memory, buffer)) return;
  rows.resize(planes * counts_[COUNT_BODIES]);
  memory.read_reals(buffer, reinterpret_cast<double *>(rows.data()), 4 * rows.size());
}

/* Points without a plane are zeros (shared/point_rows.h). */
void IslandRows::read_points(Memory &memory)
{
  const size_t planes = in_double::POINT_NUMBERS * size_t{counts_[CAPACITY_POINTS]};
  points.resize(planes * count);
  memory.read_real_planes(Buffer::constraint_points, points.data(), count, planes, stride);
  points.resize(4 * in_double::POINT_NUMBERS * size_t{count});
}

void IslandRows::read_counts(Memory &memory)
{
  if (!changed_.take(memory, Buffer::counts)) return;
  const auto before = counts_;
  memory.download(Buffer::counts, counts_.data(), sizeof counts_);
  count = counts_[COUNT_CONSTRAINTS];
  stride = counts_[CAPACITY_PAIRS];
  if (same_layout(before, counts_)) return;
  changed_.forget_all();
  changed_.take(memory, Buffer::counts);
  make_room();
}

/* For whole planes, so that only a launch with larger buffers allocates. */
void IslandRows::make_room()
{
  for (std::vector<uint32_t> *list : {&a, &b}) grow_to(*list, stride);
  for (std::vector<float4> *rows : {&normal, &center, &offset, &normal_impulse, &friction_impulse})
    grow_to(*rows, stride);
  grow_to(restitution, 2 * size_t{stride});
  grow_to(points, 4 * in_double::POINT_NUMBERS * size_t{stride});
  grow_to(slop, stride);
  for (std::vector<float4> *rows : {&velocity, &inertia, &delta, &orientation})
    grow_to(*rows, 2 * size_t{counts_[COUNT_BODIES]});
}

bool IslandRows::read_graph(Memory &memory)
{
  read_counts(memory);
  if (changed_.take(memory, Buffer::parameters)) parameters = read_parameters(memory);
  bool is_new = tables.read_graph(memory, changed_, parameters, counts_.data());
  if (edges() == 0) return false;
  for (const Buffer buffer : {Buffer::constraint_a, Buffer::constraint_b, Buffer::constraint_points})
    is_new |= changed_.take(memory, buffer);
  if (!is_new) return false;
  if (count > 0) {
    read_indices(memory, Buffer::constraint_a, count, a);
    read_indices(memory, Buffer::constraint_b, count, b);
    read_points(memory);
  }
  read_bodies(memory, Buffer::solver_velocity, 2, velocity);
  return true;
}

void IslandRows::read_rest(Memory &memory)
{
  if (count > 0) read_contacts(memory);
  read_bodies(memory, Buffer::solver_velocity, 2, velocity);
  if (has_tensors()) read_bodies(memory, Buffer::solver_inertia, 2, inertia);
  read_bodies(memory, Buffer::solver_delta_pose, 2, delta);
  if (has_joints()) read_bodies(memory, Buffer::solver_orientation, 1, orientation);
  tables.read_rest(memory, changed_);
}

void IslandRows::read_contacts(Memory &memory)
{
  read_changed(memory, Buffer::constraint_normal, 1, normal);
  read_changed(memory, Buffer::constraint_center, 1, center);
  read_changed(memory, Buffer::constraint_offset, 1, offset);
  read_changed(memory, Buffer::constraint_normal_impulse, 1, normal_impulse);
  if (rubs()) read_changed(memory, Buffer::constraint_friction_impulse, 1, friction_impulse);
  else friction_impulse.assign(count, float4{}); /* there are no rows: shared/friction_rows.h */
  if (changed_.take(memory, Buffer::constraint_slop)) {
    slop.resize(count);
    memory.read_reals(Buffer::constraint_slop, slop.data(), count);
  }
  if (bounces()) read_changed(memory, Buffer::constraint_restitution, 2, restitution);
}

/* What is written is rounded to the numbers of the device, so that it has to be read again. */
void IslandRows::write(Memory &memory)
{
  if (count > 0) write_contacts(memory);
  write_rows(memory, Buffer::solver_velocity, velocity.data(), velocity.size());
  changed_.forget(Buffer::solver_velocity);
  tables.write(memory, changed_);
}

void IslandRows::write_contacts(Memory &memory)
{
  write_rows(memory, Buffer::constraint_normal_impulse, normal_impulse.data(), count);
  if (rubs()) write_rows(memory, Buffer::constraint_friction_impulse, friction_impulse.data(), count);
  if (bounces()) write_rows(memory, Buffer::constraint_restitution, restitution.data() + count, count, stride);
  for (const Buffer buffer :
       {Buffer::constraint_normal_impulse, Buffer::constraint_friction_impulse, Buffer::constraint_restitution})
    changed_.forget(buffer);
}

void IslandRows::write_outcomes(Memory &memory, const Outcomes &outcomes)
{
  static_assert(COUNT_DIRECT_LEFT == COUNT_DIRECT_ISLANDS + 1 && COUNT_DIRECT_STALLED == COUNT_DIRECT_ISLANDS + 2);
  const auto known = counts_.begin() + COUNT_DIRECT_ISLANDS;
  if (std::equal(outcomes.begin(), outcomes.end(), known)) return;
  std::copy(outcomes.begin(), outcomes.end(), known);
  memory.upload(Buffer::counts, outcomes.data(), sizeof outcomes, COUNT_DIRECT_ISLANDS * sizeof(uint32_t));
  changed_.take(memory, Buffer::counts);
}

IslandRows::vec3 IslandRows::free_part(uint32_t body, const vec3 &v) const
{
  return in_double::without_locked_axes(v, in_double::to_uint(locks(body)));
}

IslandRows::vec3 IslandRows::turned_by(uint32_t body, const vec3 &angular_impulse) const
{
  const in_double::spatial_velocity m = in_double::load_velocity(velocity.data(), body);
  return symmetric_times(load_inertia(&parameters, inertia.data(), body, m), angular_impulse);
}

IslandRows::Ends IslandRows::ends(uint32_t edge) const
{
  if (is_contact(edge)) return {a[edge], b[edge], INDEX_NONE, INDEX_NONE};
  constexpr Ends none = {INDEX_NONE, INDEX_NONE, INDEX_NONE, INDEX_NONE};
  if (is_joint(edge)) {
    const uint32_t joint = joint_of(edge);
    return tables.rows[joint] > 0 ? Ends{tables.a[joint], tables.b[joint], INDEX_NONE, INDEX_NONE} : none;
  }
  const uint32_t one = tables.coupling_a[coupling_of(edge)], other = tables.coupling_b[coupling_of(edge)];
  if (one == INDEX_NONE || other == INDEX_NONE) return none;
  return {tables.a[one], tables.b[one], tables.a[other], tables.b[other]};
}

uint32_t IslandRows::size_of(uint32_t edge) const
{
  if (is_contact(edge)) return points_of(edge);
  return is_joint(edge) ? (tables.rows[joint_of(edge)] + 3) / 4 : 1;
}

uint32_t IslandRows::points_of(uint32_t constraint) const
{
  uint32_t found = 0;
  for (uint32_t k = 0; k < 4; ++k) found += of_point(constraint, k, in_double::POINT_MASS) > 0;
  return found;
}

} // namespace tandem
