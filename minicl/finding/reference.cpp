/* reference.cpp - the stages of minicl/reference.cpp that find contacts, and the queries. */
#define TANDEM_PART_FINDING
#define TANDEM_REFERENCE
#define WIDTH reference
#include "minicl/width.inc"
