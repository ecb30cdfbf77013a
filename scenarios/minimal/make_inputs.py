#!/usr/bin/python3
"""Makes the rasters of this scenario. Run it in this folder: python3 make_inputs.py (Debian package python3-gdal)."""
import numpy as np
from osgeo import gdal, osr

ROWS, COLS, CELL_M = 20, 24, 10.0
WEST_M, NORTH_M = 700000.0, 5180000.0  # UTM 11N, near Missoula, Montana
TIMES_S = (0, 60, 120)


def write(path, bands, unit, descriptions, times_s=None):
    driver = gdal.GetDriverByName("GTiff")
    options = ["COMPRESS=DEFLATE", "PREDICTOR=3", "ZLEVEL=9"]
    dataset = driver.Create(path, COLS, ROWS, len(bands), gdal.GDT_Float32, options)
    crs = osr.SpatialReference()
    crs.ImportFromEPSG(32611)
    dataset.SetProjection(crs.ExportToWkt())
    dataset.SetGeoTransform((WEST_M, CELL_M, 0.0, NORTH_M, 0.0, -CELL_M))
    for i, values in enumerate(bands):
        band = dataset.GetRasterBand(i + 1)
        band.SetDescription(descriptions[i])
        band.SetUnitType(unit)
        if times_s is not None:
            band.SetMetadataItem("time_s", str(times_s[i]))
        band.WriteArray(values.astype(np.float32))


def terrain_m():
    """A slope to the east with a knoll on it."""
    x = (np.arange(COLS) + 0.5) * CELL_M
    y = (np.arange(ROWS)[:, None] + 0.5) * CELL_M
    return 900.0 + 0.06 * x + 8.0 * np.exp(-((x - 160.0) ** 2 + (y - 110.0) ** 2) / (2.0 * 50.0**2))


def heat_flux_W_m2(frame):
    """A bowed front three cells deep that moves three cells to the east per frame."""
    flux = np.zeros((ROWS, COLS))
    for row in range(4, 16):
        head = 8 + 3 * frame - int(((row - 9.5) / 4.0) ** 2)
        for behind, value in enumerate((1.2e6, 6.0e5, 2.0e5)):
            flux[row, head - behind] = value
    return flux


write("dem.tif", [terrain_m()], "m", ["elevation"])
write("heat_flux.tif", [heat_flux_W_m2(k) for k in range(len(TIMES_S))], "W m-2",
      [f"heat flux {t} s" for t in TIMES_S], TIMES_S)
