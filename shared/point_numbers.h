/* point_numbers.h - the numbers of one point in constraint_points, a plane each; see point_rows.h. For kernels and the
 * host. */
#ifndef TANDEM_SHARED_POINT_NUMBERS_H
#define TANDEM_SHARED_POINT_NUMBERS_H

enum { POINT_X, POINT_Y, POINT_Z, POINT_SEPARATION, POINT_MASS, POINT_NUMBERS };

#endif
