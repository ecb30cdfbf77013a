#include "pipeline/products_phase.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <nlohmann/json.hpp>

#include "analysis/ortho.h"
#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "drawing/qgis_style.h"
#include "drawing/quicklook.h"
#include "gis/tiff_writer.h"
#include "pipeline/fronts.h"
#include "pipeline/incident_map.h"
#include "pipeline/native.h"
#include "pipeline/rendered_image.h"
#include "pipeline/spectrum_file.h"
#include "pipeline/stac.h"
#include "pipeline/state_file.h"
#include "radiometry/planck.h"

namespace pyroscene::pipeline {
namespace {

/// A named multi-band product in sensor geometry; its ortho is the same bands on the map.
struct Product {
    std::string stem;
    std::vector<gis::OutputBand> bands;
    std::function<std::vector<float>(std::size_t band)> plane;  ///< [line][sample], made anew at each call
    bool in_sensor_geometry = true;
};

Product brightness_product(const ProductJob& job, const RenderedImage& r) {
    Product p{"brightness_temperature", {}, {}};
    for (const int b : job.bands) {
        const auto& band = job.sensor.bands[static_cast<std::size_t>(b)];
        p.bands.push_back({band.id + " brightness temperature", "K", band.centre_um, band.fwhm_um, {{"band_id", band.id}}});
    }
    p.plane = [&job, &r](std::size_t k) {
        const auto& band = job.sensor.bands[static_cast<std::size_t>(job.bands[k])];
        // A thermometer is a table of a few hundred integrals: worth making for more pixels than that.
        constexpr std::size_t kFew = 256;
        std::optional<radiometry::BandThermometer> table;
        if (r.n > kFew) table.emplace(band.response);
        auto plane = r.radiance_plane(k);
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, plane.size()), [&](const auto& part) {
            for (std::size_t i = part.begin(); i < part.end(); ++i)
                plane[i] = static_cast<float>(table ? table->temperature_K(plane[i])
                                                    : radiometry::band_brightness_temperature(plane[i], band.response));
        });
        return plane;
    };
    return p;
}

Product fractions_product(const RenderedImage& r) {
    Product p{"fractions", {}, [&r](std::size_t k) { return r.truth_plane(kFlame + k); }};
    for (std::size_t k = kFlame; k <= kSmoke; ++k)
        p.bands.push_back({r.truth->info().bands[k].description, "1", {}, {}, {}});
    return p;
}

Product frp_product(const RenderedImage& r) {
    return {
        "frp",
        {{"fire radiative power per area", "W m-2", {}, {}, {}}, {"fire radiative power of the pixel", "MW", {}, {}, {}}},
        [&r](std::size_t k) {
            auto plane = r.truth_plane(kExitance);
            if (k == 1)
                for (std::size_t i = 0; i < r.n; ++i) plane[i] *= r.pixel_area_m2[i] * 1e-6F;
            return plane;
        }};
}

Product radiance_product(const RenderedImage& r) {
    return {"radiance", r.radiance->info().bands, [&r](std::size_t k) { return r.radiance_plane(k); }, false};
}

gis::OutputRaster raster_of(const ProductJob& job, const Product& product) {
    gis::OutputRaster out;
    out.bands = product.bands;
    out.compression = gis::compression_of_image(out.bands.size());
    out.acquisition_time = UtcTime{job.scenario.start.unix_s + job.acquisition.time_s}.iso8601();
    out.metadata = {{"SCENARIO", job.scenario.name},
                    {"ACQUISITION", job.acquisition.id},
                    {"SENSOR", job.sensor.id},
                    {"CAMERA_GROUP", job.group.id},
                    {"FINGERPRINT", job.fingerprint}};
    return out;
}

gis::TiffWriter image_writer(const ProductJob& job, const RenderedImage& r, const Product& product) {
    auto out = raster_of(job, product);
    out.cols = r.samples;
    out.rows = r.lines;
    out.geolocation = job.files.geolocation();
    return {job.files.file(product.stem), std::move(out)};
}

