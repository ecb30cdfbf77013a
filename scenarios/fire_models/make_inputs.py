#!/usr/bin/python3
"""Writes the sample files of this folder: one fire as a dozen programs would hand it out.

    /usr/bin/python3 make_inputs.py FOLDER        (numpy, netCDF4 and GDAL's Python bindings)

FOLDER holds case B of the propagation references (tests/data/propagation and its elevations): a fire that Pyretechnics and ELMFIRE
spread over a hill with two fuels. Their arrival times are real outputs of the two programs, cut to the part that burnt; the others are
those of Pyretechnics in the format that each program documents.
"""
import struct
import sys
from pathlib import Path

import numpy as np
from netCDF4 import Dataset
from osgeo import gdal, osr

gdal.UseExceptions()
source, here = Path(sys.argv[1]), Path(__file__).parent
TOP, LEFT, ROWS, COLS, CELL = 20, 0, 100, 90, 20.0
WEST, NORTH = 498500.0 + LEFT * CELL, 4001500.0 - TOP * CELL
SOUTH = NORTH - ROWS * CELL
NODATA = -9999.0
utm = osr.SpatialReference()
utm.ImportFromEPSG(32611)


def cut(name):
    return gdal.Open(str(source / name)).ReadAsArray()[TOP:TOP + ROWS, LEFT:LEFT + COLS].astype(float)


def tif(name, bands, kind=gdal.GDT_Float32, nodata=NODATA, units=()):
    out = gdal.GetDriverByName("GTiff").Create(str(here / name), COLS, ROWS, len(bands), kind, ["COMPRESS=DEFLATE", "PREDICTOR=%d" % (3 if kind == gdal.GDT_Float32 else 2)])
    out.SetGeoTransform((WEST, CELL, 0, NORTH, 0, -CELL))
    out.SetProjection(utm.ExportToWkt())
    for i, band in enumerate(bands):
        out.GetRasterBand(i + 1).WriteArray(band)
        if nodata is not None:
            out.GetRasterBand(i + 1).SetNoDataValue(nodata)
        if i < len(units):
            out.GetRasterBand(i + 1).SetUnitType(units[i])
    out.FlushCache()


def asc(name, values, cell=CELL, form="%.4f", prj=True):
    rows, cols = values.shape
    text = "ncols %d\nnrows %d\nxllcorner %g\nyllcorner %g\ncellsize %g\nNODATA_value -9999\n" % (cols, rows, WEST, SOUTH, cell)
    text += "\n".join(" ".join("-9999" if v == NODATA else form % v for v in row) for row in values) + "\n"
    (here / name).write_text(text)
    if prj:
        esri = utm.Clone()
        esri.MorphToESRI()
        (here / name).with_suffix(".prj").write_text(esri.ExportToWkt())


def record(data):
    return struct.pack("<i", len(data)) + data + struct.pack("<i", len(data))


dem, fuel = cut("B_dem_m.tif"), cut("B_fuel.tif")
arrival, elmfire, intensity = cut("B_toa_pyretechnics_s.tif"), cut("B_toa_elmfire_s.tif"), cut("B_fli_pyretechnics_kW_m.tif")
burnt = (arrival != NODATA) & (intensity != NODATA)
arrival[~burnt], intensity[~burnt] = NODATA, NODATA


def where_burnt(values):
    return np.where(burnt, values, NODATA)


