#include "pipeline/image_digest.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gis/image_stream.h"

namespace pyroscene::pipeline {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// Planes of the truth that the digest uses.
struct Truth {
    std::vector<std::string> names;  ///< of the fractions
    std::vector<std::vector<float>> fractions;
    std::vector<float> ground_temperature_K, flame_temperature_K;

    [[nodiscard]] double fraction(const std::string& name, std::size_t i) const {
        for (std::size_t k = 0; k < names.size(); ++k)
            if (names[k] == name) return fractions[k][i];
        return 0.0;
    }
};

std::optional<Truth> read_truth(const std::filesystem::path& path) {
    if (!std::filesystem::exists(path)) return {};
    gis::ImageStream stream(path);
    Truth truth;
    const std::string prefix = "fraction_";
    const auto& bands = stream.info().bands;
    for (std::size_t b = 0; b < bands.size(); ++b) {
        const auto& name = bands[b].description;
        const auto read = [&] { return stream.read_band(static_cast<int>(b) + 1); };
        if (name.starts_with(prefix)) {
            truth.names.push_back(name.substr(prefix.size()));
            truth.fractions.push_back(read());
        } else if (name == "ground_temperature") {
            truth.ground_temperature_K = read();
        } else if (name == "flame_temperature") {
            truth.flame_temperature_K = read();
        }
    }
    return truth;
}

BandDigest digest_band(const std::vector<float>& plane) {
    BandDigest d{std::numeric_limits<double>::infinity(), 0.0, -std::numeric_limits<double>::infinity(), {}, {}};
    double smallest = std::numeric_limits<double>::infinity();
    std::size_t valid = 0;
    for (const double v : plane) {
        if (!std::isfinite(v)) continue;
        d.lowest = std::min(d.lowest, v);
        d.highest = std::max(d.highest, v);
        if (v > 0.0) smallest = std::min(smallest, v);
        d.mean += v;
        ++valid;
    }
    if (valid == 0) return {kNothing, kNothing, kNothing, {}, {}};
    d.mean /= static_cast<double>(valid);
    if (!(d.highest > 0.0)) return d;
    constexpr int kBins = 80;
    constexpr double kWidest = 1e6;
    const double low = std::max(smallest, d.highest / kWidest), span = std::max(std::log(d.highest / low), 1e-6);
    d.counts.assign(kBins, 0.0);
    for (int k = 0; k < kBins; ++k) d.bin_centres.push_back(low * std::exp(span * (k + 0.5) / kBins));
    for (const double v : plane)
        if (v >= low)
            d.counts[static_cast<std::size_t>(std::min(kBins - 1, static_cast<int>(std::log(v / low) / span * kBins)))] +=
                1.0;
    return d;
}

/// Index of the pixel with the largest value of a figure that is NaN where a pixel does not qualify.
template <class Figure>
std::optional<std::size_t> largest(std::size_t n, const Figure& figure) {
    std::optional<std::size_t> best;
    double best_value = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        const double value = figure(i);
        if (std::isnan(value) || (best && value <= best_value)) continue;
        best = i;
        best_value = value;
    }
    return best;
}

/// Where the median of the scores of pixels that hold nothing else lies.
std::optional<std::size_t> median_of_pure(const char* name, const Truth& truth, const std::vector<double>& score) {
    constexpr double kPure = 0.9999;
    std::vector<std::size_t> pure;
    for (std::size_t i = 0; i < score.size(); ++i)
        if (std::isfinite(score[i]) && truth.fraction(name, i) >= kPure) pure.push_back(i);
    if (pure.empty()) return {};
    const auto middle = pure.begin() + static_cast<std::ptrdiff_t>(pure.size() / 2);
    std::nth_element(pure.begin(), middle, pure.end(),
                     [&](std::size_t a, std::size_t b) { return score[a] < score[b] || (score[a] == score[b] && a < b); });
    return *middle;
}

std::vector<std::pair<std::string, std::size_t>> pick(const std::optional<Truth>& truth, const std::vector<double>& score) {
    std::vector<std::pair<std::string, std::size_t>> picked;
    const auto add = [&](const char* kind, std::optional<std::size_t> where) {
        if (where) picked.emplace_back(kind, *where);
    };
    add("brightest", largest(score.size(), [&](std::size_t i) {
            constexpr double kTie = 1e-6;  // of saturated pixels the one with most fire
            return score[i] + (truth ? kTie * (truth->fraction("flame", i) + truth->fraction("front", i)) : 0.0);
        }));
    if (!truth) return picked;
    constexpr double kSeen = 1e-3;
    const auto most_of = [&](const char* name) {
        return largest(score.size(), [&](std::size_t i) {
            const double f = truth->fraction(name, i);
            return f > kSeen && std::isfinite(score[i]) ? f : kNothing;
        });
    };
    add("flame", most_of("flame"));
    add("front", most_of("front"));
    const auto scar = median_of_pure("scar", *truth, score);
    add("scar", scar ? scar : largest(score.size(), [&](std::size_t i) {
            const double f = truth->fraction("scar", i), fire = truth->fraction("flame", i) + truth->fraction("front", i);
            return f > kSeen && fire == 0.0 && std::isfinite(score[i]) ? f : kNothing;
        }));
    add("background", median_of_pure("background", *truth, score));
    return picked;
}

