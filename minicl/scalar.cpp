/* scalar.cpp - every kernel one item at a time: the kernels that gdb steps through and other widths are compared
 * with. */
#define WIDTH scalar
#include "minicl/width.inc"
