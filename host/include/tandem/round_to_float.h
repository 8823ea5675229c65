/* round_to_float.h - the only place in host/ where a double becomes a float.
 *
 * Scenes are built in double and simulated in float, and a rounded number is often widened again: positions are doubles
 * that hold floats, and a coordinate is a float and a second one that holds the remainder of the first. All of this
 * depends on the rounding being carried out. GCC 12 omits it from -O2 on: its vectorizer of straight-line code turns
 * double -> float -> double into two conversions of vectors, and its simplifier takes these for the identity, because
 * it compares the numbers of elements instead of their widths. The value therefore passes through an empty assembler
 * statement, which the compiler must assume to change the float, so that nothing can be folded across it at any level
 * of optimisation. docs/exactness.md has the details.
 */
#pragma once

namespace tandem {

/* Rounds to the nearest float, to the even one of two equally near; beyond the largest float the result is infinite. */
inline float round_to_float(double x)
{
  float rounded = static_cast<float>(x);
  asm("" : "+m"(rounded)); /* in memory, which every processor has, and where no wider register can keep it */
  return rounded;
}

/* Other types are refused: an integer or a float needs no rounding here, and hides that no double is rounded. */
template <class Number> float round_to_float(Number) = delete;

} // namespace tandem
