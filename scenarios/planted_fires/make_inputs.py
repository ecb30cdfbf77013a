#!/usr/bin/python3
"""Makes the rasters of this scenario. Run it in this folder: python3 make_inputs.py (needs gdal_translate)."""
import os
import subprocess

CELLS, CELL_M = 240, 200.0
WEST_M, SOUTH_M = 476000.0, 4976000.0  # UTM 11N
FLAMING_W_M2 = 5.0e5  # of the scenario: heat flux / this = burning part of a cell

# Blocks of 5 x 5 cells (1 km2): first row, first column, burning area m2
FIRES = [(30, 30, 60.0), (30, 75, 200.0), (30, 120, 600.0), (30, 165, 2000.0), (30, 205, 6000.0),
         (75, 30, 20000.0), (75, 75, 400.0), (75, 120, 1200.0)]
# first row, first column, rows, columns
BRIGHT = [(150, 40, 10, 10), (190, 60, 6, 20)]
HOT_SOIL = [(140, 120, 20, 20), (190, 180, 30, 8)]
GROUND, BRIGHT_CODE, HOT_CODE = 1, 2, 3


def write(name, value, unit, options, time_s=None):
    with open("band.asc", "w") as file:
        file.write(f"ncols {CELLS}\nnrows {CELLS}\nxllcorner {WEST_M}\nyllcorner {SOUTH_M}\ncellsize {CELL_M}\n"
                   "NODATA_value -9999\n")
        for row in range(CELLS):
            file.write(" ".join(f"{value(row, col):g}" for col in range(CELLS)) + "\n")
    command = ["gdal_translate", "-q", "-a_srs", "EPSG:32611", "-co", "COMPRESS=DEFLATE", "-co", "ZLEVEL=9", *options,
               "band.asc", name]
    subprocess.run(command, check=True)
    os.remove("band.asc")
    if os.path.exists(name + ".aux.xml"):
        os.remove(name + ".aux.xml")


def inside(row, col, blocks):
    return any(r <= row < r + h and c <= col < c + w for r, c, h, w in blocks)


def heat_flux_W_m2(row, col):
    for r, c, area_m2 in FIRES:
        if r <= row < r + 5 and c <= col < c + 5:
            return FLAMING_W_M2 * area_m2 / (25 * CELL_M**2)
    return 0.0


def cover(row, col):
    return BRIGHT_CODE if inside(row, col, BRIGHT) else HOT_CODE if inside(row, col, HOT_SOIL) else GROUND


write("dem.tif", lambda row, col: 500.0, "m", ["-ot", "Float32"])
write("heat_flux.tif", heat_flux_W_m2, "W m-2", ["-ot", "Float32"])
write("arrival.tif", lambda row, col: 0.0 if inside(row, col, HOT_SOIL) else -9999.0, "s", ["-ot", "Float32"])
write("cover.tif", cover, "", ["-ot", "Byte", "-a_nodata", "0"])
