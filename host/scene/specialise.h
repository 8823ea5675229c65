/* specialise.h - derives what a scene needs: features, the order of its bodies, and sizes.
 *
 * It is the second stage of the pipeline. Everything after it is built, allocated and launched according to its result,
 * so that a scene does not pay for what it does not need.
 */
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include <tandem/export.h>
#include <tandem/features.h>
#include <tandem/scene.h>

namespace tandem {

struct Settings;

/* The number of bodies that may be tested against all others, and how many times larger than the median they must
 * be. */
constexpr size_t most_large_bodies = 64;
constexpr float large_ratio = 4.0f;

struct Specialisation {
  Features features = 0; /* FEATURE_ bits */
  /* Body buffers hold scene body order[i] at index i. Half-spaces come first, then the few bodies that are too large
   * for a grid, so that the small ones are one contiguous range; otherwise the scene's order is kept. Bodies with
   * continuous collision count as large, because their bounds are large. */
  std::vector<uint32_t> order;
  uint32_t unbounded = 0; /* half-spaces */
  uint32_t large = 0;     /* half-spaces and large bodies */
  uint32_t awake = 0;     /* all bodies but those that sleep, which come last */
  float median = 0;       /* m, of the bounding radii; it decides which bodies are large */
  uint32_t worlds = 0;    /* of a batch (tandem/worlds.h), each of as many bodies; 0: a world alone */
};

Specialisation specialise(const Scene &scene, const Settings &settings);

/* For a batch of so many worlds, whose bodies stand in the scene one world after the other, with equally many in each.
 * Every world keeps the order that it has alone, so no body is in the range of the unbounded or large ones. */
Specialisation specialise_worlds(const Scene &all, uint32_t worlds, const Settings &settings);

/* The features alone. */
Features features_of(const Scene &scene, const Settings &settings);

/* What specialisation reads of a body. A body of the kind of another one brings no feature that this one did not. */
struct BodyKind {
  uint32_t shape, material, filter_group, filter_mask;
  BodyType type;
  bool trigger, continuous, posed, uneven, damped, locked, limited;
  auto operator<=>(const BodyKind &) const = default;
};
BodyKind kind_of(const Scene &scene, const Body &body);

/* True for a body that is large beside others of this median radius, or whose bounds are. */
bool is_large(const Scene &scene, const Body &body, float median);

/* All features of this library that a world alone could need, for comparing builds. */
Features all_features();

/* The median of bounding_radius over the bodies of finite size; 0 if there are none. */
float median_radius(const Scene &scene);

/* True for a shape that has a pose in its body: it is neither sphere, box nor half-space, or not centred in it, or
 * has continuous collision. */
bool is_general(const Scene &scene, const Body &body);

/* The shape code in body_flags. It is SHAPE_OTHER unless a row of shared/pairs.def names the shape, the shape is
 * centred in its body, and the body has no continuous collision. A capsule may have any place, but its ends must have
 * one radius. */
uint32_t shape_code(const Scene &scene, const Body &body);
/* The same of a child of the body's compound. A ball is a capsule without length, because it may have any place. */
uint32_t shape_code(const Body &body, const Child &child);

/* The filter of a body or a child; see Body in scene.h. */
struct Filter {
  uint32_t group = 1, mask = 0xffffffffu;
};
Filter filter_of(const Body &body, const Child &child);
/* Of a compound, the union of its children's filters. */
Filter filter_of(const Scene &scene, const Body &body);

/* The content of body_lock: LOCK_ bits of body_codes.h; 0 unless the body is dynamic. */
uint32_t locks_of(const Body &body);

/* The inverse principal moments, from the body's own moments or from its shape and mass; 0 if it cannot rotate. */
TANDEM_API Vec3 inverse_inertia_of(const Scene &scene, const Body &body);

} // namespace tandem
