/* lanes4.cpp - the LANES kernels with 4 items an instruction: SSE2 (every x86-64). */
#define WIDTH lanes4
#define TANDEM_LANES 4
#include "minicl/width.inc"
