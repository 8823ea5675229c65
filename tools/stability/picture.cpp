/* picture.cpp - projects outlines and draws them from far to near; see picture.h. */
#include "tools/stability/picture.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "host/io/glb/geometry.h"
#include "tools/stability/figures.h"

namespace tandem::stability {
namespace {

constexpr double most_pixels = 360; /* of the longer side */
constexpr size_t most_drawn = 1500;

struct Point {
  double x, y;
};

Point project(const Vector &v) { return {v.x() - 0.3 * v.z(), v.y() - 0.2 * v.z()}; }

bool drawable(const BodyState &state)
{
  return vector_of(state.position).allFinite() &&
         std::isfinite(state.orientation[0] + state.orientation[1] + state.orientation[2] + state.orientation[3]);
}

/* The centre of the shape, which differs from the body's if the shape has a pose of its own. */
Vector centre_of(const Body &body, const BodyState &state, const Vector &origin)
{
  return vector_of(state.position) + axes_of(state.orientation) * vector_of(body.shape_position) - origin;
}

/* The projected points of the outline. */
std::vector<Point> points_of(const Shape &shape, const Body &body, const BodyState &state, const Vector &origin)
{
  const Matrix axes = axes_of(state.orientation) * axes_of(body.shape_orientation);
  const Vector centre = centre_of(body, state, origin);
  std::vector<Point> points;
  for (const Vec3 &p : outline_points(shape)) points.push_back(project(centre + axes * vector_of(p)));
  return points;
}

/* The largest distance of a shape's points from its origin. */
double reach_of(const Shape &shape)
{
  if (shape.type == ShapeType::sphere) return double(shape.size[0]);
  if (shape.type == ShapeType::box) return vector_of(shape.size).norm();
  double reach = 0;
  for (const Vec3 &p : outline_points(shape)) reach = std::max(reach, vector_of(p).norm());
  return reach;
}

double cross(const Point &o, const Point &a, const Point &b)
{
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/* Andrew's monotone chain. */
std::vector<Point> hull_of(std::vector<Point> points)
{
  std::sort(points.begin(), points.end(),
            [](const Point &a, const Point &b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  std::vector<Point> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const size_t start = hull.size();
    for (const Point &point : points) {
      while (hull.size() >= start + 2 && cross(hull[hull.size() - 2], hull.back(), point) <= 0) hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

void widen(Window &window, const Shape &shape, const Body &body, const BodyState &state)
{
  const double reach = reach_of(shape);
  const Point at = project(centre_of(body, state, vector_of(window.origin)));
  window.left = std::min(window.left, at.x - reach);
  window.right = std::max(window.right, at.x + reach);
  window.bottom = std::min(window.bottom, at.y - reach);
  window.top = std::max(window.top, at.y + reach);
}

/* Converts metres to pixels. */
struct Frame {
  const Window &window;
  double scale = most_pixels / std::max(window.right - window.left, window.top - window.bottom);
  double width() const { return (window.right - window.left) * scale; }
  double height() const { return (window.top - window.bottom) * scale; }
  std::string at(const Point &p) const
  {
    return fmt::format("{:.1f},{:.1f}", (p.x - window.left) * scale, (window.top - p.y) * scale);
  }
};

/* Bodies far outside the window are omitted, because they are invisible and their coordinates would fill the page. */
bool outside(const Frame &frame, const Point &p, double reach)
{
  const Window &w = frame.window;
  return p.x + reach < w.left || p.x - reach > w.right || p.y + reach < w.bottom || p.y - reach > w.top;
}

std::string drawing_of(const Shape &shape, const Body &body, const BodyState &state, const Frame &frame,
                       const char *style)
{
  const Vector origin = vector_of(frame.window.origin);
  const Point centre = project(centre_of(body, state, origin));
  if (outside(frame, centre, reach_of(shape))) return "";
  if (shape.type == ShapeType::sphere)
    return fmt::format("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"/>\n", style,
                       (centre.x - frame.window.left) * frame.scale, (frame.window.top - centre.y) * frame.scale,
                       std::max(0.5, double(shape.size[0]) * frame.scale));
  std::string points;
  for (const Point &p : hull_of(points_of(shape, body, state, origin))) points += frame.at(p) + " ";
  return fmt::format("<polygon class=\"{}\" points=\"{}\"/>\n", style, points);
}

/* Distant bodies are drawn first. */
std::vector<size_t> drawing_order(const std::vector<Body> &bodies, const std::vector<BodyState> &states)
{
  std::vector<size_t> fixed, moving;
  for (size_t i = 0; i < bodies.size(); ++i)
    if (drawable(states[i])) (bodies[i].type == BodyType::dynamic ? moving : fixed).push_back(i);
  std::vector<size_t> order = fixed;
  const size_t stride = (moving.size() + most_drawn - 1) / most_drawn;
  for (size_t i = 0; i < moving.size(); i += std::max<size_t>(1, stride)) order.push_back(moving[i]);
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return states[a].position[2] < states[b].position[2]; });
  return order;
}

} // namespace

std::vector<BodyState> states_of(const std::vector<Body> &bodies)
{
  std::vector<BodyState> states;
  for (const Body &body : bodies)
    states.push_back({body.position, body.orientation, body.linear_velocity, body.angular_velocity});
  return states;
}

Window window_of(const std::vector<Shape> &shapes, const std::vector<Body> &start, const std::vector<BodyState> &end)
{
  Window tight;
  const auto first =
      std::find_if(start.begin(), start.end(), [](const Body &body) { return body.type == BodyType::dynamic; });
  if (first == start.end()) return tight;
  tight.origin = {first->position[0], 0, first->position[2]};
  tight.left = tight.bottom = HUGE_VAL;
  tight.right = tight.top = -HUGE_VAL;
  const std::vector<BodyState> before = states_of(start);
  for (size_t i = 0; i < start.size(); ++i)
    if (start[i].type == BodyType::dynamic) widen(tight, shapes[start[i].shape], start[i], before[i]);
  Window wide = tight;
  for (size_t i = 0; i < end.size(); ++i)
    if (start[i].type == BodyType::dynamic && drawable(end[i])) widen(wide, shapes[start[i].shape], start[i], end[i]);
  const auto moving =
      std::count_if(start.begin(), start.end(), [](const Body &body) { return body.type == BodyType::dynamic; });
  const double size = std::max(tight.right - tight.left, tight.top - tight.bottom), margin = 0.05 * size,
               least_height = 0.3 * size, least_width = 0.1 * size;
  const double most_wide = moving <= 5 ? 10 * size : size; /* a few bodies may travel far relative to their size */
  wide.left = std::max(wide.left, tight.left - most_wide) - margin;
  wide.right = std::min(wide.right, tight.right + most_wide) + margin;
  if (wide.right - wide.left < least_width) wide.left -= 0.5 * least_width, wide.right += 0.5 * least_width;
  wide.bottom = std::max(wide.bottom, tight.bottom - 0.3 * size) - margin;
  wide.top = std::max(std::min(wide.top, tight.top + most_wide) + margin, wide.bottom + least_height);
  return wide;
}

std::string svg_of(const std::vector<Shape> &shapes, const std::vector<Body> &bodies,
                   const std::vector<BodyState> &states, const Window &window, const std::string &title)
{
  const Frame frame{window};
  std::string svg = fmt::format("<svg class=\"scene\" viewBox=\"0 0 {:.0f} {:.0f}\" width=\"{:.0f}\" role=\"img\" "
                                "aria-label=\"{}\">\n<title>{}</title>\n",
                                frame.width(), frame.height(), frame.width(), title, title);
  for (size_t i : drawing_order(bodies, states)) {
    const Shape &shape = shapes[bodies[i].shape];
    if (shape.type != ShapeType::half_space)
      svg += drawing_of(shape, bodies[i], states[i], frame, bodies[i].type == BodyType::dynamic ? "moving" : "fixed");
    else {
      const double y = (window.top - double(states[i].position[1])) * frame.scale;
      svg += fmt::format("<line class=\"ground\" x1=\"0\" x2=\"{:.0f}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>\n", frame.width(),
                         y, y);
    }
  }
  return svg + "</svg>\n";
}

} // namespace tandem::stability
