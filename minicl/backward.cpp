/* backward.cpp - the scalar kernels with the phases of work-groups walked in reverse: a race between items of
 * one phase shows as a difference between forward and backward, on the CPU alone. */
#define TANDEM_BACKWARD
#define WIDTH backward
#include "minicl/width.inc"
