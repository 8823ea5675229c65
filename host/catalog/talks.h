/* talks.h - the scenes behind the batch tables of the 2009 talk (OpenCL Game Physics). */
#pragma once

#include "host/catalog/catalog.h"

namespace tandem {

/* Rows of the catalogue. */
std::vector<BuiltInScene> talk_scenes();

/* Contacts of pyramid-2d with n cubes: two cubes of a row touch, each rests on two, the lowest on the ground. */
uint64_t pyramid_2d_contacts(uint64_t n);

} // namespace tandem
