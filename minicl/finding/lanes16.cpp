/* lanes16.cpp - the stages of minicl/lanes16.cpp that find contacts, and the queries. */
#define TANDEM_PART_FINDING
#define TANDEM_LANES 16
#define WIDTH lanes16
#if defined(__AVX512F__)
#include "minicl/width.inc"
#endif
