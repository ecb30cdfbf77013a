#include "pipeline/frp_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "base/files.h"
#include "gis/pixel_positions.h"
#include "pipeline/hotspots.h"
#include "pipeline/image_channels.h"
#include "radiometry/planck.h"

namespace pyroscene::pipeline {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr BandWish kMir{3.96, 3.0, 5.0, "MIR radiance"}, kThermal{11.0, 7.5, 14.5, "thermal radiance"};

/// A band with what lies between ground and sensor taken off.
Channel at_ground(ImageChannels& image, int number, double transmittance, double path) {
    Channel c = image.read(number);
    for (float& L : c.values) L = static_cast<float>((static_cast<double>(L) - path) / transmittance);
    return c;
}

/// The planes of the result, [line][sample], NaN where there is no fire.
struct Planes {
    explicit Planes(std::size_t n)
        : frp_W_m2(n, kNaN),
          frp_MW(n, kNaN),
          fraction(n, kNaN),
          temperature_K(n, kNaN),
          frp_sd_MW(n, kNaN),
          temperature_sd_K(n, kNaN) {}
    std::vector<float> frp_W_m2, frp_MW, fraction, temperature_K, frp_sd_MW, temperature_sd_K;
};

struct Scene {
    const FrpJob& job;
    const gis::PixelPositions& where;
    const std::vector<unsigned char>& fire;
    const std::vector<float>& mir_K;
};

/// The pixels' powers; returns how many have no solution.
std::int64_t compute(const Scene& s, const Channel& mir, const Channel* tir, double a, Planes& out) {
    std::int64_t unsolved = 0;
    std::optional<radiometry::BandThermometer> tir_thermometer;
    if (tir != nullptr) tir_thermometer.emplace(tir->response);
    const auto far_mir = analysis::background_of_all(mir.values, s.fire);
    const auto far_tir = tir != nullptr ? analysis::background_of_all(tir->values, s.fire) : analysis::Background{};
    for (std::size_t i = 0; i < s.fire.size(); ++i) {
        if (s.fire[i] == 0) continue;
        if (s.job.cancelled != nullptr && s.job.cancelled->load()) throw Cancelled();
        const int sample = static_cast<int>(i % static_cast<std::size_t>(s.where.samples)),
                  line = static_cast<int>(i / static_cast<std::size_t>(s.where.samples));
        const auto around = [&](const std::vector<float>& plane, const analysis::Background& far) {
            const auto near = analysis::background_around(plane, s.fire, s.where.samples, s.where.lines, sample, line);
            return near.pixels > 0 ? near : far;
        };
        const auto background = around(mir.values, far_mir);
        if (background.pixels == 0 && s.job.subtract_background) {
            ++unsolved;
            continue;
        }
        const double area_m2 = static_cast<double>(s.where.area_m2[i]), radiance = static_cast<double>(mir.values[i]);
        double frp = analysis::frp_mir_W_m2(radiance, s.job.subtract_background ? background.mean : 0.0, a, 1.0);
        if (tir != nullptr) {
            const auto tir_background = around(tir->values, far_tir);
            const analysis::BispectralInput in{radiance,
                                               static_cast<double>(tir->values[i]),
                                               background.mean,
                                               tir_background.mean,
                                               tir_thermometer->temperature_K(tir_background.mean),
                                               s.job.mir_noise,
                                               s.job.tir_noise};
            const auto found = tir_background.pixels == 0 ? analysis::Bispectral{}
                                                          : analysis::bispectral(
                                                                in, [&](double T) { return mir.black_body(T); },
                                                                [&](double T) { return tir->black_body(T); });
            if (!found.solved) {
                ++unsolved;
                continue;
            }
            frp = found.frp_W_m2;
            out.fraction[i] = static_cast<float>(found.fraction);
            out.temperature_K[i] = static_cast<float>(found.temperature_K);
            out.temperature_sd_K[i] = static_cast<float>(found.temperature_sd_K);
            out.frp_sd_MW[i] = static_cast<float>(found.frp_sd_W_m2 * area_m2 * 1e-6);
        }
        out.frp_W_m2[i] = static_cast<float>(frp);
        out.frp_MW[i] = static_cast<float>(frp * area_m2 * 1e-6);
    }
    return unsolved;
}

/// Groups of fire pixels that touch by an edge or a corner, strongest first.
std::vector<FireCluster> clusters(const Scene& s, const Planes& planes) {
    const cv::Mat fire(s.where.lines, s.where.samples, CV_8UC1, const_cast<unsigned char*>(s.fire.data()));  // read only
    cv::Mat labels;
    const int count = cv::connectedComponents(fire, labels, 8, CV_32S);
    std::vector<FireCluster> fires(static_cast<std::size_t>(count - 1));
    std::vector<double> weights(fires.size(), 0.0);
    for (std::size_t i = 0; i < s.fire.size(); ++i) {
        if (s.fire[i] == 0) continue;
        const auto label = static_cast<std::size_t>(labels.at<int>(static_cast<int>(i)) - 1);
        FireCluster& of = fires[label];
        const double power = std::isfinite(planes.frp_MW[i]) ? static_cast<double>(planes.frp_MW[i]) : 0.0;
        const double weight = std::max(power, 1e-12);
        ++of.pixels;
        of.frp_MW += power;
        if (std::isfinite(s.where.area_m2[i])) of.area_ha += static_cast<double>(s.where.area_m2[i]) * 1e-4;
        of.lon_deg += weight * s.where.lon_deg[i];
        of.lat_deg += weight * s.where.lat_deg[i];
        weights[label] += weight;
    }
    for (std::size_t f = 0; f < fires.size(); ++f) {
        fires[f].lon_deg /= weights[f];
        fires[f].lat_deg /= weights[f];
    }
    std::stable_sort(fires.begin(), fires.end(),
                     [](const FireCluster& a, const FireCluster& b) { return a.frp_MW > b.frp_MW; });
    return fires;
}

void write_raster(const Scene& s, const gis::ImageInfo& info, const Planes& planes) {
    gis::OutputRaster out;
    out.cols = info.cols;
    out.rows = info.rows;
    out.like = s.job.image;
    out.synthetic = info.metadata.contains("synthetic");
    out.metadata["SOURCE_IMAGE"] = s.job.image.filename().string();
    out.metadata["METHOD"] = s.job.bispectral ? "bispectral" : "MIR radiance";
    std::vector<float> pixels;
    const auto add = [&](const char* name, const char* unit, const auto& plane) {
        out.bands.push_back({name, unit, {}, {}, {}});
        for (const auto v : plane) pixels.push_back(static_cast<float>(v));
    };
    add("fire radiative power per area", "W m-2", planes.frp_W_m2);
    add("fire radiative power of the pixel", "MW", planes.frp_MW);
    add("fire mask", "1", s.fire);
    if (s.job.bispectral) {
        add("fire fraction", "1", planes.fraction);
        add("fire temperature", "K", planes.temperature_K);
        add("standard deviation of the power", "MW", planes.frp_sd_MW);
        add("standard deviation of the temperature", "K", planes.temperature_sd_K);
    }
    if (info.on_map)
        gis::write_cog(s.job.output, out, pixels);
    else
        gis::write_geotiff(s.job.output, out, pixels);
}

std::filesystem::path beside(const FrpJob& job, const char* ending) {
    auto path = job.output;
    return path.replace_filename(job.output.stem().string() + ending);
}

void write_tables(const Scene& s, const gis::ImageInfo& info, const Planes& planes, const std::vector<float>* tir_K,
                  const std::vector<FireCluster>& fires) {
    HotspotTable table;
    const auto when = date_and_clock(metadata_item(info, "ACQUISITION_DATE"));
    table.date = when.date;
    table.clock = when.clock;
    table.satellite = table.instrument = metadata_item(info, "SENSOR");
    table.version = info.metadata.contains("synthetic") ? "synthetic" : "";
    for (std::size_t i = 0; i < s.fire.size(); ++i) {
        if (s.fire[i] == 0 || !std::isfinite(planes.frp_MW[i])) continue;
        Hotspot h{s.where.lat_deg[i], s.where.lon_deg[i], static_cast<double>(s.mir_K[i])};
        if (tir_K != nullptr) h.tir_K = static_cast<double>((*tir_K)[i]);
        h.scan_km = static_cast<double>(s.where.width_m[i]) * 1e-3;
        h.track_km = static_cast<double>(s.where.height_m[i]) * 1e-3;
        h.frp_MW = static_cast<double>(planes.frp_MW[i]);
        table.rows.push_back(h);
    }
    write_hotspots_csv(beside(s.job, "_pixels.csv"), table);
    std::string text = "fire,longitude,latitude,pixels,area_ha,frp_MW\n";
    for (std::size_t f = 0; f < fires.size(); ++f)
        text += fmt::format("{},{:.6f},{:.6f},{},{:.6g},{:.6g}\n", f + 1, fires[f].lon_deg, fires[f].lat_deg,
                            fires[f].pixels, fires[f].area_ha, fires[f].frp_MW);
    write_text_file(beside(s.job, "_fires.csv"), text);
}

}  // namespace

