/* image.cpp - casts rays, shades hits and writes PNG; see image.h. */
#include "tools/plot/image.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <png.h>

#include "host/scene/shape_bounds.h"
#include "host/scene/specialise.h"
#include "tools/command/output.h"
#include "tools/command/scene_options.h"

namespace tandem {
namespace {

using Vector = std::array<double, 3>;

Vector plus(const Vector &a, const Vector &b, double t = 1)
{
  return {a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]};
}
double dot3(const Vector &a, const Vector &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross3(const Vector &a, const Vector &b)
{
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector unit(const Vector &v) { return plus({0, 0, 0}, v, 1 / std::sqrt(dot3(v, v))); }
Vector mixed(const Vector &a, const Vector &b, double t) { return plus(plus({0, 0, 0}, a, 1 - t), b, t); }
Vector vector_of(const Vec3 &v) { return {double{v[0]}, double{v[1]}, double{v[2]}}; }
Vec3 vec3_of(const Vector &v) { return {float(v[0]), float(v[1]), float(v[2])}; }

const Vector to_light = unit({0.5, 1.0, 0.35});
constexpr Vector ground_color{0.62, 0.64, 0.66}, sleeper_color{0.42, 0.43, 0.45};
/* Colour-blind readers can distinguish these colours (Okabe and Ito). */
constexpr Vector body_colors[] = {{0.90, 0.62, 0.00}, {0.34, 0.71, 0.91}, {0.00, 0.62, 0.45}, {0.94, 0.89, 0.26},
                                  {0.00, 0.45, 0.70}, {0.84, 0.37, 0.00}, {0.80, 0.47, 0.65}};

/* The axes of a picture, which give the position of a pixel's middle on a plane at distance 1. */
struct CameraFrame {
  Vector forward, right, up;
  double scale; /* of half the height */

  explicit CameraFrame(const Camera &camera)
  {
    forward = unit(plus(camera.target, camera.eye, -1));
    right = unit(cross3(forward, {0, 1, 0}));
    up = cross3(right, forward);
    scale = std::tan(camera.view * M_PI / 360);
  }
  Vector through(const Camera &camera, double x, double y) const
  {
    const double across = (2 * x - camera.width) / camera.height * scale,
                 above = (camera.height - 2 * y) / camera.height * scale;
    return plus(plus(forward, right, across), up, above);
  }
};

Ray ray_along(const Point &origin, const Vector &direction)
{
  Ray ray;
  ray.origin = origin;
  ray.direction = vec3_of(direction);
  ray.reach = std::numeric_limits<float>::infinity();
  return ray;
}

Vector sky(const Vector &direction)
{
  return mixed({0.93, 0.95, 0.97}, {0.55, 0.70, 0.88}, std::clamp(1.6 * unit(direction)[1], 0.0, 1.0));
}

/* Bodies that sleep are grey. Fixed bodies have a checker pattern of one metre, so that sizes can be read; it fades
 * where a square would be smaller than a pixel. */
Vector color_of(const World &world, const RayHit &hit, double distance)
{
  const Body &body = world.scene().bodies[hit.body];
  if (world.is_asleep(world.id_of(hit.body))) return sleeper_color;
  if (body.type != BodyType::fixed) return body_colors[(hit.body * 2654435761u >> 8) % std::size(body_colors)];
  const double squares = std::floor(hit.point[0]) + std::floor(hit.point[1] + 0.5) + std::floor(hit.point[2]);
  const double contrast = 0.12 / (1 + distance * distance / 1600);
  return plus({0, 0, 0}, ground_color, 1 - (std::fmod(std::abs(squares), 2) < 0.5 ? 0 : contrast));
}

Vector lit(const Vector &color, const Vector &normal, bool in_shadow)
{
  const double direct = in_shadow ? 0 : std::max(0.0, dot3(normal, to_light)), above = 0.5 + 0.5 * normal[1];
  return plus({0, 0, 0}, color, 0.25 + 0.2 * above + 0.6 * direct);
}

/* The colours along rays from the eye; rays that hit nothing show the sky. */
std::vector<Vector> colors_along(World &world, const std::vector<Ray> &rays)
{
  const std::vector<RayHit> hits = world.cast_rays(rays);
  std::vector<Ray> toward_light;
  for (size_t k = 0; k < rays.size(); ++k) {
    if (hits[k].body == no_body) continue;
    const Vector displacement = plus(hits[k].point, rays[k].origin, -1);
    toward_light.push_back(ray_along(
        plus(hits[k].point, vector_of(hits[k].normal), 1e-4 * std::sqrt(dot3(displacement, displacement)) + 1e-4),
        to_light));
  }
  const std::vector<bool> blocked = world.cast_rays_any(toward_light);
  std::vector<Vector> colors;
  size_t next = 0;
  for (size_t k = 0; k < rays.size(); ++k)
    if (hits[k].body == no_body) colors.push_back(sky(vector_of(rays[k].direction)));
    else {
      const Vector displacement = plus(hits[k].point, rays[k].origin, -1);
      colors.push_back(lit(color_of(world, hits[k], std::sqrt(dot3(displacement, displacement))),
                           vector_of(hits[k].normal), blocked[next++]));
    }
  return colors;
}

/* A pixel that differs from a neighbour is on an edge. */
std::vector<uint32_t> edges_of(const std::vector<Vector> &colors, const Camera &camera)
{
  std::vector<uint32_t> edges;
  const auto differ = [&](size_t i, size_t j) {
    const Vector d = plus(colors[i], colors[j], -1);
    return dot3(d, d) > 0.002;
  };
  for (uint32_t y = 0; y < camera.height; ++y)
    for (uint32_t x = 0; x < camera.width; ++x) {
      const size_t i = size_t{y} * camera.width + x;
      const bool edge = (x > 0 && differ(i, i - 1)) || (y > 0 && differ(i, i - camera.width)) ||
                        (x + 1 < camera.width && differ(i, i + 1)) ||
                        (y + 1 < camera.height && differ(i, i + camera.width));
      if (edge) edges.push_back(static_cast<uint32_t>(i));
    }
  return edges;
}

void smooth_edges(World &world, const Camera &camera, const CameraFrame &frame, std::vector<Vector> &colors)
{
  const std::vector<uint32_t> edges = edges_of(colors, camera);
  std::vector<Ray> rays;
  for (const uint32_t pixel : edges)
    for (const double dy : {0.25, 0.75})
      for (const double dx : {0.25, 0.75})
        rays.push_back(
            ray_along(camera.eye, frame.through(camera, pixel % camera.width + dx, pixel / camera.width + dy)));
  const std::vector<Vector> finer = colors_along(world, rays);
  for (size_t k = 0; k < edges.size(); ++k) {
    Vector sum{0, 0, 0};
    for (size_t sample = 0; sample < 4; ++sample) sum = plus(sum, finer[4 * k + sample], 0.25);
    colors[edges[k]] = sum;
  }
}

uint8_t byte_of(double light)
{
  return static_cast<uint8_t>(std::lround(255 * std::pow(std::clamp(light, 0.0, 1.0), 1 / 1.1)));
}

} // namespace

/* Large bodies are grounds and walls, which may extend beyond the picture. */
Camera camera_for(World &world, uint32_t width, uint32_t height)
{
  const Scene &scene = world.scene();
  const float limit = 4 * median_radius(scene);
  const std::vector<BodyState> bodies = world.bodies();
  Vector low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  for (size_t i = 0; i < bodies.size(); ++i) {
    const double radius = double{bounding_radius(scene, scene.bodies[i])};
    if (radius == 0 || radius > double{limit}) continue;
    for (size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], bodies[i].position[axis] - radius);
      high[axis] = std::max(high[axis], bodies[i].position[axis] + radius);
    }
  }
  if (!(low[0] <= high[0])) low = {-1, -1, -1}, high = {1, 1, 1};
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.target = plus(plus({0, 0, 0}, low, 0.5), high, 0.5);
  const Vector size = plus(high, low, -1);
  const double narrow = std::min(1.0, double(width) / height),
               distance = 0.46 * std::sqrt(dot3(size, size)) / (std::tan(camera.view * M_PI / 360) * narrow);
  camera.eye = plus(camera.target, unit({0.55, 0.42, 1.0}), std::max(distance, 0.1));
  return camera;
}

