/* breakpoint.h - finds the bodies of a location in a buffer, and the item that wrote it.
 *
 * It is the last part of a comparison's report: a gdb breakpoint on the serial backend that stops in the one item of
 * the one step in which two backends first differ.
 */
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <tandem/world.h>

#include "host/runtime/interface/kernel_list.h"

namespace tandem {

/* The parameter that is the item, or the group, in the kernel's shared function; "" if there is only one. */
const char *iteration_name(Kernel kernel);

size_t pair_capacity(World &world);

/* Indices into Scene::bodies: the body of a body's element, or the two of a pair or constraint. */
std::vector<uint32_t> bodies_of_item(World &world, Buffer buffer, size_t item);

/* "integrate_item if i == 17 && tandem::step_of_launch == 3"; only the step if the item that wrote the element is not
 * known (scattering kernels). */
std::string breakpoint_for(World &world, const Launch &launch, Buffer buffer, size_t item, uint64_t step);

} // namespace tandem