tif("dem.tif", [np.round(dem, 2)], nodata=None, units=["m"])
tif("fuel.tif", [fuel], gdal.GDT_Int16, None)
# FARSITE: hours; two files that share one .prj.
asc("farsite.toa", where_burnt(arrival / 3600.0), form="%.5f")
asc("farsite.fli", where_burnt(intensity), form="%.1f")
# FlamMap, MTT: minutes and Btu/ft/s in one GeoTIFF.
tif("flammap.tif", [np.where(burnt, arrival / 60.0, 0.0), where_burnt(intensity / 3.461469333)])
# ELMFIRE: seconds.
tif("time_of_arrival_0000001_0002410.tif", [elmfire])
# Pyretechnics: minutes, kW/m.
tif("pyretechnics.tif", [where_burnt(arrival / 60.0), where_burnt(intensity)])
# ForeFire: seconds, infinity where the front did not come.
mem = gdal.GetDriverByName("MEM").Create("", COLS, ROWS, 1, gdal.GDT_Float32)
mem.SetGeoTransform((WEST, CELL, 0, NORTH, 0, -CELL))
mem.SetProjection(utm.ExportToWkt())
mem.GetRasterBand(1).WriteArray(np.where(burnt, arrival, np.inf))
mem.GetRasterBand(1).SetMetadataItem("NETCDF_VARNAME", "arrival_time_of_front")
gdal.GetDriverByName("netCDF").CreateCopy(str(here / "forefire.nc"), mem, options=["FORMAT=NC4", "COMPRESS=DEFLATE"])
# Cell2Fire: messages between cells counted from 1, minutes; surface intensity as .asc.
asc("fuels.asc", fuel, form="%d")
asc("SurfaceIntensity1.asc", where_burnt(intensity), form="%.0f", prj=False)
lines = []
for cell in sorted(np.flatnonzero(burnt), key=lambda c: arrival.flat[c]):
    row, col = divmod(int(cell), COLS)
    near = [(arrival[r, c], r * COLS + c + 1) for r in range(max(row - 1, 0), min(row + 2, ROWS)) for c in range(max(col - 1, 0), min(col + 2, COLS)) if burnt[r, c]]
    time, sender = min(near)
    if time < arrival[row, col]:
        lines.append("%d,%d,%.3f,%.1f" % (sender, cell + 1, arrival[row, col] / 60.0, CELL * 60.0 / (arrival[row, col] - time)))
(here / "MessagesFile01.csv").write_text("\n".join(lines) + "\n")
# QUIC-Fire: per cent of mass burnt every 200 s on cells of 40 m, one record, from the south.
coarse = arrival[::2, ::2]
for time in range(0, 2401, 200):
    share = np.where((coarse != NODATA) & (coarse <= time), np.minimum(100.0, 5.0 + (time - coarse) / 6.0), 0.0)
    (here / ("mburnt_integ-%05d.bin" % time)).write_bytes(record(share[::-1].astype("<f4").tobytes()))
# FDS: arrival at the nodes of a mesh (here: the centres of the cells) in one horizontal slice, 1e6 where the fire did not come.
nodes_x, nodes_y = np.arange(COLS) * CELL + CELL / 2, np.arange(ROWS) * CELL + CELL / 2
smv = "TITLE\n hill, level set\n\nNMESHES\n 1\n\nGRID   MESH_00000001\n %d %d 10 1\n\nPDIM\n %g %g %g %g 0 100 0 0 0\n\nTRNX\n 0\n" % (COLS - 1, ROWS - 1, nodes_x[0], nodes_x[-1], nodes_y[0], nodes_y[-1])
smv += "".join(" %d %g\n" % (i, x) for i, x in enumerate(nodes_x)) + "\nTRNY\n 0\n" + "".join(" %d %g\n" % (i, y) for i, y in enumerate(nodes_y))
smv += "\nSLCF  1 # STRUCTURED & 0 %d 0 %d 1 1 ! 1 0\n hill_1_1.sf\n FIRE ARRIVAL TIME\n time\n s\n" % (COLS - 1, ROWS - 1)
(here / "hill.smv").write_text(smv)
body = b"".join(record(text.ljust(30).encode()) for text in ("FIRE ARRIVAL TIME", "time", "s"))
body += record(struct.pack("<6i", 0, COLS - 1, 0, ROWS - 1, 1, 1))
body += record(struct.pack("<f", 2400.0)) + record(np.where(burnt, arrival, 1e6)[::-1].astype("<f4").tobytes())
(here / "hill_1_1.sf").write_bytes(body)
# Heat flux of a burn-out that the tests know: 400 kW/m2 at arrival, e-folding time 60 s.
def flux(time):
    return np.where(burnt & (arrival <= time), 400.0 * np.exp(-(time - arrival) / 60.0), 0.0)


