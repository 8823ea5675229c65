/* joints.cl - OpenCL entries of joints. */
#include "cl/entry.h"
#include "shared/joints/kernels.h"

ENTRIES(joints)
