/* lanes4.cpp - the stages of minicl/lanes4.cpp that find contacts, and the queries. */
#define TANDEM_PART_FINDING
#define TANDEM_LANES 4
#define WIDTH lanes4
#include "minicl/width.inc"
