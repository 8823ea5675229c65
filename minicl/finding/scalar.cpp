/* scalar.cpp - the stages of minicl/scalar.cpp that find what touches. */
#define TANDEM_PART_FINDING
#define WIDTH scalar
#include "minicl/width.inc"
