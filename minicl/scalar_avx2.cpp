/* scalar_avx2.cpp - every kernel one item at a time, for processors with AVX2, on which a chunk (shared/float8.h) is
 * one register. */
#define WIDTH scalar_avx2
#include "minicl/width.inc"
