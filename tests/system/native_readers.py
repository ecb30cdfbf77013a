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


def metadata_of(path, band=0):
    from osgeo import gdal
    dataset = gdal.Open(path)  # must outlive its band
    return (dataset.GetRasterBand(band) if band else dataset).GetMetadata()


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


def placed(folder, suffix, shape, band):
    """A plane of radiance.tif and geolocation.tif laid into the whole scans and lines of the level 1B file."""
    from osgeo import gdal
    dataset = gdal.Open(os.path.join(folder, f"radiance{suffix}.tif"))
    metadata = dataset.GetMetadata()
    out = []
    for source in (dataset.GetRasterBand(band + 1).ReadAsArray(),
                   *geotiff(os.path.join(folder, f"geolocation{suffix}.tif"))[:4]):
        plane = np.full(shape, np.nan)
        line, sample = int(metadata["FIRST_LINE_OF_SCAN"]), int(metadata["FIRST_SAMPLE"])
        plane[line:line + source.shape[0], sample:sample + source.shape[1]] = source
        out.append(plane)
    return out


def satpy_scene(reader, folder, pattern):
    import glob
    import warnings
    warnings.filterwarnings("ignore")
    try:
        import dask
        import satpy
    except ImportError:
        sys.exit(ABSENT)
    dask.config.set(scheduler="synchronous")  # HDF4 is not for several threads
    files = glob.glob(os.path.join(folder, "native", pattern))
    require(len(files) >= 2, f"files {files}")
    return satpy.Scene(reader=reader, filenames=files)


def check_level1b(reader, pattern, folder, suffix, bands):
    """Radiance, longitude, latitude and view zenith angle as satpy reads them."""
    scene = satpy_scene(reader, folder, pattern)
    for index, name in enumerate(bands):
        scene.load([name], calibration="radiance")
        read = np.asarray(scene[name].values, dtype=float)
        truth, longitude, latitude, _, zenith = placed(folder, suffix, read.shape, index)
        both = np.isfinite(read) & np.isfinite(truth)
        require(both.sum() > 20, f"{name}: {both.sum()} pixels, {np.isfinite(truth).sum()} rendered")
        saturation = metadata_of(os.path.join(folder, f"radiance{suffix}.tif"), index + 1)["saturation_radiance"]
        step = max(np.nanmax(truth), float(saturation)) / 32767
        require(np.abs(read - truth)[both].max() <= 0.6 * step, f"{name}: radiance differs by {np.abs(read - truth)[both].max()}")
        require(not np.isfinite(read[~np.isfinite(truth)]).any(), f"{name}: radiance where there is none")
        longitudes, latitudes = (np.asarray(a) for a in scene[name].attrs["area"].get_lonlats())
        require(np.abs(longitudes - longitude)[both].max() < 1e-4, "longitudes")
        require(np.abs(latitudes - latitude)[both].max() < 1e-4, "latitudes")
        scene.load(["satellite_zenith_angle"], **({"resolution": 1000} if reader == "modis_l1b" else {}))
        angle = np.asarray(scene["satellite_zenith_angle"].values, dtype=float)
        require(np.nanmax(np.abs(angle - zenith)[both]) < 0.006, "view zenith angles")
        scene.unload()


def viirs(folder):
    check_level1b("viirs_l1b", "VNP0?MOD*.nc", folder, "_m", ["M11", "M13"])
    check_level1b("viirs_l1b", "VNP0?IMG*.nc", folder, "_i", ["I04", "I05"])
    scene = satpy_scene("viirs_l1b", folder, "VNP0?IMG*.nc")
    scene.load(["I05"], calibration="brightness_temperature")
    check_temperature(np.asarray(scene["I05"].values, dtype=float), folder, "_i", 1, 0.05)
    scene = satpy_scene("viirs_l1b", folder, "VNP0?MOD*.nc")
    scene.load(["M11"], calibration="reflectance")
    require(0 < np.nanmedian(scene["M11"].values) < 100, "reflectance of M11 [%]")


def modis(folder):
    check_level1b("modis_l1b", "MOD0*.hdf", folder, "", ["21", "31"])
    scene = satpy_scene("modis_l1b", folder, "MOD0*.hdf")
    scene.load(["31"], calibration="brightness_temperature")
    # satpy turns radiance into temperature by one wavenumber per band, we by the response of the band.
    check_temperature(np.asarray(scene["31"].values, dtype=float), folder, "", 1, 0.5)


def check_temperature(read, folder, suffix, band, tolerance):
    own = geotiff(os.path.join(folder, f"brightness_temperature{suffix}.tif"))[band]
    metadata = metadata_of(os.path.join(folder, f"radiance{suffix}.tif"))
    line, sample = int(metadata["FIRST_LINE_OF_SCAN"]), int(metadata["FIRST_SAMPLE"])
    part = read[line:line + own.shape[0], sample:sample + own.shape[1]]
    both = np.isfinite(part) & np.isfinite(own)
    require(both.sum() > 20, "too few temperatures")
    require(np.abs(part - own)[both].max() < tolerance, f"temperature differs by {np.abs(part - own)[both].max()} K")


