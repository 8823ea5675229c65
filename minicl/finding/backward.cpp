/* backward.cpp - the stages of minicl/backward.cpp that find what touches. */
#define TANDEM_PART_FINDING
#define TANDEM_BACKWARD
#define WIDTH backward
#include "minicl/width.inc"
