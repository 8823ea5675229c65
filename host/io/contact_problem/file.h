/* file.h - frictional contact problems as text, in the format of Siconos's collections (FCLIB).
 *
 * A file contains the problem of one time step, extracted from its simulation: velocities u = W r + q at nc contacts,
 * impulses r in Coulomb's cones.
 *
 *   3                      dimension
 *   nc                     contacts
 *   0 | 1                  how W is stored
 *   3nc 3nc                rows and columns of W
 *   0:  3nc 3nc, then W column by column
 *   1:  blocks, block rows, block columns, the ends 3 6 .. 3nc of both, lengths of the two index arrays, the index
 *       arrays (where the blocks of each row start; the column of each block), then every block: its number, its
 *       9 values by column
 *   q                      3nc values: free velocity, m/s
 *   mu                     nc coefficients of friction
 *
 * At each contact the first axis is the normal, the other two are tangents.
 */
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tandem {

struct ContactProblem {
  uint32_t contacts = 0;
  /* W in rows of 3x3 blocks: those of contact i are start[i] .. start[i + 1] - 1, its own (column i) first, the others
   * ascending. */
  std::vector<uint32_t> start, column;
  std::vector<std::array<double, 9>> blocks; /* row by row; s, m/s per N */
  std::vector<std::array<double, 3>> free_velocity;
  std::vector<double> friction; /* >= 0 */
};

/* Throws InputError with file and line for anything that is not such a problem: NaN, a negative coefficient, a missing
 * block, ... */
ContactProblem read_contact_problem(const std::string &path);

} // namespace tandem