def shift_px(image, reference):
    """Displacement of an image against another on the same grid, in cells: least squares over gradients."""
    rows, cols = np.gradient(reference)
    difference = image - reference
    use = np.isfinite(difference) & np.isfinite(rows) & np.isfinite(cols)
    require(use.sum() > 500, f"{use.sum()} cells in common")
    system = np.stack([-cols[use], -rows[use]], 1)
    return np.linalg.lstsq(system, difference[use], rcond=None)[0]


def warped(source, like, band, options):
    from osgeo import gdal
    gdal.UseExceptions()
    target = gdal.Open(like)
    west, cell, _, north, _, _ = target.GetGeoTransform()
    bounds = (west, north - cell * target.RasterYSize, west + cell * target.RasterXSize, north)
    out = gdal.Warp("", source, format="MEM", outputBounds=bounds, xRes=cell, yRes=cell, dstSRS=target.GetProjection(),
                    resampleAlg="bilinear", dstNodata=float("nan"), **options)
    return out.GetRasterBand(band).ReadAsArray(), target.GetRasterBand(band).ReadAsArray()


def frame(folder, stem, dem):
    """gdalwarp -rpc over the terrain lands on the ortho image; the orientation file projects ground points to their pixels."""
    import json
    try:
        from osgeo import gdal  # noqa: F401
    except ImportError:
        sys.exit(ABSENT)
    image, reference = warped(os.path.join(folder, "native", stem + "_frame.tif"), os.path.join(folder, "ortho_radiance.tif"),
                              3, {"rpc": True, "transformerOptions": ["RPC_DEM=" + dem]})
    shift = shift_px(image, reference)
    require(np.abs(shift).max() < 0.1, f"gdalwarp -rpc lands {shift} cells off")
    with open(os.path.join(folder, "native", stem + "_orientation.json")) as f:
        o = json.load(f)
    require(o["rpc_largest_residual_px"] < 0.02, f"RPC misses the camera by {o['rpc_largest_residual_px']} pixels")
    where = geotiff(os.path.join(folder, "geolocation.tif"))
    from osgeo import osr
    ortho = gdal.Open(os.path.join(folder, "ortho_radiance.tif"))
    crs = osr.SpatialReference(wkt=ortho.GetProjection())
    wgs84 = osr.SpatialReference()
    wgs84.ImportFromEPSG(4326)
    for s in (crs, wgs84):
        s.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    to_map = osr.CoordinateTransformation(wgs84, crs)
    lines, samples = np.nonzero(np.isfinite(where[0]))
    worst = 0.0
    for k in range(0, len(lines), len(lines) // 50):
        line, sample = lines[k], samples[k]
        ground = np.array(to_map.TransformPoint(*[float(v) for v in where[:3, line, sample]]))
        x, y, z = np.array(o["rotation_map_to_camera"]) @ (ground - o["position"]["map_xyz_m"])
        focal_px = o["camera"]["focal_length_mm"] / o["camera"]["pixel_pitch_um"] * 1e3
        at = (o["camera"]["principal_point_px"][0] - focal_px * x / z, o["camera"]["principal_point_px"][1] + focal_px * y / z)
        worst = max(worst, abs(at[0] - sample), abs(at[1] - line))
    require(worst < 0.5, f"the orientation file projects ground points {worst} pixels off")
    omega, phi, kappa = np.radians(o["omega_phi_kappa_deg"])
    c, s = np.cos, np.sin
    turn = (np.array([[c(kappa), s(kappa), 0], [-s(kappa), c(kappa), 0], [0, 0, 1]])
            @ np.array([[c(phi), 0, -s(phi)], [0, 1, 0], [s(phi), 0, c(phi)]])
            @ np.array([[1, 0, 0], [0, c(omega), s(omega)], [0, -s(omega), c(omega)]]))
    require(np.allclose(turn, o["rotation_map_to_camera"], atol=1e-9), "omega, phi, kappa do not give the rotation")


def geoloc(folder, suffix="", most=0.25):
    """gdalwarp -geoloc of the image in sensor geometry lands on the ortho image, to so many of its cells."""
    try:
        from osgeo import gdal  # noqa: F401
    except ImportError:
        sys.exit(ABSENT)
    image, reference = warped(os.path.join(folder, f"radiance{suffix}.tif"), os.path.join(folder, f"ortho_radiance{suffix}.tif"),
                              1, {"geoloc": True})
    shift = shift_px(image, reference)
    require(np.abs(shift).max() < float(most), f"gdalwarp -geoloc lands {shift} cells off")
    both = np.isfinite(image) & np.isfinite(reference)
    likeness = np.corrcoef(image[both], reference[both])[0, 1]
    require(likeness > 0.9, f"gdalwarp -geoloc gives another picture (correlation {likeness})")


if __name__ == "__main__":
    {"aviris": aviris, "viirs": viirs, "modis": modis, "frame": frame, "geoloc": geoloc}[sys.argv[1]](*sys.argv[2:])
