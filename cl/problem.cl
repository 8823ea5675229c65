/* problem.cl - entries: frictional contact problems. */
#include "cl/entry.h"
#include "shared/problem/residual.h"
#include "shared/problem/sweep.h"

__kernel void problem_prepare(__global const uint *problem_start, __global const uint *problem_column,
                              __global const row *problem_block, __global const row *problem_free,
                              __global row *problem_step, __global memory_real *trace, __global memory_real *reference,
                              RANGE)
{
  FOR_EACH_IN_RANGE(i)
  problem_prepare_item(problem_start, problem_column, problem_block, problem_free, problem_step, trace, reference, i);
}

__kernel void problem_sweep(__global const uint *problem_order, __global const uint *problem_start,
                            __global const uint *problem_column, __global const row *problem_block,
                            __global const row *problem_free, __global const row *problem_step,
                            __global row *problem_impulse, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  problem_sweep_item(problem_order, problem_start, problem_column, problem_block, problem_free, problem_step,
                     problem_impulse, i);
}

__kernel void problem_jacobi(__global const uint *problem_start, __global const uint *problem_column,
                             __global const row *problem_block, __global const row *problem_free,
                             __global const row *problem_step, __global const row *from, __global row *to, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  problem_jacobi_item(problem_start, problem_column, problem_block, problem_free, problem_step, from, to, i);
}

__kernel void problem_change(__global const row *problem_step, __global const row *problem_impulse,
                             __global const row *problem_previous, __global memory_real *change, RANGE)
{
  FOR_EACH_IN_RANGE(i) problem_change_item(problem_step, problem_impulse, problem_previous, change, i);
}

__kernel void problem_conjugate(__global const memory_real *now, __global const memory_real *before,
                                __global row *problem_impulse, __global row *problem_previous,
                                __global row *problem_direction, uint first_pass, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  problem_conjugate_item(now, before, problem_impulse, problem_previous, problem_direction, first_pass, i);
}

__kernel void problem_residual(__global const uint *counts, __global const uint *problem_start,
                               __global const uint *problem_column, __global const row *problem_block,
                               __global const row *problem_free, __global const memory_real *problem_trace,
                               __global const row *impulse, __global memory_real *natural,
                               __global memory_real *fischer, __global memory_real *violation, RANGE)
{
  FOR_EACH_IN_RANGE(i)
  problem_residual_item(counts, problem_start, problem_column, problem_block, problem_free, problem_trace, impulse,
                        natural, fischer, violation, i);
}
