/* broadphase_inputs.h - moving bodies for `tandem bench broadphase`; each input is a case in which broadphases differ.
 *
 *    spheres        pile         one-large        sizes          static
 *     o  o o      [_][_][_]     +---------+      +-----+ o      # # # # #
 *    o o  o        [_][_]       | . . .   | .    | .  +|-+      # #o-># #     #: fixed, o: dynamic
 *     oo   o      [_][_][_]     +---------+ .    +----|+ |o     # # # # #
 *
 * Positions come from seeded random numbers and + - * / alone, so that the bodies are the same on every machine and for
 * every broadphase.
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
  Scene (*scene)(uint32_t bodies); /* of exactly so many bodies, at least 2; without gravity */
};

std::span<const BroadphaseInput> broadphase_inputs();
std::vector<std::string> broadphase_input_names();
const BroadphaseInput &broadphase_input_named(const std::string &name); /* InputError lists the names */

/* A scene and what follows from it, made once for all broadphases. */
struct MovingBodies {
  MovingBodies(const BroadphaseInput &input, uint32_t bodies);

  /* The float4s of body_position with every body `frame` steps along its velocity. */
  std::vector<float4> places_at(uint32_t frame) const;

  Scene scene;
  Specialisation special;
};

} // namespace tandem
