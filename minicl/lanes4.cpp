/* lanes4.cpp - the kernels that have lanes, with 4 items an instruction: SSE2 (every x86-64). */
#define WIDTH lanes4
#define TANDEM_LANES 4
#include "minicl/width.inc"
