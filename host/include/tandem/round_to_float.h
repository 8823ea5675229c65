/* round_to_float.h - a double becomes a float here and nowhere else in host/.
 *
 * Scenes are built in double and simulated in float, and what was rounded is often widened again: positions are doubles
 * that hold floats, and a coordinate is a float and a second one that holds what the first left over. All of it hangs
 * on the rounding being done. GCC 12 leaves it out from -O2 on: its vectorizer of straight-line code makes two
 * conversions of vectors of double -> float -> double, and its simplifier takes them for one that changes nothing. (It
 * compares how many numbers a vector holds instead of how wide they are.) The value goes through an empty assembler
 * statement instead, of which a compiler knows only that it may change the float: nothing can be folded over it, at any
 * level of optimisation. docs/exactness.md tells the story.
 */
#pragma once

namespace tandem {

/* To the nearest float, of two equally near the even one; infinite beyond the largest. */
inline float round_to_float(double x)
{
  float rounded = static_cast<float>(x);
  asm("" : "+m"(rounded)); /* in memory, which every processor has, and where no wider register can keep it */
  return rounded;
}

/* Of numbers of other types there is nothing to round, or it is not a double that is rounded. */
template <class Number> float round_to_float(Number) = delete;

} // namespace tandem
