#pragma once

#include "gis/raster_output.h"

class GDALRasterBand;

namespace pyroscene::gis {

/// Name, unit, wavelengths and other metadata of a band.
OutputBand describe_band(GDALRasterBand& band);

}  // namespace pyroscene::gis
