/* picture.h - a small picture of a scene as SVG: bodies from the side, a little from above.
 *
 *        y |  z away          x' = x - 0.3 z,  y' = y - 0.2 z   (z towards the eye goes down and left)
 *          | /                near bodies are drawn over far ones; half-spaces are the ground line
 *          +---- x
 */
#pragma once

#include <string>
#include <vector>

#include <tandem/world.h>

namespace tandem::stability {

/* The part of a scene that a picture shows, in metres. The pictures of one case share it, so that they can be
 * compared. */
struct Window {
  double left = 0, right = 1, bottom = 0, top = 1;
  Point origin{0, 0, 0}; /* subtracted from positions first, for scenes far from the origin */
};

/* Contains the moving bodies at the start, and those at the end as far as the bodies stay visible. */
Window window_of(const std::vector<Shape> &shapes, const std::vector<Body> &start, const std::vector<BodyState> &end);

std::vector<BodyState> states_of(const std::vector<Body> &bodies);

/* At most 1,500 moving bodies are drawn, evenly chosen; bodies that are not finite are omitted. */
std::string svg_of(const std::vector<Shape> &shapes, const std::vector<Body> &bodies,
                   const std::vector<BodyState> &states, const Window &window, const std::string &title);

} // namespace tandem::stability
