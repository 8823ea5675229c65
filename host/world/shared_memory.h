/* shared_memory.h - which buffers of a step share memory, because their contents matter at different times.
 *
 *   launches of a step --->     broadphase    narrowphase    set-up    solver    commit
 *   sort_key                    [===============]                     .         .
 *   manifold_normal                           [==================]    .         .
 *   constraint_normal                                        [===================....  read after the step
 *   previous_cached_b            dead, because the commit overwrites it      [==]
 *
 * Scratch holds nothing from one step to the next. From when to when a buffer matters is therefore what the launches of
 * a step say that touch it, of which a dry run makes a list, so that no table could say it wrongly.
 */
#pragma once

#include <vector>

#include "host/runtime/memory.h"
#include "host/runtime/recorder.h"

namespace tandem {

/* When a step touches each buffer, by its number. */
struct StepSpans {
  std::vector<Span> of;
  std::vector<bool> between_steps; /* touched by launches there, so that it shares nothing */
  uint32_t first_of_commit = Span::never;
};

/* The buffers that may lie in the memory of others, given the bytes of all. apart: those that share nothing, by their
 * numbers. */
std::vector<Tenancy> tenancies_of(const StepSpans &spans, const Memory &memory, const std::vector<bool> &apart);

} // namespace tandem