std::array<uint32_t, 2> size_of_image(const std::string &text)
{
  const size_t cross = text.find('x');
  if (cross == std::string::npos)
    throw InputError(fmt::format("--image-size '{}': use WIDTHxHEIGHT, e.g. 960x540", text));
  return {static_cast<uint32_t>(whole_number("--image-size", text.substr(0, cross), 1, 16384)),
          static_cast<uint32_t>(whole_number("--image-size", text.substr(cross + 1), 1, 16384))};
}

Camera camera_from(const std::string &text, uint32_t width, uint32_t height)
{
  constexpr double farthest = 1e18; /* metres, as of bodies */
  std::vector<double> numbers;
  for (size_t at = 0; at <= text.size();) {
    const size_t comma = std::min(text.find(',', at), text.size());
    numbers.push_back(real_number("--camera", text.substr(at, comma - at)));
    if (std::abs(numbers.back()) > farthest)
      throw InputError(fmt::format("--camera '{}': use coordinates between -1e18 and 1e18 m", text));
    at = comma + 1;
  }
  Camera camera;
  camera.width = width;
  camera.height = height;
  if (numbers.size() == 6) {
    std::copy_n(numbers.begin(), 3, camera.eye.begin());
    std::copy_n(numbers.begin() + 3, 3, camera.target.begin());
  }
  const Vector displacement = plus(camera.target, camera.eye, -1);
  if (numbers.size() != 6 || std::hypot(displacement[0], displacement[2]) < 1e-9 * (1 + std::abs(displacement[1])))
    throw InputError(
        fmt::format("--camera '{}': use EX,EY,EZ,TX,TY,TZ: from where to where, not straight up or down", text));
  return camera;
}

std::vector<uint8_t> draw(World &world, const Camera &camera)
{
  const CameraFrame frame(camera);
  std::vector<Ray> rays;
  for (uint32_t y = 0; y < camera.height; ++y)
    for (uint32_t x = 0; x < camera.width; ++x)
      rays.push_back(ray_along(camera.eye, frame.through(camera, x + 0.5, y + 0.5)));
  std::vector<Vector> colors = colors_along(world, rays);
  smooth_edges(world, camera, frame, colors);
  std::vector<uint8_t> pixels;
  for (const Vector &color : colors)
    for (const double light : color) pixels.push_back(byte_of(light));
  return pixels;
}

void write_png(const std::string &path, const std::vector<uint8_t> &pixels, uint32_t width, uint32_t height)
{
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string png(size, '\0');
  if (!png_image_write_to_memory(&image, png.data(), &size, 0, pixels.data(), 0, nullptr))
    throw std::runtime_error(fmt::format("--image {}: the picture cannot be made: {}", path, image.message));
  write_file("--image", path, {png.data(), size});
}

} // namespace tandem
