/* passes_test.cpp - the movers of `tandem stability` miss or overlap the obstacle by the stated distance, which is
 * shown without the code that placed them.
 *
 * The gap between the mover's lowest point and the obstacle's highest one bounds the distance from below at every
 * moment, because neither leaves its side of the plane between. The distance of two of their points at one moment
 * bounds it from above. If both bounds are the clearance, so is the distance.
 */
#ifdef TANDEM_COMMAND
#include <tandem/world.h>

#include "host/geometry/convex_hull.h"
#include "host/geometry/triangle_mesh.h"
#include "tests/catch.h"
#include "tools/stability/passes.h"

using namespace tandem;
using namespace tandem::stability;

namespace {

struct Outline {
  std::vector<Vector> points; /* in the body's frame: the shape is their hull, */
  double radius = 0;          /* widened by this */
};

Outline outline_of(const Shape &shape)
{
  const double x = shape.size[0], y = shape.size[1], z = shape.size[2];
  if (shape.type == ShapeType::sphere) return {{Vector::Zero()}, x};
  if (shape.type == ShapeType::capsule) return {{{0, y, 0}, {0, -y, 0}}, x};
  Outline outline;
  if (shape.type == ShapeType::box)
    for (int k = 0; k < 8; ++k) outline.points.push_back({k & 1 ? x : -x, k & 2 ? y : -y, k & 4 ? z : -z});
  if (shape.type == ShapeType::hull)
    for (const Vec3 &vertex : shape.hull->vertices) outline.points.push_back(vector_of(vertex));
  if (shape.type == ShapeType::mesh)
    for (const Vec3 &vertex : shape.mesh->vertices) outline.points.push_back(vector_of(vertex));
  return outline;
}

/* The body's points at time t, moved and turned as it flies; all turn about z or not at all. */
std::vector<Vector> points_at(const Scene &scene, const Body &body, double t)
{
  const Matrix turned = Eigen::AngleAxisd(double(body.angular_velocity[2]) * t, Vector::UnitZ()).toRotationMatrix() *
                        axes_of(body.orientation);
  std::vector<Vector> points = outline_of(scene.shapes[body.shape]).points;
  for (Vector &point : points) point = vector_of(body.position) + t * vector_of(body.linear_velocity) + turned * point;
  return points;
}

/* Every corner of the side that is up (sign 1) or down (-1), to within a micrometre. */
std::vector<Vector> utmost(const std::vector<Vector> &points, double sign)
{
  double most = -HUGE_VAL;
  for (const Vector &point : points) most = std::max(most, sign * point.y());
  std::vector<Vector> found;
  for (const Vector &point : points)
    if (sign * point.y() > most - 1e-6) found.push_back(point);
  return found;
}

/* The distance from p to the corner, or to the edge between the two. */
double distance(const Vector &p, const std::vector<Vector> &top)
{
  if (top.size() == 1) return (p - top[0]).norm();
  const Vector edge = top[1] - top[0];
  const double along = std::clamp((p - top[0]).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
  return (p - top[0] - along * edge).norm();
}

constexpr double rounding = 2e-6; /* m: orientations are floats */

void check_lane(const Scene &scene, const Lane &lane)
{
  const Body &mover = scene.bodies[lane.mover], &obstacle = scene.bodies[lane.obstacle];
  const double radius = outline_of(scene.shapes[mover.shape]).radius;
  INFO("clearance " << lane.clearance << " m at " << lane.speed << " m/s");
  for (const Body *body : {&mover, &obstacle}) {
    REQUIRE_FALSE(points_at(scene, *body, 0).empty());
    REQUIRE((body->angular_velocity[0] == 0 && body->angular_velocity[1] == 0));
  }
  double top = -HUGE_VAL, bottom = HUGE_VAL;
  for (double t = 0; t < 40.0 / 60; t += 1e-3) {
    top = std::max(top, utmost(points_at(scene, obstacle, t), 1).front().y());
    bottom = std::min(bottom, utmost(points_at(scene, mover, t), -1).front().y() - radius);
  }
  const std::vector<Vector> highest = utmost(points_at(scene, obstacle, lane.passes), 1);
  const Vector lowest = utmost(points_at(scene, mover, lane.passes), -1).front() - Vector(0, radius, 0);
  CHECK(bottom - std::max(top, highest.front().y()) == Approx(lane.clearance).margin(rounding));
  CHECK(distance(lowest, highest) == Approx(std::abs(lane.clearance)).margin(rounding));
  CHECK(lane.passes > 2.0 / 60);
  CHECK(lane.passes < 20.0 / 60);
}

const Obstacle obstacles[] = {Obstacle::edge, Obstacle::corner, Obstacle::mesh_edge, Obstacle::rotor};

} // namespace

TEST_CASE("movers pass obstacles by the clearance that they say", "[stability]")
{
  for (const Mover &mover : movers())
    for (const Obstacle obstacle : obstacles) {
      const Passes passes = passes_of(mover, obstacle, {0.001, 0.01, 0.02, -0.001, -0.01});
      REQUIRE(passes.lanes.size() == 5 * all_speeds().size());
      INFO(mover.name << " past obstacle " << int(obstacle));
      for (const Lane &lane : passes.lanes) check_lane(passes.scene, lane);
    }
}

/* With collisions off: uniform motion in steps is on the path above at every step, and never nearer to the obstacle. */
TEST_CASE("movers fly on their path step by step, and turn not at all", "[stability]")
{
  for (const Mover &mover : movers()) {
    Passes passes = passes_of(mover, Obstacle::rotor, {0.001});
    for (Body &body : passes.scene.bodies) body.filter_mask = 0;
    World world(passes.scene, {});
    for (int step = 1; step <= 40; ++step) {
      world.step();
      const std::vector<BodyState> now = world.bodies();
      for (const Lane &lane : passes.lanes) {
        const Body &start = passes.scene.bodies[lane.mover];
        const BodyState &state = now[lane.mover];
        CHECK(state.orientation == start.orientation);
        CHECK(state.position[1] == Approx(start.position[1]).margin(1e-9));
        CHECK(state.position[0] == Approx(start.position[0] + lane.speed * step / 60.0).margin(1e-6 * lane.speed));
        CHECK((vector_of(now[lane.obstacle].position) - vector_of(passes.scene.bodies[lane.obstacle].position)).norm() <
              1e-9);
      }
    }
  }
}

/* Far enough apart: within a step no mover comes near another lane. */
TEST_CASE("lanes are farther apart than the fastest goes in three steps", "[stability]")
{
  const Passes passes = passes_of(movers().front(), Obstacle::edge, {0.001, 0.01});
  for (size_t k = 1; k < passes.lanes.size(); ++k) {
    const double gap = passes.scene.bodies[passes.lanes[k].mover].position[2] -
                       passes.scene.bodies[passes.lanes[k - 1].mover].position[2];
    CHECK(gap - 1 > 3 * all_speeds().back() / 60);
  }
}
#endif