void read_seen_frp(const AcquisitionFiles& files, ImageDigest& digest) {
    const auto path = files.file("frp");
    if (!std::filesystem::exists(path)) return;
    constexpr int kPowerBand = 2;
    double sum_MW = 0.0;
    for (const double v : gis::ImageStream(path).read_band(kPowerBand))
        if (std::isfinite(v)) sum_MW += v;
    digest.seen_frp_MW = sum_MW;
}

void describe_truth(const Truth& truth, const std::vector<double>& score, ImageDigest& digest) {
    for (std::size_t k = 0; k < truth.names.size(); ++k) {
        double sum = 0.0;
        std::size_t valid = 0;
        for (std::size_t i = 0; i < score.size(); ++i) {
            const double f = truth.fractions[k][i];
            if (!std::isfinite(f) || !std::isfinite(score[i])) continue;
            sum += f;
            ++valid;
        }
        digest.mean_fractions.emplace_back(truth.names[k], valid > 0 ? sum / static_cast<double>(valid) : kNothing);
    }
    constexpr double kSeen = 1e-3;
    for (std::size_t i = 0; i < score.size(); ++i)
        if (truth.fraction("flame", i) + truth.fraction("front", i) > kSeen) ++digest.fire_pixels;
}

}  // namespace

ImageDigest digest_image(const AcquisitionFiles& files) {
    gis::ImageStream radiance(files.radiance());
    ImageDigest digest;
    digest.samples = radiance.info().cols;
    digest.lines = radiance.info().rows;
    digest.bands = radiance.info().bands;
    const auto n = static_cast<std::size_t>(digest.samples) * static_cast<std::size_t>(digest.lines);
    const int bands = static_cast<int>(digest.bands.size());
    std::vector<double> score(n, 0.0);
    for (int b = 1; b <= bands; ++b) {
        const auto plane = radiance.read_band(b);
        digest.statistics.push_back(digest_band(plane));
        const double scale = digest.statistics.back().highest > 0.0 ? digest.statistics.back().highest : 1.0;
        for (std::size_t i = 0; i < n; ++i) score[i] += plane[i] / scale;
    }
    const auto truth = read_truth(files.truth());
    if (truth) describe_truth(*truth, score, digest);
    read_seen_frp(files, digest);
    for (const auto& [kind, i] : pick(truth, score)) {
        PickedPixel p{kind,
                      static_cast<int>(i) % digest.samples,
                      static_cast<int>(i) / digest.samples,
                      kNothing,
                      kNothing,
                      {},
                      kNothing,
                      kNothing,
                      {},
                      std::vector<double>(digest.bands.size(), kNothing)};
        if (truth) {
            for (const auto& plane : truth->fractions) p.fractions.push_back(plane[i]);
            if (!truth->ground_temperature_K.empty()) p.ground_temperature_K = truth->ground_temperature_K[i];
            if (!truth->flame_temperature_K.empty()) p.flame_temperature_K = truth->flame_temperature_K[i];
        }
        digest.picked.push_back(std::move(p));
    }
    const auto at = [&](const PickedPixel& p) {
        return static_cast<std::size_t>(p.line) * static_cast<std::size_t>(digest.samples) +
               static_cast<std::size_t>(p.sample);
    };
    for (auto& p : digest.picked)
        for (int b = 1; b <= bands; ++b) p.radiance_W_m2_sr_um.push_back(radiance.read_value(b, p.sample, p.line));
    if (truth) {
        gis::ImageStream stream(files.truth());
        const auto& planes = stream.info().bands;
        for (std::size_t b = 0; b < digest.bands.size(); ++b) {
            const auto id = digest.bands[b].metadata.find("band_id");
            if (id == digest.bands[b].metadata.end()) continue;
            for (std::size_t k = 0; k < planes.size(); ++k) {
                if (planes[k].description != id->second + " radiance_noise_free") continue;
                for (auto& p : digest.picked)
                    p.arriving_W_m2_sr_um[b] = stream.read_value(static_cast<int>(k) + 1, p.sample, p.line);
            }
        }
    }
    if (std::filesystem::exists(files.geolocation())) {
        gis::ImageStream geolocation(files.geolocation());
        const auto longitude = geolocation.read_band(1), latitude = geolocation.read_band(2);
        for (auto& p : digest.picked) {
            p.longitude_deg = longitude[at(p)];
            p.latitude_deg = latitude[at(p)];
        }
    }
    return digest;
}

}  // namespace pyroscene::pipeline