def halved(values):
    return values.reshape(values.shape[0] // 2, 2, values.shape[1] // 2, 2).mean(axis=(1, 3))


# QUIC-Fire: kW/m2 on cells of 40 m; kW in the cells of three layers, which hold a half, a third and a sixth of it.
for time in (600, 900, 1200):
    south_first = halved(flux(time))[::-1].astype("<f4")
    (here / ("surfEnergy%05d.bin" % time)).write_bytes(record(south_first.tobytes()))
    layers = np.stack([south_first * 1600.0 * share for share in (1 / 2, 1 / 3, 1 / 6)]).astype("<f4")
    (here / ("fire-energy_to_atmos-%05d.bin" % time)).write_bytes(record(layers.tobytes()))
# FDS: heat release per area of the ground, by cells, in a coarse mesh in the west (40 m) and a fine one in the east (20 m).
SPLIT = 40
smv = "TITLE\n hill, heat release\n\nNMESHES\n 2\n"
for mesh, (first, last, cell) in enumerate(((0, SPLIT, 2 * CELL), (SPLIT, COLS, CELL)), 1):
    nx, ny, x0 = int((last - first) * CELL / cell), int(ROWS * CELL / cell), first * CELL
    smv += "\nGRID   MESH_%08d\n %d %d 10 1\n\nPDIM\n %g %g 0 %g 0 100 0 0 0\n" % (mesh, nx, ny, x0, last * CELL, ROWS * CELL)
    smv += "\nBNDC  %d 1\n hill_hrr_%d_1.bf\n HRRPUA\n hrrpua\n kW/m2\n" % (mesh, mesh)
    body = b"".join(record(text.ljust(30).encode()) for text in ("HRRPUA", "hrrpua", "kW/m2"))
    body += record(struct.pack("<i", 1)) + record(struct.pack("<9i", 0, nx, 0, ny, 0, 0, 3, 0, mesh))
    for time in (600, 900, 1200):
        cells = flux(time)[:, first:last]
        cells = (halved(cells) if cell > CELL else cells)[::-1].astype("<f4")
        # A cell stands with the node to its west and south; what lies beyond the last means nothing.
        body += record(struct.pack("<f", time)) + record(np.pad(cells, ((0, 1), (0, 1)), constant_values=-1.0).astype("<f4").tobytes())
    (here / ("hill_hrr_%d_1.bf" % mesh)).write_bytes(body)
(here / "hill_hrr.smv").write_text(smv)
# WRF-SFIRE: an idealised run (MAP_PROJ 0), atmosphere of 100 m, fire grid of 20 m with its padding; rows from the south. The fire heats the air
# as fire_tendency of WRF does, with the flux falling by exp(-z / 50 m), and the tendency is multiplied by the dry air.
AIR, SR = 100.0, 5
nx, ny, nz = int(COLS * CELL / AIR), int(ROWS * CELL / AIR), 16
level = 10.0 * 1.25 ** np.arange(nz + 1) - 10.0
layer = np.diff(level)
with Dataset(here / "wrfout_plume_d01", "w", format="NETCDF4") as wrf:
    for name, size in (("Time", None), ("DateStrLen", 19), ("west_east", nx), ("south_north", ny), ("bottom_top", nz), ("west_east_stag", nx + 1),
                       ("south_north_stag", ny + 1), ("bottom_top_stag", nz + 1), ("west_east_subgrid", (nx + 1) * SR), ("south_north_subgrid", (ny + 1) * SR)):
        wrf.createDimension(name, size)
    wrf.setncatts({"MAP_PROJ": np.int32(0), "DX": AIR, "DY": AIR, "START_DATE": "2021-08-12_20:00:00", "SIMULATION_START_DATE": "2021-08-12_20:00:00"})
    times = wrf.createVariable("Times", "S1", ("Time", "DateStrLen"))

    def put(name, unit, dims, record, values):
        if name not in wrf.variables:
            wrf.createVariable(name, "f4", ("Time",) + dims, zlib=True, shuffle=True).units = unit
        wrf.variables[name][record] = values

    fire, flat = ("south_north_subgrid", "west_east_subgrid"), ("south_north", "west_east")
    for record, time in enumerate((600, 900, 1200)):
        times[record] = np.array(list("2021-08-12_20:%02d:00" % (time // 60)), "S1")
        heat = flux(time)[::-1] * 1000.0
        coarse = heat.reshape(ny, SR, nx, SR).mean(axis=(1, 3))
        for name, unit, values in (("FGRNHFX", "W/m^2", heat), ("ZSF", "m", dem[::-1]), ("TIGN_G", "s", np.where(burnt & (arrival <= time), arrival, 1e6)[::-1]),
                                   ("FUEL_FRAC", "1", np.where(burnt & (arrival <= time), np.exp(-np.maximum(time - arrival, 0) / 60.0), 1.0)[::-1]),
                                   ("FGIP", "kg/m^2", np.full((ROWS, COLS), 1.5)), ("UF", "m/s", np.full((ROWS, COLS), 3.9)), ("VF", "m/s", np.full((ROWS, COLS), 1.0))):
            put(name, unit, fire, record, np.pad(values, ((0, SR), (0, SR)), constant_values=0.0))
        put("GRNHFX", "W/m^2", flat, record, coarse)
        mu, mub = np.full((ny, nx), 350.0), np.full((ny, nx), 86000.0)
        put("MU", "Pa", flat, record, mu)
        put("MUB", "Pa", flat, record, mub)
        put("C1H", "Dimensionless", ("bottom_top",), record, np.ones(nz))
        put("C2H", "Pa", ("bottom_top",), record, np.zeros(nz))
        profile = -np.diff(np.exp(-level / 50.0)) / (1.1 * 1004.5 * layer)
        put("RTHFRTEN", "K/s", ("bottom_top",) + flat, record, (mu + mub) * coarse * profile[:, None, None])
        put("U", "m s-1", ("bottom_top", "south_north", "west_east_stag"), record, 4.0 + 0.01 * level[:-1, None, None] + np.zeros((nz, ny, nx + 1)))
        put("V", "m s-1", ("bottom_top", "south_north_stag", "west_east"), record, np.ones((nz, ny + 1, nx)))
        put("W", "m s-1", ("bottom_top_stag",) + flat, record, 6.0 * (coarse / (coarse + 2e4)) * (level / 200.0 * np.exp(1.0 - level / 200.0))[:, None, None])
        ground = dem[::-1].reshape(ny, SR, nx, SR).mean(axis=(1, 3))
        put("PH", "m2 s-2", ("bottom_top_stag",) + flat, record, np.zeros((nz + 1, ny, nx)))
        put("PHB", "m2 s-2", ("bottom_top_stag",) + flat, record, 9.81 * (ground + level[:, None, None]))
# WindNinja: a wind from 255 degrees, 9 mph, faster over the hill, on cells of 100 m.
height = dem.reshape(20, 5, 18, 5).mean(axis=(1, 3))
asc("hill_255_9_100m_vel.asc", 9.0 * (0.9 + 0.3 * height / height.max()), 100.0, "%.2f")
asc("hill_255_9_100m_ang.asc", 255.0 + 15.0 * (np.linspace(-1, 1, 20)[:, None] * np.ones(18)), 100.0, "%.0f")
asc("hill_255_9_100m_cld.asc", 0.1 * np.ones((20, 18)), 100.0, "%.1f")
(here / "station.csv").write_text("# a mast of 10 m, every 15 minutes\ntime_s,speed_m_s,from_deg\n0,4.6,255\n900,4.9,262\n1800,4.2,248\n")
