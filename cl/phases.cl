/* phases.cl - launches of few items, run as the phases of one launch, with a barrier between two.
 *
 *   script   [kind, first, last, groups, after, values ..] [kind, first, last, groups, after, values ..] ..
 *
 *   time --->     small phases     a large one      small ones
 *   group 0       [ ][ ][ ][ ]  |  [        ]  |  [ ][ ][ ]
 *   group 1                     |  [        ]  |               |  all groups of the launch wait for each other
 *   group 2                     |  [        ]  |
 *
 * A launch takes a GPU some microseconds whatever it does, and a step makes some 170. The host writes the kernel
 * run_phases behind this text, with a case for each kind of phase that a scene has (host/runtime/opencl/phases.h). A
 * case calls the function that the kernel's own entry calls, over the same range, so the bits are the same. Whatever
 * the range holds is processed: how many groups take part is a matter of speed alone.
 *
 * OpenCL does not promise that the groups of a launch run together. A program with RESIDENT_GROUPS is used with no more
 * groups than a test at its start showed to do so (host/runtime/opencl/resident_groups.h), after Xiao and Feng,
 * Inter-Block GPU Communication via Fast Barrier Synchronization (2010).
 */
#include "cl/entry.h"
#include "shared/kernels.h"
#include "shared/parallel/length.h"
#include "shared/parallel/phase_limits.h"

/* The words of a script are read first, because each phase would wait for its own otherwise. */
#define READ_SCRIPT                                                                                     \
  __local uint words[PHASE_WORDS * MOST_PHASES];                                                        \
  for (uint word = (uint)get_local_id(0); word < PHASE_WORDS * phases; word += (uint)get_local_size(0)) \
    words[word] = script[word];

#define LARGER(a, b) ((a) > (b) ? (a) : (b))
#define NOT_INLINE __attribute__((noinline))

#ifndef RESIDENT_GROUPS

#define BEGIN_PHASES                                                                         \
  READ_SCRIPT                                                                                \
  END_GROUP;                                                                                 \
  for (uint phase = 0; phase < phases; ++phase) {                                            \
    __local const uint *row = words + PHASE_WORDS * phase;                                   \
    const uint first = range[row[PHASE_RANGE_AT]], last = range[row[PHASE_RANGE_AT + 1u]];   \
    switch (row[0]) {
#define END_PHASES \
  }                \
  END_GROUP;       \
  }

#define FIRST_OF_PHASE (first + (uint)get_local_id(0))
#define STRIDE_OF_PHASE ((uint)get_local_size(0))
/* The groups of a GROUP kernel follow one another in the only work-group. */
#define FOR_EACH_GROUP(group) \
  for (uint group = 0, groups = units_of(last - first, TILE); group < groups; ++group, END_GROUP)

#else

/* Caches of two groups need not agree about what a barrier of one group orders. OpenCL C 1.2 has no fence between
 * groups; devices of that version are tested on emulators alone, which have no such caches. */
#if __OPENCL_C_VERSION__ >= 300
#define FENCE_BETWEEN_GROUPS atomic_work_item_fence(CLK_GLOBAL_MEM_FENCE, memory_order_acq_rel, memory_scope_device)
#else
#define FENCE_BETWEEN_GROUPS mem_fence(CLK_GLOBAL_MEM_FENCE)
#endif

/* Waits until `wanted` groups have arrived in all, counted without end; returns whether they did. Counts may wrap. */
static inline uint wait_for_arrivals(volatile __global uint *arrivals, uint wanted, uint patience)
{
  for (uint polls = 0; (int)(arrivals[ARRIVALS_COUNT] - wanted) < 0; ++polls)
    if (polls == patience || arrivals[ARRIVALS_DEADLOCK]) return 0u;
  return 1u;
}

/* One item of a group reports what the whole group has written, and waits for the others. It returns whether they
 * failed to come. */
static inline uint meet_other_groups(volatile __global uint *arrivals, uint wanted, uint patience)
{
  FENCE_BETWEEN_GROUPS;
  atomic_inc(arrivals + ARRIVALS_COUNT);
  const uint all_came = wait_for_arrivals(arrivals, wanted, patience);
  if (!all_came) arrivals[ARRIVALS_DEADLOCK] = 1u;
  FENCE_BETWEEN_GROUPS;
  return !all_came;
}

/* One phase of the test of a device: each item takes the number that the neighbouring group's has, and adds one. */
static inline void pass_along_ring(__global uint *ring, uint phase)
{
  const uint place = (uint)get_global_id(0), places = (uint)get_global_size(0);
  __global const uint *from = ring + (phase % 2u) * places;
  __global uint *to = ring + (1u - phase % 2u) * places;
  to[place] = from[(place + (uint)get_local_size(0)) % places] + 1u;
}

/* The place of an item among those of all groups. 32 items in a row stay in one group, so that they read memory
 * together; few items spread over all groups. */
static inline uint place_among_groups(void)
{
  const uint item = (uint)get_local_id(0), items = (uint)get_local_size(0), group = (uint)get_group_id(0);
  if (items % 32u != 0u) return group * items + item;
  return (item / 32u * (uint)get_num_groups(0) + group) * 32u + item % 32u;
}

/* Little is kept in registers over a phase, because the largest kernels need them all. A launch after a deadlock does
 * nothing, and nothing that a step wrote is committed. */
#define BEGIN_PHASES                                                                                    \
  READ_SCRIPT                                                                                           \
  __local uint deadlock[1], met[1];                                                                     \
  if (get_local_id(0) == 0) {                                                                           \
    deadlock[0] = arrivals[ARRIVALS_DEADLOCK];                                                          \
    met[0] = arrived;                                                                                   \
  }                                                                                                     \
  END_GROUP;                                                                                            \
  for (uint phase = 0; phase < phases; ++phase) {                                                       \
    __local const uint *row = words + PHASE_WORDS * phase;                                              \
    if ((row[PHASE_GROUPS_AT] || get_group_id(0) == 0) && !deadlock[0]) {                               \
      const uint first = range[row[PHASE_RANGE_AT]], last = range[row[PHASE_RANGE_AT + 1u]];            \
      switch (row[0]) {                                                                                 \
      case PHASE_OF_TEST: pass_along_ring(arrivals + ARRIVALS_RING, phase); break;
#define END_PHASES                                                                                          \
  }                                                                                                         \
  }                                                                                                         \
  END_GROUP;                                                                                                \
  if (row[PHASE_MEETING_AT]) {                                                                              \
    if (get_local_id(0) == 0) {                                                                             \
      met[0] += (uint)get_num_groups(0);                                                                    \
      deadlock[0] |= meet_other_groups(arrivals, met[0], patience);                                         \
    }                                                                                                       \
    END_GROUP;                                                                                              \
  }                                                                                                         \
  }                                                                                                         \
  if (deadlock[0] && get_local_id(0) == 0) atomic_or(range + COUNT_STATUS, STATUS_DEADLOCK);

#define FIRST_OF_PHASE (first + (row[PHASE_GROUPS_AT] ? place_among_groups() : (uint)get_local_id(0)))
#define STRIDE_OF_PHASE (row[PHASE_GROUPS_AT] ? (uint)get_global_size(0) : (uint)get_local_size(0))
/* The groups of a GROUP kernel follow one another in each work-group. */
#define FOR_EACH_GROUP(group)                                                                            \
  for (uint group = (uint)get_group_id(0), groups = units_of(last - first, TILE); group < groups; \
       group += (row[PHASE_GROUPS_AT] ? (uint)get_num_groups(0) : 1u), END_GROUP)

#endif
