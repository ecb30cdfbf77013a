#include "imagery/frp_image.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.h"
#include "base/files.h"
#include "gis/pixel_positions.h"
#include "imagery/hotspots.h"
#include "imagery/image_channels.h"

namespace pyroscene::imagery {
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
          temperature_sd_K(n, kNaN),
          mir_background(n, kNaN),
          tir_background(n, kNaN) {}
    std::vector<float> frp_W_m2, frp_MW, fraction, temperature_K, frp_sd_MW, temperature_sd_K;
    std::vector<float> mir_background, tir_background;  ///< radiances of the surroundings
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
    std::optional<TwoBands> two_bands;
    if (tir != nullptr) two_bands.emplace(mir, *tir);
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
        if (background.pixels > 0) out.mir_background[i] = static_cast<float>(background.mean);
        const double area_m2 = static_cast<double>(s.where.area_m2[i]), radiance = static_cast<double>(mir.values[i]);
        double frp = analysis::frp_mir_W_m2(radiance, s.job.subtract_background ? background.mean : 0.0, a, 1.0);
        if (tir != nullptr) {
            const auto tir_background = around(tir->values, far_tir);
            if (tir_background.pixels > 0) out.tir_background[i] = static_cast<float>(tir_background.mean);
            const double tir_mean = tir_background.pixels > 0 ? tir_background.mean : std::nan("");
            const auto found = two_bands->solve({radiance, static_cast<double>(tir->values[i]), background.mean, tir_mean},
                                                s.job.mir_noise, s.job.tir_noise);
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

void write_raster(const Scene& s, const gis::ImageInfo& info, const Planes& planes) {
    gis::OutputRaster out;
    out.cols = info.cols;
    out.rows = info.rows;
    out.like = s.job.image;
    out.synthetic = info.metadata.contains("synthetic");
    out.acquisition_time = metadata_item(info, "ACQUISITION_DATE");
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
    HotspotTable table = hotspots_of(info);
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
    std::string text = "fire,longitude,latitude,pixels,area_ha,frp_MW";
    if (s.job.bispectral)
        text +=
            ",mean_fire_area_m2,mean_fire_area_sd_m2,mean_temperature_K,mean_temperature_sd_K,mean_frp_MW,mean_frp_sd_MW,"
            "correlation";
    text += "\n";
    for (std::size_t f = 0; f < fires.size(); ++f) {
        const FireCluster& fire = fires[f];
        text += fmt::format("{},{:.6f},{:.6f},{},{:.6g},{:.6g}", f + 1, fire.lon_deg, fire.lat_deg, fire.pixels,
                            fire.area_ha, fire.frp_MW);
        const auto& mean = fire.mean;
        const double m2 = fire.area_ha * 1e4, MW_per_W_m2 = m2 * 1e-6;
        if (s.job.bispectral && mean.solved)
            text += fmt::format(",{:.6g},{:.4g},{:.6g},{:.4g},{:.6g},{:.4g},{:.4f}", mean.fraction * m2,
                                mean.fraction_sd * m2, mean.temperature_K, mean.temperature_sd_K,
                                mean.frp_W_m2 * MW_per_W_m2, mean.frp_sd_W_m2 * MW_per_W_m2, mean.correlation);
        else if (s.job.bispectral)
            text += ",,,,,,,";
        text += "\n";
    }
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
    ClusterInput groups{where, fire, planes.frp_MW};
    if (tir) {
        groups.mir = &mir;
        groups.tir = &*tir;
        groups.mir_background = &planes.mir_background;
        groups.tir_background = &planes.tir_background;
        groups.mir_noise = job.mir_noise;
        groups.tir_noise = job.tir_noise;
    }
    report.fires = fire_clusters(groups);
    write_raster(scene, info, planes);
    std::optional<std::vector<float>> tir_K;
    if (tir) tir_K = tir->temperatures_K();
    write_tables(scene, info, planes, tir_K ? &*tir_K : nullptr, report.fires);
    return report;
}

}  // namespace pyroscene::imagery
