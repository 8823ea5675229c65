/* rounding_test.cpp - copies are exact, bounds differ by a few ulps, and positions far from the origin by the
 * resolution of a float there. */
#include <cmath>
#include <string>

#include "host/catalog/catalog.h"
#include "host/verify/rounding.h"
#include "tests/catch.h"

using namespace tandem;

namespace {

RoundingTable table_of(double far)
{
  Scene scene = load_scene("box-grid:nx=2,ny=2,nz=2");
  for (Body &body : scene.bodies) {
    body.position[0] = float(body.position[0] + far);
    if (body.type == BodyType::dynamic) body.linear_velocity = {0.37f, 0.11f, -0.29f};
    if (body.type == BodyType::dynamic) body.angular_velocity = {0.3f, -0.2f, 0.1f};
  }
  RoundingRequest request;
  request.steps = 6;
  request.every = 2;
  return measure_rounding(scene, request);
}

RoundingRow row_for(const RoundingTable &table, Kernel kernel, Buffer buffer, const std::string &field)
{
  for (const RoundingRow &row : table.rows)
    if (row.kernel == kernel && row.buffer == buffer && row.field == field) return row;
  FAIL("no row for " << tandem::row_of(kernel).name << " " << field);
  return {};
}

} // namespace

TEST_CASE("rounding: the distance in units of the last place", "[rounding]")
{
  CHECK(ulps_from(1.0f, 1.0) == 0);
  CHECK(ulps_from(std::nextafter(1.0f, 2.0f), 1.0) == 1);
  CHECK(ulps_from(1.0f, 1.0 + std::ldexp(1, -24)) == 0.5);
  CHECK(ulps_from(-1024.0f, -1024.0 - 1.0 / 8192) == 1);
  CHECK(ulps_from(0.0f, 0.0) == 0);
  CHECK(ulps_from(0.0f, 1e-20) > 1e6); /* no digit is right */
  CHECK(ulps_from(1e-20f, 0.0) > 1e6);
  CHECK(ulps_from(0.0f, 1e-20) <= 1 << 24);
}

TEST_CASE("rounding: what only copies has 0 ulps", "[rounding]")
{
  const RoundingTable table = table_of(0);
  CHECK(table.launches > 100);
  for (const char *field : {"x", "y", "z", "w"}) {
    const RoundingRow row = row_for(table, Kernel::commit_bodies, Buffer::body_orientation, field);
    CHECK(row.numbers > 0);
    CHECK(row.max_ulps == 0);
    CHECK(row.max_absolute == 0);
  }
  CHECK(row_for(table, Kernel::commit_bodies, Buffer::body_velocity, "linear.y").max_ulps == 0);
  uint64_t numbers = 0;
  for (const DecisionRow &row : table.decisions)
    if (row_of(row.kernel).stage == Stage::parallel) {
      numbers += row.numbers;
      CHECK(row.differing == 0);
    }
  CHECK(numbers > 100);
}

TEST_CASE("rounding: bounds are a few ulps off, and something is", "[rounding]")
{
  const RoundingTable table = table_of(0);
  for (const char *field : {"lower.x", "lower.y", "lower.z", "upper.x", "upper.y", "upper.z"}) {
    const RoundingRow row = row_for(table, Kernel::compute_bounds, Buffer::bounds, field);
    CHECK(row.numbers >= 8);
    CHECK(row.median_ulps <= 2);
    const bool cancels = std::string(field).ends_with('y'); /* the top of the ground: -400 + 400 */
    CHECK(row.max_field_ulps <= (cancels ? 64 : 4));
    CHECK(row.max_ulps > 0);
    CHECK(row.median_ulps <= row.high_ulps);
    CHECK(row.high_ulps <= row.max_ulps);
    CHECK(row.nonfinite == 0);
  }
}

TEST_CASE(
    "rounding: far from the origin bounds lose what floats are coarser there, positions and offsets not",
    "[rounding]")
{
  const RoundingTable near = table_of(0), far = table_of(20000);
  const auto absolute = [](const RoundingTable &table, Kernel kernel, Buffer buffer, const char *field) {
    return row_for(table, kernel, buffer, field).max_absolute;
  };
  for (const RoundingTable *table : {&near, &far})
    CHECK(absolute(*table, Kernel::commit_bodies, Buffer::body_position, "x") <
          1e-9); /* half an ulp at 20 km is 1 mm */
  CHECK(absolute(far, Kernel::compute_bounds, Buffer::bounds, "lower.x") >
        30 * absolute(near, Kernel::compute_bounds, Buffer::bounds, "lower.x"));
  const double near_speed = absolute(near, Kernel::integrate_velocities, Buffer::solver_velocity, "linear.y");
  CHECK(near_speed > 0);
  CHECK(absolute(far, Kernel::integrate_velocities, Buffer::solver_velocity, "linear.y") < 10 * near_speed);
}
