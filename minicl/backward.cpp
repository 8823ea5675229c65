/* backward.cpp - the scalar kernels with the phases of work-groups run in reverse order. A race between items of one
 * phase then shows as a difference between forward and backward, on the CPU alone. */
#define TANDEM_BACKWARD
#define WIDTH backward
#include "minicl/width.inc"
