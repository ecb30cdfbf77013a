#!/usr/bin/python3
"""Statistics of pixels of one or several rasters of equal size.

    pixel_statistics.py EXPRESSION MASK name=raster.tif:band ...

prints one line "count minimum 5%-quantile median mean maximum sum" of EXPRESSION (numpy, in the names given) over the pixels
where MASK holds and EXPRESSION is finite. Needs Debian's python3-gdal (which brings numpy).
"""
import sys

import numpy
from osgeo import gdal

gdal.UseExceptions()


def plane(source):
    path, band = source.rsplit(":", 1)
    dataset = gdal.Open(path)  # must outlive its band
    values = dataset.GetRasterBand(int(band))
    data = values.ReadAsArray().astype(numpy.float64)
    nodata = values.GetNoDataValue()
    if nodata is not None and not numpy.isnan(nodata):
        data[data == nodata] = numpy.nan
    return data


def main(arguments):
    expression, mask = arguments[:2]
    names = {"numpy": numpy, "sigma": 5.670374419e-8}
    for argument in arguments[2:]:
        name, source = argument.split("=", 1)
        names[name] = plane(source)
    values = eval(expression, {"__builtins__": {}}, names)
    chosen = eval(mask, {"__builtins__": {}}, names)
    values = values[chosen & numpy.isfinite(values)]
    if values.size == 0:
        sys.exit(f"pixel_statistics: no pixel where {mask}")
    print(values.size, *(f"{v:.6g}" for v in (values.min(), numpy.quantile(values, 0.05), numpy.median(values),
                                              values.mean(), values.max(), values.sum())))


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main(sys.argv[1:])
