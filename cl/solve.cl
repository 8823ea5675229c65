/* solve.cl - entries: the contact solvers, a file for each family of rows. */
#include "cl/solve/contact.cl"
#include "cl/solve/mass_split.cl"
#include "cl/solve/pgs.cl"
#include "cl/solve/xpbd.cl"
#include "cl/solve/avbd.cl"
#include "cl/solve/rolling.cl"
