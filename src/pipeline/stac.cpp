#include "pipeline/stac.h"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/constants.h"
#include "base/files.h"

namespace pyroscene::pipeline {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kStacVersion = "1.0.0";

Json bounding_box(const std::vector<std::array<double, 2>>& ring) {
    std::array<double, 4> box{180.0, 90.0, -180.0, -90.0};
    for (const auto& [lon, lat] : ring) {
        box[0] = std::min(box[0], lon);
        box[1] = std::min(box[1], lat);
        box[2] = std::max(box[2], lon);
        box[3] = std::max(box[3], lat);
    }
    return box;
}

Json eo_bands(const ProductJob& job) {
    Json bands = Json::array();
    for (const int b : job.bands) {
        const auto& band = job.sensor.bands[static_cast<std::size_t>(b)];
        bands.push_back({{"name", band.id}, {"center_wavelength", band.centre_um}, {"full_width_half_max", band.fwhm_um}});
    }
    return bands;
}

bool is_native(const std::filesystem::path& file) { return file.parent_path().filename() == "native"; }

std::string native_type(const std::string& name, const std::string& extension) {
    if (extension == ".tif")
        return name.find("orthomosaic") == std::string::npos ? "image/tiff; application=geotiff"
                                                             : "image/tiff; application=geotiff; profile=cloud-optimized";
    return extension == ".hdf"    ? "application/x-hdf"
           : extension == ".nc"   ? "application/x-netcdf"
           : extension == ".json" ? "application/json"
           : extension == ".csv"  ? "text/csv"
           : extension.empty()    ? "application/octet-stream"
                                  : "text/plain";  // headers and gains of ENVI cubes
}

Json asset(const ProductJob& job, const std::filesystem::path& file) {
    const auto name = file.filename().string(), extension = file.extension().string();
    const bool ortho = name.starts_with("ortho_");
    Json a = {{"href", "./" + file.lexically_relative(job.files.folder).generic_string()}};
    if (is_native(file)) {
        a["type"] = native_type(name, extension);
        a["roles"] = Json::array({"data", "native"});
        return a;
    }
    if (extension == ".tif") {
        a["type"] = ortho ? "image/tiff; application=geotiff; profile=cloud-optimized" : "image/tiff; application=geotiff";
        a["roles"] = Json::array({name.starts_with("geolocation") || name.starts_with("truth") ? "metadata" : "data"});
        if (name.find("radiance") != std::string::npos) {
            a["eo:bands"] = eo_bands(job);
            Json bands = Json::array();
            for (std::size_t i = 0; i < job.bands.size(); ++i)
                bands.push_back({{"data_type", "float32"}, {"nodata", "nan"}, {"unit", "W m-2 sr-1 um-1"}});
            a["raster:bands"] = bands;
        }
    } else if (extension == ".png") {
        a["type"] = "image/png";
        a["roles"] = Json::array({"overview"});
    } else if (extension == ".qml") {
        a["type"] = "application/xml";
        a["roles"] = Json::array({"metadata"});
    } else {
        a["type"] = extension == ".gpkg"  ? "application/geopackage+sqlite3"
                    : extension == ".kmz" ? "application/vnd.google-earth.kmz"
                                          : "application/geo+json";
        a["roles"] = Json::array({"data"});
    }
    return a;
}

/// Name of an asset: that of its file, with what it is where several files share a name.
std::string asset_key(const std::filesystem::path& file) {
    if (is_native(file)) return "native_" + file.filename().string();
    const auto extension = file.extension().string();
    if (extension == ".qml") return file.stem().string() + "_style";
    return file.stem().string() + (extension == ".kmz" ? "_kmz" : "");
}

}  // namespace

std::filesystem::path stac_item_path(const AcquisitionFiles& files) {
    return files.folder / ("item" + files.suffix + ".json");
}

