/* image.h - `--image F.png`: the scene by ray casting, with the kernels that answer World::cast_rays.
 *
 *          eye o--------- a ray a pixel, four on edges ------> first body hit: its colour, by the light and by what
 * stands in it
 *               \
 *                `------- another from there to the light: in shadow or not
 *
 * So the picture shows what queries see, on the backend that they are placed on, and has the same bytes on every
 * one. */
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <tandem/world.h>

namespace tandem {

struct Camera {
  Point eye{0, 0, 0}, target{0, 0, 0}; /* apart, and not above one another */
  double view = 40;                    /* degrees, from the upper edge to the lower; above 0, below 180 */
  uint32_t width = 960, height = 540;  /* pixels, 1 to 16384 */
};

/* Looks at all bodies of finite size but the largest ones, from the front and above. */
Camera camera_for(World &world, uint32_t width, uint32_t height);

/* "960x540"; "ex,ey,ez,tx,ty,tz": from where, to where. InputError says what would be right. */
std::array<uint32_t, 2> size_of_image(const std::string &text);
Camera camera_from(const std::string &text, uint32_t width, uint32_t height);

/* 8 bits each of red, green and blue, row by row from the top. */
std::vector<uint8_t> draw(World &world, const Camera &camera);

/* InputError if the file cannot be written. */
void write_png(const std::string &path, const std::vector<uint8_t> &pixels, uint32_t width, uint32_t height);

} // namespace tandem
