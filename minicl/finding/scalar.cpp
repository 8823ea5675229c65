/* scalar.cpp - the stages of minicl/scalar.cpp that find contacts, and the queries. */
#define TANDEM_PART_FINDING
#define WIDTH scalar
#include "minicl/width.inc"
