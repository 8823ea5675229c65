/* scalar_avx2.cpp - the stages of minicl/scalar_avx2.cpp that find what touches. */
#define TANDEM_PART_FINDING
#define WIDTH scalar_avx2
#include "minicl/width.inc"