FrpReport frp_image(const FrpJob& job) {
    ImageChannels image(job.image, job.sensor);
    const gis::ImageInfo& info = image.info();
    const Channel mir = at_ground(image, image.require(job.mir_band, kMir), job.mir_transmittance, job.mir_path);
    std::optional<Channel> tir;
    if (job.bispectral) tir = at_ground(image, image.require(job.tir_band, kThermal), job.tir_transmittance, job.tir_path);
    FrpReport report{mir.name, tir ? tir->name : "", job.coefficient.value_or(mir.power_law_coefficient()), 0, 0, 0.0, {}};
    const auto where = gis::pixel_positions(job.image);
    const auto mir_K = mir.temperatures_K();
    const auto fire = analysis::fire_pixels(mir_K, info.cols, info.rows, job.least_temperature_K);
    const Scene scene{job, where, fire, mir_K};
    Planes planes(fire.size());
    report.unsolved = compute(scene, mir, tir ? &*tir : nullptr, report.coefficient_W_m2_sr_um_K4, planes);
    report.fire_pixels = std::count(fire.begin(), fire.end(), 1);
    for (const float power : planes.frp_MW) report.total_MW += std::isfinite(power) ? static_cast<double>(power) : 0.0;
    report.fires = clusters(scene, planes);
    write_raster(scene, info, planes);
    std::optional<std::vector<float>> tir_K;
    if (tir) tir_K = tir->temperatures_K();
    write_tables(scene, info, planes, tir_K ? &*tir_K : nullptr, report.fires);
    return report;
}

}  // namespace pyroscene::pipeline
