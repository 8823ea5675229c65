/* talks.h - the scenes behind the batch tables of the 2009 talk (OpenCL Game Physics), part of the catalogue
 * (catalog.h). */
#pragma once

#include "host/catalog/catalog.h"

namespace tandem {

/* The rows of these scenes for the catalogue. */
std::vector<BuiltInScene> talk_scenes();

/* The number of contacts of pyramid-2d with n cubes: adjacent cubes of a row touch, and each cube rests on two, or on
 * the ground. */
uint64_t pyramid_2d_contacts(uint64_t n);

} // namespace tandem
