/* call_checks.cpp - see call_checks.h. */
#include "host/world/call_checks.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <tandem/error.h>

#include "host/base/finite_vector.h"

namespace tandem {

void refuse_entry(const char *call, size_t index, const std::string &why)
{
  throw InputError(fmt::format("{}: entry {}: {}", call, index, why));
}

void refuse_axis(const char *call, size_t index, uint32_t axis)
{
  refuse_entry(call, index, fmt::format("axis {} does not exist; 0 to 2 are directions, 3 to 5 rotations", axis));
}

namespace {

template <class Vector> void check_vector(const char *call, size_t index, const char *what, const Vector &v)
{
  if (!is_finite_vector(v))
    refuse_entry(call, index, fmt::format("{} is {}; three finite numbers are needed", what, vector_text(v)));
}

void check_rotation(const char *call, size_t index, const Quat &q)
{
  double square = 0;
  for (const float x : q) square += double{x} * x;
  if (!(std::abs(square - 1) < 2e-3))
    refuse_entry(
        call, index,
        fmt::format("orientation is [{}, {}, {}, {}]; a quaternion of length 1 is needed", q[0], q[1], q[2], q[3]));
}

void check(const char *call, size_t index, const Pose &pose)
{
  check_vector(call, index, "position", pose.position);
  check_rotation(call, index, pose.orientation);
}
void check(const char *call, size_t index, const Velocity &velocity)
{
  check_vector(call, index, "linear velocity", velocity.linear);
  check_vector(call, index, "angular velocity", velocity.angular);
}
void check(const char *call, size_t index, const BodyState &state)
{
  check(call, index, Pose{state.position, state.orientation});
  check(call, index, Velocity{state.linear_velocity, state.angular_velocity});
}
void check_point(const char *call, size_t index, const std::optional<Point> &point)
{
  if (point) check_vector(call, index, "point", *point);
}
void check(const char *call, size_t index, const Impulse &impulse)
{
  check_vector(call, index, "impulse", impulse.impulse);
  check_vector(call, index, "angular impulse", impulse.angular_impulse);
  check_point(call, index, impulse.point);
}
void check(const char *call, size_t index, const Force &force)
{
  check_vector(call, index, "force", force.force);
  check_vector(call, index, "torque", force.torque);
  check_point(call, index, force.point);
}

template <class Entry> void check_each(const char *call, size_t ids, std::span<const Entry> entries)
{
  if (ids != entries.size())
    throw InputError(
        fmt::format("{}: {} handles and {} entries; one entry for each handle is needed", call, ids, entries.size()));
  for (size_t i = 0; i < entries.size(); ++i) check(call, i, entries[i]);
}

} // namespace

void check_entries(const char *call, size_t ids, std::span<const BodyState> entries) { check_each(call, ids, entries); }
void check_entries(const char *call, size_t ids, std::span<const Velocity> entries) { check_each(call, ids, entries); }
void check_entries(const char *call, size_t ids, std::span<const Pose> entries) { check_each(call, ids, entries); }
void check_entries(const char *call, size_t ids, std::span<const Impulse> entries) { check_each(call, ids, entries); }
void check_entries(const char *call, size_t ids, std::span<const Force> entries) { check_each(call, ids, entries); }

} // namespace tandem
