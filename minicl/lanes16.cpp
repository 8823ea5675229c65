/* lanes16.cpp - the kernels that have lanes, with 16 items an instruction: AVX-512. */
#define WIDTH lanes16
#define TANDEM_LANES 16
#if defined(__AVX512F__)
#include "minicl/width.inc"
#else
#include "minicl/kernel_table.h"

const tandem::minicl::KernelTable tandem::minicl::lanes16_kernels = {16, nullptr};
#endif
