/* checker.h - the checks that validate() makes of the fields of a scene, and their messages. */
#pragma once

#include <cmath>
#include <string>

#include <fmt/format.h>

#include <tandem/scene.h>

#include "host/base/finite_vector.h"
#include "host/base/printable.h"
#include "host/geometry/triangle_mesh.h"

namespace tandem {

/* Limits that keep the products of the stages finite floats. Squared areas are fourth powers of lengths, as are
 * friction coefficients combined and squared; distances are squared; masses and their inverses are added. */
inline constexpr double farthest = 1e18;
inline constexpr float most_friction = 1e9f, heaviest = 1e36f, lightest = 1e-36f;

[[noreturn]] inline void refuse(const std::string &where, const std::string &what, const std::string &why)
{
  throw InputError(fmt::format("{}: {}: {}", printable(where), what, why));
}

inline std::string label(const char *kind, size_t index, const std::string &name)
{
  return name.empty() ? fmt::format("{} {}", kind, index) : fmt::format("{} {} '{}'", kind, index, printable(name));
}

/* The checks of one thing. The message `where: what: why` is composed only if a check fails. */
struct Checker {
  const std::string &where;
  const char *kind;
  size_t index;
  const std::string &name;

  [[noreturn]] void fail(const std::string &why) const { refuse(where, label(kind, index, name), why); }

  template <class Vector> void finite_vector(const char *field, const Vector &v) const
  {
    if (!is_finite_vector(v)) fail(fmt::format("{} is {}; three finite numbers are needed", field, vector_text(v)));
  }
  void finite(const char *field, float x) const
  {
    if (!std::isfinite(x)) fail(fmt::format("{} is {}; a finite number is needed", field, x));
  }
  void at_least_zero(const char *field, float x) const
  {
    if (!(x >= 0) || !std::isfinite(x))
      fail(fmt::format("{} is {}; a finite number of at least 0 is needed", field, x));
  }
  void positive(const char *field, float x) const
  {
    if (!(x > 0) || !std::isfinite(x)) fail(fmt::format("{} is {}; a finite number above 0 is needed", field, x));
    /* The solver computes 1/x, which must not overflow. */
    if (!std::isfinite(1.0f / x)) fail(fmt::format("{} is {}, too small: its inverse is not a finite float", field, x));
  }
  void speed(const char *field, float x) const
  {
    if (!(x > 0)) fail(fmt::format("{} is {}; a number above 0 is needed, or infinity for none", field, x));
  }
  template <class Real> void at_most(const char *field, Real x, Real limit) const
  {
    if (!(std::abs(x) <= limit))
      fail(fmt::format("{} is {}; at most {} is possible, so that what is computed from it stays a float", field, x,
                       limit));
  }
  template <class Vector> void within(const char *field, const Vector &v, double limit) const
  {
    finite_vector(field, v);
    for (auto x : v) at_most(field, x, decltype(x)(limit));
  }
  void length(const char *field, float x) const
  {
    positive(field, x);
    at_most(field, x, longest_length);
  }
  void mass(const char *field, float x) const
  {
    positive(field, x);
    at_most(field, x, heaviest);
    if (x < lightest)
      fail(fmt::format("{} is {}; at least {} is needed, so that its inverse can be added to others", field, x,
                       lightest));
  }
  void friction(const char *field, float x) const
  {
    at_least_zero(field, x);
    at_most(field, x, most_friction);
  }
  void unit(const char *field, const Quat &q) const
  {
    double length_squared = 0;
    for (float x : q) length_squared += double(x) * x;
    if (!(std::abs(length_squared - 1.0) < 2e-3)) /* also true for NaN */
      fail(fmt::format("{} is [{}, {}, {}, {}]; a quaternion of length 1 is needed", field, q[0], q[1], q[2], q[3]));
  }
};

} // namespace tandem