/// How QGIS shows an ortho product: ranges that are the same for every image of the band.
drawing::RasterStyle style_of(const Product& product, double gsd_m) {
    constexpr double kBest_um = 3.96, kCoarse_m = 200.0;
    std::size_t best = 0;
    const auto off_um = [&](std::size_t k) { return std::abs(product.bands[k].wavelength_um.value_or(0.0) - kBest_um); };
    for (std::size_t k = 1; k < product.bands.size(); ++k)
        if (off_um(k) < off_um(best)) best = k;
    const int band = static_cast<int>(best) + 1;
    const auto& unit = product.bands[best].unit;
    if (product.stem == "radiance")
        return {band, unit, drawing::radiance_colours(product.bands[best].wavelength_um.value_or(kBest_um))};
    if (product.stem == "brightness_temperature") return {band, unit, drawing::inferno(300.0, 1200.0)};
    if (product.stem == "fractions") return {2, "", drawing::inferno(0.0, 1.0)};  // of front
    // Power: of the pixel where pixels are as large as those of fire satellites, else per area.
    return gsd_m >= kCoarse_m ? drawing::RasterStyle{2, "MW", drawing::power_ladder(250.0)}
                              : drawing::RasterStyle{1, "W m-2", drawing::power_ladder(5e4)};
}

gis::CogWriter map_writer(const ProductJob& job, const RenderedImage& r, const Product& product, const MapGrid& grid) {
    auto out = raster_of(job, product);
    out.grid = grid;
    out.cols = grid.cols;
    out.rows = grid.rows;
    drawing::write_qgis_style(job.files.file("ortho_" + product.stem), style_of(product, r.gsd_m));
    return {job.files.file("ortho_" + product.stem), std::move(out)};
}

/// In sensor geometry and, with a look-up, on the map; one band in memory.
void write_product(const ProductJob& job, const RenderedImage& r, const Product& product,
                   const analysis::OrthoLookup* lookup) {
    std::optional<gis::TiffWriter> image;
    std::optional<gis::CogWriter> map;
    if (product.in_sensor_geometry) image.emplace(image_writer(job, r, product));
    if (lookup != nullptr) map.emplace(map_writer(job, r, product, lookup->grid));
    for (std::size_t k = 0; k < product.bands.size() && (image || map); ++k) {
        const auto plane = product.plane(k);
        if (image) image->write({k, 1, 0, r.lines}, plane);
        if (map) map->write_band(k, analysis::ortho_resample(*lookup, r.samples, r.lines, plane, false));
    }
    if (image) image->finish();
    if (map) map->finish();
}

/// One point per pixel with flame or front in it.
void write_fire_pixels(const ProductJob& job, const RenderedImage& r) {
    using Json = nlohmann::ordered_json;
    Json features = Json::array();
    const auto flame = r.truth_plane(kFlame), front = r.truth_plane(kFront), power = frp_product(r).plane(1);
    const auto round_to = [](double v, double step) { return std::round(v / step) * step; };
    for (std::size_t i = 0; i < r.n; ++i) {
        constexpr double kSmallest = 1e-3;
        if (!(flame[i] + front[i] > kSmallest)) continue;
        const double power_MW = power[i];
        features.push_back(
            {{"type", "Feature"},
             {"geometry",
              {{"type", "Point"},
               {"coordinates", {round_to(r.where(kLongitude)[i], 1e-7), round_to(r.where(kLatitude)[i], 1e-7)}}}},
             {"properties",
              {{"sample", i % static_cast<std::size_t>(r.samples)},
               {"line", i / static_cast<std::size_t>(r.samples)},
               {"frp_MW", std::isfinite(power_MW) ? Json(round_to(power_MW, 1e-6)) : Json(nullptr)},
               {"flame_fraction", round_to(flame[i], 1e-4)},
               {"front_fraction", round_to(front[i], 1e-4)}}}});
    }
    const Json collection = {{"type", "FeatureCollection"},
                             {"name", job.acquisition.id + " fire pixels (synthetic)"},
                             {"synthetic", true},
                             {"datetime", UtcTime{job.scenario.start.unix_s + job.acquisition.time_s}.iso8601()},
                             {"features", features}};
    write_text_file(job.files.folder / ("fire_pixels" + job.files.suffix + ".geojson"), collection.dump() + "\n");
}

/// The model's fire at the frame of the acquisition, as vectors.
void write_vectors(const ProductJob& job, const std::filesystem::path& output) {
    const auto frame = inputs::frame_at(job.inputs.frames, job.acquisition.time_s, job.acquisition.id);
    const auto path = state_path(output, job.inputs.frames[frame].time_s);
    const auto state = read_state(path, job.inputs.grid, {});
    constexpr double kHeat_K = 100.0;  ///< above ambient: what an interpreter would draw as heat
    write_incident_map(job.files.folder, job.files.suffix,
                       {job.scenario.name, job.acquisition.id, UtcTime{job.scenario.start.unix_s + state.time_s}.iso8601(),
                        job.scenario.fire.ambient_temperature_K + kHeat_K},
                       state, fronts_path(path));
}

