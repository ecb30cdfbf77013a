#!/usr/bin/python3
"""Makes the rasters of this scenario. Run it in this folder: python3 make_inputs.py (Debian package python3-gdal)."""
import numpy as np
from osgeo import gdal, osr

FOOT_M = 0.3048


def write(path, bands, cell_m, unit, descriptions, times_s=None):
    rows, cols = bands[0].shape
    driver = gdal.GetDriverByName("GTiff")
    dataset = driver.Create(path, cols, rows, len(bands), gdal.GDT_Float32, ["COMPRESS=DEFLATE", "PREDICTOR=3", "ZLEVEL=9"])
    crs = osr.SpatialReference()
    crs.ImportFromEPSG(32611)
    dataset.SetProjection(crs.ExportToWkt())
    dataset.SetGeoTransform((722000.0, cell_m, 0.0, 5194000.0, 0.0, -cell_m))
    for i, values in enumerate(bands):
        band = dataset.GetRasterBand(i + 1)
        band.SetDescription(descriptions[i])
        band.SetUnitType(unit)
        if times_s is not None:
            band.SetMetadataItem("time_s", str(times_s[i]))
        band.WriteArray(values.astype(np.float32))


def rectangle(rows, cols, north, south, west, east):
    flux = np.zeros((rows, cols))
    flux[north:south, west:east] = 5.0e5  # all of a cell flames (fire.flaming_heat_flux_W_m2)
    return flux


# Fuel beds of 1 to 9 feet, 3 feet wide, cells of half a foot; the near end is at x = 722002.4384 m.
lengths_m = [k * FOOT_M for k in range(1, 10)]
write("bed_dem.tif", [np.full((24, 48), 980.0)], FOOT_M / 2, "m", ["elevation"])
write("bed_heat_flux.tif", [rectangle(24, 48, 9, 15, 16, 16 + 2 * k) for k in range(1, 10)], FOOT_M / 2, "W m-2",
      [f"heat flux, bed of {m:.3f} m" for m in lengths_m], [60 * (k - 1) for k in range(1, 10)])

# A burning container, 0.2 m along the line of sight and 0.5 m across it; the near side is at x = 722002.5 m.
write("container_dem.tif", [np.full((31, 60), 170.0)], 0.1, "m", ["elevation"])
write("container_heat_flux.tif", [rectangle(31, 60, 13, 18, 25, 27)], 0.1, "W m-2", ["heat flux"], [0])
