/* lanes8.cpp - the stages of minicl/lanes8.cpp that find contacts, and the queries. */
#define TANDEM_PART_FINDING
#define TANDEM_LANES 8
#define WIDTH lanes8
#if defined(__AVX2__)
#include "minicl/width.inc"
#endif
