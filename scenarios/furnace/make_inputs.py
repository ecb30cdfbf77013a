#!/usr/bin/python3
"""Makes the rasters of this scenario. Run it in this folder: python3 make_inputs.py (Debian package python3-gdal)."""
import numpy as np
from osgeo import gdal, osr

CELLS, CELL_M = 16, 10.0


def write(path, values, unit, description, metadata):
    driver = gdal.GetDriverByName("GTiff")
    dataset = driver.Create(path, CELLS, CELLS, 1, gdal.GDT_Float32, ["COMPRESS=DEFLATE", "PREDICTOR=3", "ZLEVEL=9"])
    crs = osr.SpatialReference()
    crs.ImportFromEPSG(32616)
    dataset.SetProjection(crs.ExportToWkt())
    dataset.SetGeoTransform((418420.0, CELL_M, 0.0, 4761380.0, 0.0, -CELL_M))
    band = dataset.GetRasterBand(1)
    band.SetDescription(description)
    band.SetUnitType(unit)
    for key, value in metadata.items():
        band.SetMetadataItem(key, value)
    band.WriteArray(values.astype(np.float32))


flux = np.zeros((CELLS, CELLS))
flux[4:12, 4:12] = np.where(np.indices((8, 8)).sum(axis=0) % 2 == 0, 2.0e6, 1.0e5)  # high flames beside low ones
write("dem.tif", np.full((CELLS, CELLS), 500.0), "m", "elevation", {})
write("heat_flux.tif", flux, "W m-2", "heat flux", {"time_s": "0"})