void write_picture(const ProductJob& job, const RenderedImage& r, const Product& brightness) {
    constexpr std::size_t kMostPanels = 4;
    std::vector<drawing::QuicklookPanel> panels;
    const std::size_t step = (job.bands.size() + kMostPanels - 1) / kMostPanels;
    for (std::size_t k = 0; k < job.bands.size(); k += step) {
        const auto& band = job.sensor.bands[static_cast<std::size_t>(job.bands[k])];
        panels.push_back({fmt::format("{} {:.2f} um radiance", band.id, band.centre_um), "W/(m2 sr um)", r.samples, r.lines,
                          r.radiance_plane(k), true});
    }
    // The longest wavelength also as temperature, if it is thermal.
    std::size_t warmest = 0;
    for (std::size_t k = 0; k < job.bands.size(); ++k)
        if (job.sensor.bands[static_cast<std::size_t>(job.bands[k])].centre_um >
            job.sensor.bands[static_cast<std::size_t>(job.bands[warmest])].centre_um)
            warmest = k;
    const auto& band = job.sensor.bands[static_cast<std::size_t>(job.bands[warmest])];
    constexpr double kThermal_um = 3.0;
    if (job.scenario.products.brightness_temperature && band.centre_um > kThermal_um && panels.size() < kMostPanels) {
        panels.push_back({band.id + " brightness temperature", "K", r.samples, r.lines, brightness.plane(warmest), false});
    }
    const auto caption = fmt::format("{}  {}  {}  {}  SYNTHETIC", job.scenario.name, job.acquisition.id, job.sensor.id,
                                     UtcTime{job.scenario.start.unix_s + job.acquisition.time_s}.iso8601());
    drawing::write_quicklook(job.files.folder / ("quicklook" + job.files.suffix + ".png"), caption, panels, r.gsd_m);
}

/// An image of one pixel is a spectrum: a table, and a diagram in place of a picture.
void write_spectrum(const ProductJob& job, const RenderedImage& r, const Product& brightness) {
    PixelSpectrum s{fmt::format("{}  {}  {}  SYNTHETIC", job.scenario.name, job.acquisition.id, job.sensor.id), {}, {}, {}};
    for (std::size_t k = 0; k < job.bands.size(); ++k) {
        s.radiance_W_m2_sr_um.push_back(r.radiance_plane(k).front());
        s.brightness_temperature_K.push_back(brightness.plane(k).front());
    }
    for (const int b : job.bands) s.bands.push_back(&job.sensor.bands[static_cast<std::size_t>(b)]);
    write_spectrum_table(job.files.folder / ("spectrum" + job.files.suffix + ".csv"), s);
    if (job.scenario.products.quicklook)
        write_spectrum_plot(job.files.folder / ("quicklook" + job.files.suffix + ".png"), s);
}

std::vector<std::array<double, 2>> footprint(const RenderedImage& r) {
    // Along the image's rim, eight points a side, skipping pixels that see nothing; then counter-clockwise.
    std::vector<std::array<double, 2>> ring;
    constexpr int kPerSide = 8;
    const auto add = [&](int sample, int line) {
        const std::size_t i =
            static_cast<std::size_t>(line) * static_cast<std::size_t>(r.samples) + static_cast<std::size_t>(sample);
        if (!std::isnan(r.where(kLongitude)[i])) ring.push_back({r.where(kLongitude)[i], r.where(kLatitude)[i]});
    };
    for (int k = 0; k < kPerSide; ++k) add(k * (r.samples - 1) / kPerSide, 0);
    for (int k = 0; k < kPerSide; ++k) add(r.samples - 1, k * (r.lines - 1) / kPerSide);
    for (int k = 0; k < kPerSide; ++k) add(r.samples - 1 - k * (r.samples - 1) / kPerSide, r.lines - 1);
    for (int k = 0; k < kPerSide; ++k) add(0, r.lines - 1 - k * (r.lines - 1) / kPerSide);
    double twice_area = 0.0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const auto& a = ring[i];
        const auto& b = ring[(i + 1) % ring.size()];
        twice_area += a[0] * b[1] - b[0] * a[1];
    }
    if (twice_area < 0.0) std::reverse(ring.begin(), ring.end());
    if (!ring.empty()) ring.push_back(ring.front());
    return ring;
}

