/* image.h - `--image F.png`: draws the scene by ray casting, with the kernels that answer World::cast_rays.
 *
 *          eye o--------- one ray per pixel, four on edges ------> first body hit: its colour, shaded by the light
 *               \
 *                `------- another ray from the hit to the light: in shadow or not
 *
 * The picture therefore shows what queries find, on the backend on which they are placed, and has the same bytes on
 * every backend. */
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <tandem/world.h>

namespace tandem {

struct Camera {
  Point eye{0, 0, 0}, target{0, 0, 0}; /* distinct, and not vertically above one another */
  double view = 40;                    /* vertical field of view in degrees, above 0 and below 180 */
  uint32_t width = 960, height = 540;  /* pixels, 1 to 16384 */
};

/* Looks at all bodies of finite size except the largest ones, from the front and above. */
Camera camera_for(World &world, uint32_t width, uint32_t height);

/* Parse "960x540", and "ex,ey,ez,tx,ty,tz" (eye and target). Throw InputError that says what would be right. */
std::array<uint32_t, 2> size_of_image(const std::string &text);
Camera camera_from(const std::string &text, uint32_t width, uint32_t height);

/* 8 bits each of red, green and blue, row by row from the top. */
std::vector<uint8_t> draw(World &world, const Camera &camera);

/* Throws InputError if the file cannot be written. */
void write_png(const std::string &path, const std::vector<uint8_t> &pixels, uint32_t width, uint32_t height);

} // namespace tandem
