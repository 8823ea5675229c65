/* scalar.cpp - the reference: every kernel one item at a time, as gdb steps it. */
#define WIDTH scalar
#include "minicl/width.inc"