/// Angle between the vertical and the line of sight at the sensor, from the view zenith and range at the ground, over a sphere.
double off_nadir_deg(double view_zenith_deg, double range_m) {
    const double zenith = view_zenith_deg * kDegree_rad;
    return std::atan2(kEarthRadius_m * std::sin(zenith), kEarthRadius_m * std::cos(zenith) + range_m) / kDegree_rad;
}

StacImage stac_image(const ProductJob& job, const RenderedImage& r, const MapGrid& grid,
                     std::vector<std::filesystem::path> native) {
    StacImage image;
    image.assets = std::move(native);
    image.footprint_lon_lat = footprint(r);
    image.gsd_m = std::round(r.gsd_m * 100.0) / 100.0;
    image.ortho_grid = grid;
    const auto at_centre = [&](GeolocationPlane p) { return r.geolocation.at(p, r.samples / 2, r.lines / 2); };
    const auto finite_or_zero = [](double v) { return std::isfinite(v) ? v : 0.0; };
    image.incidence_deg = finite_or_zero(at_centre(kViewZenith));
    image.off_nadir_deg = off_nadir_deg(image.incidence_deg, finite_or_zero(at_centre(kRange)));
    image.sun_azimuth_deg = finite_or_zero(at_centre(kSunAzimuth));
    image.sun_elevation_deg = finite_or_zero(90.0 - at_centre(kSunZenith));
    for (const auto& entry : std::filesystem::directory_iterator(job.files.folder)) {
        const auto name = entry.path().filename().string();
        const bool mine = job.files.suffix.empty() || entry.path().stem().string().ends_with(job.files.suffix);
        if (entry.is_regular_file() && mine && !name.starts_with(".") && !name.starts_with("item"))
            image.assets.push_back(entry.path());
    }
    std::sort(image.assets.begin(), image.assets.end());
    return image;
}

}  // namespace

bool make_products(const ProductJob& job, const RunOptions& options, RunReport& report) {
    const auto item = stac_item_path(job.files);
    if (!job.force && stac_item_fingerprint(item) == job.fingerprint) return false;
    const auto& wanted = job.scenario.products;
    const auto step = "products " + job.acquisition.id;
    const auto stage = [&](double fraction) {
        if (options.cancelled != nullptr && options.cancelled->load()) throw Cancelled();
        if (options.on_progress) options.on_progress(step, fraction);
    };
    std::optional<PhaseTimer> timer;
    stage(0.0);
    timer.emplace(report, "products/read");
    const auto r = read_rendered(job);
    const auto brightness = brightness_product(job, r);
    std::vector<Product> made;
    if (wanted.ortho) made.push_back(radiance_product(r));
    if (wanted.brightness_temperature) made.push_back(brightness);
    if (wanted.fractions && r.truth) made.push_back(fractions_product(r));
    if (wanted.frp && r.truth) made.push_back(frp_product(r));
    MapGrid grid = job.inputs.grid;
    std::optional<analysis::OrthoLookup> lookup;
    if ((wanted.ortho || wanted.native) && r.gsd_m > 0.0) {  // a single pixel, or one that sees no ground, has no size
        timer.emplace(report, "products/ortho_lookup");
        grid = analysis::ortho_grid(job.inputs.grid, ortho_cell_m(r.gsd_m), r.x_m, r.y_m);
        lookup = visible_ground(job, r, grid, report);
    }
    timer.emplace(report, "products/rasters");
    for (std::size_t i = 0; i < made.size(); ++i) {
        stage(0.1 + 0.6 * static_cast<double>(i) / static_cast<double>(made.size()));
        write_product(job, r, made[i], wanted.ortho && lookup ? &*lookup : nullptr);
    }
    stage(0.7);
    if (wanted.frp && r.truth) {
        timer.emplace(report, "products/vectors");
        write_fire_pixels(job, r);
        write_vectors(job, options.output);
    }
    std::vector<std::filesystem::path> native;
    if (wanted.native && lookup) {
        timer.emplace(report, "products/native");
        native = write_native(job, r, *lookup, report);
    }
    stage(0.9);
    timer.emplace(report, "products/quicklook");
    if (r.n == 1 && job.bands.size() > 1)
        write_spectrum(job, r, brightness);
    else if (wanted.quicklook)
        write_picture(job, r, brightness);
    write_stac_item(job, stac_image(job, r, grid, std::move(native)));
    report.count("products/" + job.acquisition.id, 1);
    stage(1.0);
    return true;
}

}  // namespace pyroscene::pipeline
