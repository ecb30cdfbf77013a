"""Opens native forms with the programs their users have. Called by native_test.cpp: native_readers.py WHAT FOLDER...
Exit codes: 0 all agrees, 1 something does not, 77 the program to test with is not installed."""
import os
import sys

import numpy as np

ABSENT = 77


def require(condition, text):
    if not condition:
        print(text)
        sys.exit(1)


def geotiff(path):
    from osgeo import gdal
    gdal.UseExceptions()
    dataset = gdal.Open(path)
    pixels = dataset.ReadAsArray()
    return pixels[None] if pixels.ndim == 2 else pixels


def aviris(folder, stem):
    """Spectral Python: wavelengths, radiance = counts / gain / 0.1 of the GeoTIFF, look-up table reproduces the ort cube."""
    try:
        import spectral
    except ImportError:
        sys.exit(ABSENT)
    native = os.path.join(folder, "native", stem)

    def cube(name, dtype):
        image = spectral.open_image(f"{native}{name}.hdr")
        return image, np.array(image.load(dtype=dtype))

    image, counts = cube("_img", "int16")
    require(abs(image.bands.centers[0] - 647.974) < 1e-3, f"wavelengths {image.bands.centers}")
    require(image.bands.band_unit == "Nanometers", f"unit {image.bands.band_unit}")
    gain = np.loadtxt(native + ".gain")
    require((gain[:, 0] == [300, 600, 1200]).all(), f"gains {gain}")
    radiance = geotiff(os.path.join(folder, "radiance.tif")).transpose(1, 2, 0)
    seen = np.isfinite(radiance[..., 0])
    require((counts[~seen] == -50).all(), "pixels without radiance are not -50")
    inside = seen[..., None] & (counts < 32767)
    off = np.abs(counts - 0.1 * radiance * gain[:, 0])[inside]
    require(off.size > 1000 and off.max() <= 0.51, f"counts differ by {off.max()}")
    ort = cube("_ort_img", "int16")[1]
    glt = cube("_ort_glt", "int32")[1]
    hit = glt[..., 0] != 0
    again = np.where(hit[..., None], counts[np.abs(glt[..., 1]) - 1, np.abs(glt[..., 0]) - 1], -50)
    require(hit.mean() > 0.3 and (again == ort).all(), "the look-up table does not reproduce the ort cube")
    igm = cube("_ort_igm", "float64")[1]
    west, north, cell = [float(image_value) for image_value in np.array(
        spectral.open_image(f"{native}_ort_glt.hdr").metadata["map info"])[[3, 4, 5]]]
    row, col = np.nonzero(glt[..., 0] > 0)
    point = igm[glt[row, col, 1] - 1, glt[row, col, 0] - 1]
    require((np.floor((point[:, 0] - west) / cell) == col).all() and (np.floor((north - point[:, 1]) / cell) == row).all(),
            "positive entries of the look-up table are not the pixels whose centres lie in the cell")
    obs = cube("_obs", "float64")[1]
    where = geotiff(os.path.join(folder, "geolocation.tif")).transpose(1, 2, 0)
    require(np.allclose(obs[seen][:, [0, 1, 2, 3, 4]], where[seen][:, [7, 4, 3, 6, 5]]), "obs differs from geolocation.tif")
    require((np.abs(obs[seen][:, 8]) <= 1).all() and (obs[seen][:, 10] > 0.98).all(), "obs out of range")


if __name__ == "__main__":
    {"aviris": aviris}[sys.argv[1]](*sys.argv[2:])
