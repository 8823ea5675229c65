/* scalar_avx2.cpp - every kernel one item at a time, for processors with AVX2: chunks (shared/float8.h) are one
 * register. */
#define WIDTH scalar_avx2
#include "minicl/width.inc"