std::string stac_item_fingerprint(const std::filesystem::path& item) {
    std::ifstream in(item);
    const auto json = Json::parse(in, nullptr, false);
    if (json.is_discarded() || !json.contains("properties")) return {};
    return json["properties"].value("pyroscene:fingerprint", "");
}

void write_stac_item(const ProductJob& job, const StacImage& image) {
    const auto& a = job.acquisition;
    Json ring = Json::array();
    for (const auto& point : image.footprint_lon_lat) ring.push_back(point);
    const auto& grid = image.ortho_grid;
    Json properties = {{"datetime", UtcTime{job.scenario.start.unix_s + a.time_s}.iso8601()},
                       {"title", fmt::format("{} {} (synthetic)", job.scenario.name, a.id)},
                       {"platform", job.sensor.platform_name},
                       {"instruments", Json::array({job.sensor.id})},
                       {"gsd", image.gsd_m},
                       {"view:off_nadir", image.off_nadir_deg},
                       {"view:incidence_angle", image.incidence_deg},
                       {"view:sun_azimuth", image.sun_azimuth_deg},
                       {"view:sun_elevation", image.sun_elevation_deg},
                       {"proj:wkt2", grid.crs_wkt},
                       {"proj:shape", Json::array({grid.rows, grid.cols})},
                       {"proj:transform", Json::array({grid.cell_m, 0.0, grid.west_m, 0.0, -grid.cell_m, grid.north_m})},
                       {"processing:software", {{"pyroscene", version()}}},
                       {"pyroscene:synthetic", true},
                       {"pyroscene:fingerprint", job.fingerprint}};
    Json item = {{"type", "Feature"},
                 {"stac_version", kStacVersion},
                 {"stac_extensions", Json::array({"https://stac-extensions.github.io/eo/v1.1.0/schema.json",
                                                  "https://stac-extensions.github.io/projection/v1.1.0/schema.json",
                                                  "https://stac-extensions.github.io/raster/v1.1.0/schema.json",
                                                  "https://stac-extensions.github.io/view/v1.0.0/schema.json",
                                                  "https://stac-extensions.github.io/processing/v1.1.0/schema.json"})},
                 {"id", job.scenario.name + "_" + a.id + job.files.suffix},
                 {"geometry", {{"type", "Polygon"}, {"coordinates", Json::array({ring})}}},
                 {"bbox", bounding_box(image.footprint_lon_lat)},
                 {"properties", properties},
                 {"links", Json::array({{{"rel", "root"}, {"href", "../catalog.json"}, {"type", "application/json"}},
                                        {{"rel", "parent"}, {"href", "../catalog.json"}, {"type", "application/json"}}})},
                 {"assets", Json::object()}};
    for (const auto& file : image.assets) item["assets"][asset_key(file)] = asset(job, file);
    write_text_file(stac_item_path(job.files), item.dump(2) + "\n");
}

void write_catalog(const scenario::Scenario& scenario, const std::filesystem::path& output) {
    Json links = Json::array({{{"rel", "root"}, {"href", "./catalog.json"}, {"type", "application/json"}}});
    for (const auto& a : scenario.acquisitions) {
        std::vector<std::string> items;
        std::error_code ignored;
        for (const auto& entry : std::filesystem::directory_iterator(output / a.id, ignored)) {
            const auto name = entry.path().filename().string();
            if (name.starts_with("item") && name.ends_with(".json")) items.push_back(name);
        }
        std::sort(items.begin(), items.end());
        for (const auto& name : items)
            links.push_back({{"rel", "item"}, {"href", "./" + a.id + "/" + name}, {"type", "application/geo+json"}});
    }
    const Json catalog = {
        {"type", "Catalog"},
        {"stac_version", kStacVersion},
        {"id", scenario.name},
        {"title", scenario.title.empty() ? scenario.name : scenario.title},
        {"description", "Synthetic remote-sensing images of a simulated wildland fire, made by Pyroscene."},
        {"links", links}};
    write_text_file(output / "catalog.json", catalog.dump(2) + "\n");
}

}  // namespace pyroscene::pipeline
