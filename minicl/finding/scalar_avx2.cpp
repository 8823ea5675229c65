/* scalar_avx2.cpp - the stages of minicl/scalar_avx2.cpp that find contacts, and the queries. */
#define TANDEM_PART_FINDING
#define WIDTH scalar_avx2
#include "minicl/width.inc"
