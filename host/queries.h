/* queries.h - what a World can be asked between two steps: rays and sweeps, by the batch; see World::cast_rays, World::sweep.
 *
 * Each query finds the nearest body alone; of bodies hit at one place that of the lower index. A query and a body must accept each
 * other's groups, as two bodies must. Quarantined bodies are not found.
 */
#pragma once

#include <span>
#include <vector>

#include "host/launcher.h"
#include "host/scene.h"

namespace tandem {

struct QueryFilter {
  uint32_t group = 0xffffffffu; /* bit set of the groups the query is in */
  uint32_t mask = 0xffffffffu;  /* groups it finds */
};

struct Ray {
  Point origin{0, 0, 0};
  Vec3 direction{0, 0, 0}; /* of any length; hits are given as fractions of it */
  float reach = 1;         /* the largest fraction looked at, >= 0; infinity: without an end */
  QueryFilter filter;
};

struct Pose {
  Point position{0, 0, 0};
  Quat orientation{0, 0, 0, 1};
};

constexpr uint32_t no_body = 0xffffffffu;

struct QueryHit {
  uint32_t body = no_body; /* index into Scene::bodies; the rest is 0 where nothing is hit */
  float fraction = 0;      /* of the direction or displacement */
  Point point{0, 0, 0};    /* of the body's surface; where the query starts inside of a body: its start */
  Vec3 normal{0, 0, 0};    /* of the body's surface there, unit, outward; from the inside against the direction (a sweep of length 0 then has none) */
};

using RayHit = QueryHit;
using SweepHit = QueryHit;

/* InputError with the index of the first query that is not finite, has no direction, or a negative reach. */
void check_rays(std::span<const Ray> rays);
/* Also for half-spaces, which cannot be swept, for shapes that no scene could hold, and for lists of two lengths. */
void check_sweep(const Shape &shape, std::span<const Pose> poses, std::span<const Vec3> displacements);

/* order: body order[i] of the scene stands at i in the body buffers. The launcher's backends must know the kernel. */
std::vector<RayHit> cast_rays(Memory &memory, Launcher &launcher, const Scene &scene, const std::vector<uint32_t> &order, std::span<const Ray> rays);
std::vector<SweepHit> sweep(Memory &memory, Launcher &launcher, const Scene &scene, const std::vector<uint32_t> &order, const Shape &shape,
                            std::span<const Pose> poses, std::span<const Vec3> displacements, const QueryFilter &filter);

} // namespace tandem
