/* broadphase_inputs.h - bodies in motion for `tandem bench broadphase`: each input is one case that tells broadphases
 * apart.
 *
 *    spheres        pile         one-large        sizes          static
 *     o  o o      [_][_][_]     +---------+      +-----+ o      # # # # #
 *    o o  o        [_][_]       | . . .   | .    | .  +|-+      # #o-># #     #: fixed, o: dynamic
 *     oo   o      [_][_][_]     +---------+ .    +----|+ |o     # # # # #
 *
 * Seeded, and of + - * / alone: the same bodies on every machine, and for every broadphase.
 */
#pragma once

#include <span>
#include <string>
#include <vector>

#include <tandem/scene.h>

#include "host/scene/specialise.h"
#include "shared/platform.h"

namespace tandem {

struct BroadphaseInput {
  const char *name;
  const char *what;
  Scene (*scene)(uint32_t bodies); /* of exactly so many, at least 2; without gravity */
};

std::span<const BroadphaseInput> broadphase_inputs();
std::vector<std::string> broadphase_input_names();
const BroadphaseInput &broadphase_input_named(const std::string &name); /* InputError lists the names */

/* The scene and what follows from it, made once for all broadphases. */
struct MovingBodies {
  MovingBodies(const BroadphaseInput &input, uint32_t bodies);

  /* Rows of body_position: every body `frame` steps along its velocity. */
  std::vector<float4> places_at(uint32_t frame) const;

  Scene scene;
  Specialisation special;
};

} // namespace tandem
