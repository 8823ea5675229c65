/* vehicle.h - cars on wheels with springs, steering and motors, which drive a curve over hills. */
#pragma once

#include "host/catalog/catalog.h"

namespace tandem {

BuiltInScene vehicle_scene();

} // namespace tandem
