#!/usr/bin/python3
"""Makes the broken rasters of the scenarios one folder up. Run it here: python3 make_rasters.py (Debian package python3-gdal).
They lie on the grid of scenarios/minimal unless their fault is to lie elsewhere."""
import numpy as np
from osgeo import gdal, osr

ROWS, COLS, CELL_M = 20, 24, 10.0
WEST_M, NORTH_M = 700000.0, 5180000.0


def write(path, bands=None, unit="", times_s=(), crs=True, georeference=True, west_m=WEST_M, nodata=None):
    bands = bands if bands is not None else [np.full((ROWS, COLS), 900.0)]
    driver = gdal.GetDriverByName("GTiff")
    dataset = driver.Create(path, COLS, ROWS, len(bands), gdal.GDT_Float32, ["COMPRESS=DEFLATE"])
    if crs:
        reference = osr.SpatialReference()
        reference.ImportFromEPSG(32611)
        dataset.SetProjection(reference.ExportToWkt())
    if georeference:
        dataset.SetGeoTransform((west_m, CELL_M, 0.0, NORTH_M, 0.0, -CELL_M))
    for i, values in enumerate(bands):
        band = dataset.GetRasterBand(i + 1)
        band.SetUnitType(unit)
        if nodata is not None:
            band.SetNoDataValue(nodata)
        if times_s:
            band.SetMetadataItem("time_s", str(times_s[i]))
        band.WriteArray(values.astype(np.float32))


cold = np.zeros((ROWS, COLS))
burning = cold.copy()
burning[8:12, 10:12] = 5.0e5
nothing = np.full((ROWS, COLS), -9999.0)

write("dem_no_crs.tif", unit="m", crs=False)
write("dem_no_georeference.tif", unit="m", crs=False, georeference=False)
write("dem_nodata.tif", [nothing], "m", nodata=-9999.0)
write("dem_furlong.tif", [np.full((ROWS, COLS), 4.5)], "furlong")
write("heat_flux_elsewhere.tif", [burning], "W m-2", [0], west_m=WEST_M + 50000.0)
write("heat_flux_nodata.tif", [nothing], "W m-2", [0], nodata=-9999.0)
write("heat_flux_kelvin.tif", [burning], "K", [0])
write("heat_flux_no_time.tif", [burning], "W m-2")
write("heat_flux_descending.tif", [burning, burning], "W m-2", [120, 60])
write("heat_flux_cold.tif", [cold], "W m-2", [0])
write("wind_one_band.tif", [np.full((ROWS, COLS), 3.0)], "m s-1")
with open("not_a_raster.tif", "w", encoding="ascii") as text:
    text.write("Text that only has the name of a raster.\n")
