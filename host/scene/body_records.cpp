/* body_records.cpp - reads and writes the records of single bodies; see body_records.h. */
#include "host/scene/body_records.h"

#include <algorithm>
#include <cmath>

#include <tandem/round_to_float.h>

#include "host/base/finite_vector.h"
#include "host/scene/body_buffers.h"

namespace tandem {
namespace {

Vec3 vec_of_float4(const float4 &r) { return {r.x, r.y, r.z}; }

Point point_of(const float4 *place)
{
  return {double{place[0].x} + double{place[1].x}, double{place[0].y} + double{place[1].y},
          double{place[0].z} + double{place[1].z}};
}

/* Writes all but the flags. Everything that can fail for lack of memory comes before the first change. */
void write_state(Memory &memory, uint32_t index, const BodyRecord &record)
{
  for (const Buffer buffer : {Buffer::body_position, Buffer::body_orientation, Buffer::body_velocity})
    memory.prepare_upload(buffer);
  memory.upload(Buffer::body_position, record.position.data(), 2 * sizeof(float4), 2 * size_t{index} * sizeof(float4));
  memory.upload(Buffer::body_orientation, &record.orientation, sizeof(float4), size_t{index} * sizeof(float4));
  memory.upload(Buffer::body_velocity, record.velocity.data(), 2 * sizeof(float4), 2 * size_t{index} * sizeof(float4));
}

} // namespace

BodyRecord read_body(Memory &memory, uint32_t index)
{
  const auto position = memory.read<float4>(Buffer::body_position, 2, 2 * size_t{index}),
             velocity = memory.read<float4>(Buffer::body_velocity, 2, 2 * size_t{index});
  const float4 orientation = memory.read<float4>(Buffer::body_orientation, 1, index).front();
  return {{position[0], position[1]},
          orientation,
          {velocity[0], velocity[1]},
          memory.read<uint32_t>(Buffer::body_flags, 1, index).front()};
}

void write_body(Memory &memory, uint32_t index, const BodyRecord &record)
{
  memory.prepare_upload(Buffer::body_flags);
  write_state(memory, index, record);
  memory.upload(Buffer::body_flags, &record.flags, sizeof record.flags, size_t{index} * sizeof record.flags);
}

void upload_body(Memory &memory, uint32_t index, const BodyState &state)
{
  const Quat q = unit(state.orientation);
  const auto place = double_float3_of(state.position);
  const float4 orientation{q[0], q[1], q[2], q[3]};
  const auto velocity = memory.read<float4>(Buffer::body_velocity, 2, 2 * size_t{index});
  const float4 linear = float4_of_vec(state.linear_velocity, velocity[0].w),
               angular = float4_of_vec(state.angular_velocity, velocity[1].w);
  write_state(memory, index, {place, orientation, {linear, angular}, 0});
}

namespace {

BodyState state_of(const float4 *position, const float4 &orientation, const float4 *velocity)
{
  return {point_of(position),
          {orientation.x, orientation.y, orientation.z, orientation.w},
          vec_of_float4(velocity[0]),
          vec_of_float4(velocity[1])};
}

} // namespace

BodyState download_body(Memory &memory, uint32_t index)
{
  const BodyRecord record = read_body(memory, index);
  return state_of(record.position.data(), record.orientation, record.velocity.data());
}

std::vector<BodyState> download_bodies(Memory &memory, const std::vector<uint32_t> &order)
{
  const size_t n = order.size();
  const auto position = memory.read<float4>(Buffer::body_position, 2 * n),
             orientation = memory.read<float4>(Buffer::body_orientation, n);
  const auto velocity = memory.read<float4>(Buffer::body_velocity, 2 * n);
  std::vector<BodyState> states(n);
  for (size_t i = 0; i < n; ++i) states[order[i]] = state_of(&position[2 * i], orientation[i], &velocity[2 * i]);
  return states;
}

std::vector<PreciseBodyState> download_precise_bodies(Memory &memory, const std::vector<uint32_t> &order)
{
  const size_t n = order.size();
  const auto position = memory.read_reals(Buffer::body_position, 8 * n),
             orientation = memory.read_reals(Buffer::body_orientation, 4 * n);
  const auto velocity = memory.read_reals(Buffer::body_velocity, 8 * n);
  std::vector<PreciseBodyState> states(n);
  for (size_t i = 0; i < n; ++i) {
    PreciseBodyState &state = states[order[i]];
    for (size_t k = 0; k < 3; ++k) state.position[k] = position[8 * i + k] + position[8 * i + 4 + k];
    std::copy_n(&orientation[4 * i], 4, state.orientation.begin());
    std::copy_n(&velocity[8 * i], 3, state.linear_velocity.begin());
    std::copy_n(&velocity[8 * i + 4], 3, state.angular_velocity.begin());
  }
  return states;
}

bool is_finite(const BodyState &state)
{
  const auto finite = [](const auto &values) {
    return std::all_of(values.begin(), values.end(), [](auto x) { return std::isfinite(round_to_float(double{x})); });
  };
  return finite(state.position) && finite(state.orientation) && finite(state.linear_velocity) &&
         finite(state.angular_velocity);
}

void quarantine_body(Memory &memory, uint32_t index)
{
  BodyRecord record = read_body(memory, index);
  for (const double x : point_of(record.position.data()))
    if (!std::isfinite(x)) record.position = {};
  record.orientation = {0, 0, 0, 1};
  record.velocity = {};
  record.flags = as_absent(record.flags);
  write_body(memory, index, record);
}

std::vector<uint32_t> bodies_not_finite(Memory &memory, uint32_t bodies)
{
  std::vector<bool> bad(bodies);
  for (const auto &[buffer, rows] :
       {std::pair(Buffer::body_position, 2u), std::pair(Buffer::body_orientation, 1u),
        std::pair(Buffer::body_velocity, 2u), std::pair(Buffer::solver_velocity, 2u),
        std::pair(Buffer::solver_delta_pose, 2u), std::pair(Buffer::solver_orientation, 1u)}) {
    const std::vector<float4> values = memory.read<float4>(buffer, size_t{bodies} * rows);
    for (size_t i = 0; i < values.size(); ++i)
      if (!is_finite_vector(std::array{values[i].x, values[i].y, values[i].z, values[i].w})) bad[i / rows] = true;
  }
  std::vector<uint32_t> indices;
  for (uint32_t body = 0; body < bodies; ++body)
    if (bad[body]) indices.push_back(body);
  return indices;
}

} // namespace tandem
