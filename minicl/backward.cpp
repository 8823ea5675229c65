/* backward.cpp - the scalar kernels of work-groups with their phases run in reverse order. A race between items of one
 * phase then shows as a difference between forward and backward, on the CPU alone. */
#define TANDEM_BACKWARD
#define WIDTH backward
#include "minicl/width.inc"
