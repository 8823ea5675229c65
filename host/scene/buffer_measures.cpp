/* buffer_measures.cpp - see buffer_measures.h. */
#include "host/scene/buffer_measures.h"

#include <algorithm>

#include "host/base/hash.h"
#include "host/scene/body_records.h"
#include "host/scene/specialise.h"
#include "shared/counts.h"
#include "shared/records.h"

namespace tandem {

void measure_contacts(Memory &memory, Statistics &statistics)
{
  const auto counts = memory.read<uint32_t>(Buffer::counts, COUNT_TOTAL);
  const uint32_t pairs = counts[COUNT_PAIRS], stride = counts[CAPACITY_PAIRS];
  statistics.pairs = pairs;
  statistics.manifolds = counts[COUNT_CONSTRAINTS];
  statistics.colors = counts[COUNT_COLORS];
  statistics.direct_islands = counts[COUNT_DIRECT_ISLANDS];
  statistics.direct_left = counts[COUNT_DIRECT_LEFT];
  statistics.direct_stalled = counts[COUNT_DIRECT_STALLED];
  const auto points = memory.read<uint32_t>(Buffer::manifold_count, pairs),
             colors = memory.read<uint32_t>(Buffer::pair_color, pairs);
  double sum = 0;
  for (uint32_t plane = 0; plane < counts[CAPACITY_POINTS]; ++plane) {
    const auto rows = memory.read<float4>(Buffer::manifold_points, pairs, size_t{plane} * stride);
    for (uint32_t i = 0; i < pairs; ++i) {
      if (points[i] <= plane || colors[i] == COLOR_INACTIVE) continue; /* triggers are not counted */
      const double depth = std::max(0.0, -static_cast<double>(rows[i].w));
      ++statistics.contacts;
      sum += depth;
      statistics.max_penetration = std::max(statistics.max_penetration, depth);
    }
  }
  if (statistics.contacts > 0) statistics.mean_penetration = sum / statistics.contacts;
}

double kinetic_energy(Memory &memory, const Scene &scene, const std::vector<uint32_t> &order)
{
  const std::vector<BodyState> states = download_bodies(memory, order);
  double energy = 0;
  for (size_t i = 0; i < states.size(); ++i) {
    const Body &body = scene.bodies[i];
    if (body.type != BodyType::dynamic) continue;
    const BodyState &s = states[i];
    const Vec3 inverse = inverse_inertia_of(scene, body);
    const double x = s.orientation[0], y = s.orientation[1], z = s.orientation[2], w = s.orientation[3];
    const double axes[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
                               {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
                               {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
    for (int k = 0; k < 3; ++k) {
      const double v = s.linear_velocity[k];
      const double spin =
          axes[k][0] * s.angular_velocity[0] + axes[k][1] * s.angular_velocity[1] + axes[k][2] * s.angular_velocity[2];
      energy += 0.5 * body.mass * v * v + (inverse[k] > 0 ? 0.5 * spin * spin / inverse[k] : 0.0);
    }
  }
  return energy;
}

uint64_t hash_buffers(Memory &memory, const std::vector<Buffer> &buffers, size_t items, uint64_t seed)
{
  for (Buffer buffer : buffers) {
    const BufferRow &info = row_of(buffer);
    const auto bytes = memory.read<char>(buffer, items * info.per_item * size_of(info.element));
    seed = hash_bytes(bytes.data(), bytes.size(), seed);
  }
  return seed;
}

} // namespace tandem
