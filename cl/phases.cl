/* phases.cl - launches of few items, run as the phases of one launch: a single work-group takes them in turn, with a
 * barrier between two.
 *
 *   script   [kind, first, last, values ..] [kind, first, last, values ..] ..      a row a phase
 *
 * A launch takes a GPU some microseconds whatever it does, and a step of forty boxes makes 133. The host writes the
 * kernel run_phases behind this text, with a case for each kind of phase that a scene has
 * (host/runtime/opencl/phases.h). A case calls the function that the kernel's own entry calls, over the same range, so
 * the bits are the same. Whatever the range holds is processed: what few items are is a matter of speed alone.
 */
#include "cl/entry.h"
#include "shared/kernels.h"
#include "shared/parallel/length.h"
#include "shared/parallel/phase_limits.h"

/* The words of a script are read first, because each phase would wait for its own otherwise. */
#define BEGIN_PHASES                                                                                    \
  __local uint words[PHASE_WORDS * MOST_PHASES];                                                        \
  for (uint word = (uint)get_local_id(0); word < PHASE_WORDS * phases; word += (uint)get_local_size(0)) \
    words[word] = script[word];                                                                         \
  END_GROUP;                                                                                            \
  for (uint phase = 0; phase < phases; ++phase) {                                                       \
    __local const uint *row = words + PHASE_WORDS * phase;                                              \
    const uint first = range[row[PHASE_RANGE_AT]], last = range[row[PHASE_RANGE_AT + 1u]];              \
    switch (row[0]) {
#define END_PHASES \
  }                \
  END_GROUP;       \
  }

#define FOR_EACH_IN_PHASE(i) for (uint i = first + (uint)get_local_id(0); i < last; i += (uint)get_local_size(0))

/* The groups of a phase follow one another in the only work-group. */
#define FOR_EACH_GROUP(group) \
  for (uint group = 0, groups = units_of(last - first, TILE); group < groups; ++group, END_GROUP)

#define LARGER(a, b) ((a) > (b) ? (a) : (b))
