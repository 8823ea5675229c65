/* specialise.h - what a scene needs: features, the order of its bodies, and sizes.
 *
 * The second station of the pipeline: everything after it is built, allocated and launched from this,
 * so a scene pays for nothing that it does not need.
 */
#pragma once

#include <cstdint>
#include <vector>

#include <tandem/export.h>
#include <tandem/features.h>
#include <tandem/scene.h>

namespace tandem {

struct Settings;

/* How many bodies may be tested against all others, and how much larger than the median they must be. */
constexpr size_t most_large_bodies = 64;
constexpr float large_ratio = 4.0f;

struct Specialisation {
  Features features = 0; /* FEATURE_ bits */
  /* Body buffers hold scene body order[i] at index i: half-spaces come first, then the few bodies too large for a grid,
   * so that the small ones are one range; otherwise the scene's order. Those with continuous collision count as
   * large, as their bounds are. */
  std::vector<uint32_t> order;
  uint32_t unbounded = 0; /* half-spaces */
  uint32_t large = 0;     /* these and the large ones */
};

Specialisation specialise(const Scene &scene, const Settings &settings);

/* All that the shapes of a scene could need, for comparing builds: every feature set. */
Features all_features();

/* The median of bounding_radius over the bodies of finite size; 0 for none. */
float median_radius(const Scene &scene);

/* True for what has a place in its body and a kind of its own: neither sphere, box nor half-space, or not in the middle
 * of its body, or with continuous collision. */
bool is_general(const Scene &scene, const Body &body);

/* What body_flags call the shape: SHAPE_OTHER unless a row of shared/pairs.def names it, and it is as such a row takes
 * it, in the middle of its body and without continuous collision. */
uint32_t shape_code(const Scene &scene, const Body &body);

/* What a body or a child meets: see Body in scene.h. */
struct Filter {
  uint32_t group = 1, mask = 0xffffffffu;
};
Filter filter_of(const Body &body, const Child &child);
/* Of a compound: what any of its children meets. */
Filter filter_of(const Scene &scene, const Body &body);

/* Principal moments: the body's own, or from its shape and mass; 0 where it cannot turn. */
TANDEM_API Vec3 inverse_inertia_of(const Scene &scene, const Body &body);

} // namespace tandem
