/* reference.cpp - the stages of minicl/reference.cpp that find what touches. */
#define TANDEM_PART_FINDING
#define TANDEM_REFERENCE
#define WIDTH reference
#include "minicl/width.inc"
