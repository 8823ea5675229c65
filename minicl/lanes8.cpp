/* lanes8.cpp - the kernels that have lanes, with 8 items an instruction: AVX2. */
#define WIDTH lanes8
#define TANDEM_LANES 8
#if defined(__AVX2__)
#include "minicl/width.inc"
#else
#include "minicl/kernel_table.h"

const tandem::minicl::KernelTable tandem::minicl::lanes8_kernels = {8, nullptr};
#endif
