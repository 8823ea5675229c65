/* self_test.cl - OpenCL entries of the device's self-test, shared/parallel/self_test.h. */
#include "cl/entry.h"
#include "shared/parallel/self_test.h"

__kernel void self_test(__global const float *numbers, __global const uint *words, __global float *real_results,
                        __global uint *word_results, __global uint *totals, RANGE)
{
  FOR_EACH_IN_RANGE(i) self_test_item(numbers, words, real_results, word_results, totals, i);
}

__kernel void self_test_phases(__global const uint *words, __global uint *results, RANGE)
{
  __local uint memory[LOCAL_WORDS];
  self_test_group(words, results, memory, GROUP_NUMBER);
  END_GROUP;
}
