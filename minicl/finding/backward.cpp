/* backward.cpp - the stages of minicl/backward.cpp that find contacts, and the queries. */
#define TANDEM_PART_FINDING
#define TANDEM_BACKWARD
#define WIDTH backward
#include "minicl/width.inc"
