/* breakpoint.h - leads from a location in a buffer back to its bodies and to the item that wrote it.
 *
 * The last part of a comparison's report: a gdb breakpoint on the serial backend that stops in the one
 * item of the one step where two backends first differ.
 */
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tandem/world.h>

#include "host/runtime/interface/kernel_list.h"

namespace tandem {

/* The parameter that is the item, or the group, in the kernel's shared function; "" where there is but one. */
const char *iteration_name(Kernel kernel);

size_t pair_capacity(World &world);

/* Indices into Scene::bodies: the body of a body's row, the two of a pair's or constraint's. */
std::vector<uint32_t> bodies_of_item(World &world, Buffer buffer, size_t item);

/* "integrate_item if i == 17 && tandem::step_of_launch == 3"; the step alone where the item that wrote
 * the place is not known (scattering kernels). */
std::string breakpoint_for(World &world, const Launch &launch, Buffer buffer, size_t item, uint64_t step);

} // namespace tandem
