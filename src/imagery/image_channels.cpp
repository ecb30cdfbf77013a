#include "imagery/image_channels.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "analysis/frp.h"
#include "base/constants.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/files.h"
#include "imagery/sensor_of_image.h"
#include "radiometry/planck.h"

namespace pyroscene::imagery {
namespace {

bool is_radiance(const std::string& unit) { return unit.empty() || unit.find("sr") != std::string::npos; }

}  // namespace

double solar_irradiance_W_m2_um(const Spectrum& response) {
    const auto table = read_csv(data_folder() / "optical" / "solar_irradiance.csv");
    const Spectrum sun{Quantity::Irradiance, table.numbers("wavelength_um"), table.numbers("irradiance_W_m2_um")};
    constexpr int kSteps = 200;
    const double first = response.lambda_um.front(), step = (response.lambda_um.back() - first) / kSteps;
    double weighted = 0.0, weights = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        const double lambda_um = first + (i + 0.5) * step, weight = response.at(lambda_um);
        weighted += weight * sun.at(lambda_um);
        weights += weight;
    }
    return weighted / weights;
}

double Channel::black_body(double T_K) const { return radiometry::band_mean_radiance(T_K, response); }

std::vector<float> Channel::temperatures_K() const {
    if (unit == "K") return values;
    const radiometry::BandThermometer thermometer(response);
    std::vector<float> T_K;
    T_K.reserve(values.size());
    for (const float L : values) T_K.push_back(static_cast<float>(thermometer.temperature_K(static_cast<double>(L))));
    return T_K;
}

double Channel::power_law_coefficient() const {
    std::vector<double> T_K, L;
    for (double T = 650.0; T <= 1350.0; T += 25.0) {
        T_K.push_back(T);
        L.push_back(black_body(T));
    }
    return analysis::power_law_coefficient(T_K, L);
}

std::string metadata_item(const gis::ImageInfo& info, const std::string& key) {
    const auto found = info.metadata.find(key);
    return found == info.metadata.end() ? std::string() : found->second;
}

DateAndClock date_and_clock(const std::string& iso8601) {
    if (iso8601.size() < 16) return {};
    return {iso8601.substr(0, 10), iso8601.substr(11, 2) + iso8601.substr(14, 2)};
}

ImageChannels::ImageChannels(const std::filesystem::path& image, const std::optional<std::string>& sensor)
    : image_(image), sensor_(sensor_of_image(info(), sensor)) {}

int ImageChannels::find(const BandWish& wish) const {
    int found = 0;
    double nearest_um = std::numeric_limits<double>::infinity();
    for (std::size_t b = 0; b < info().bands.size(); ++b) {
        const auto um = info().bands[b].wavelength_um;
        if (!um || *um < wish.lowest_um || *um > wish.highest_um || std::abs(*um - wish.best_um) >= nearest_um) continue;
        nearest_um = std::abs(*um - wish.best_um);
        found = static_cast<int>(b) + 1;
    }
    return found;
}

int ImageChannels::require(const std::optional<int>& wanted, const BandWish& wish) const {
    const std::string path = image_.path().string();
    if (!wanted) {
        const int found = find(wish);
        if (found == 0)
            throw input_error(path, fmt::format("no band between {:.4g} and {:.4g} um for the {}", wish.lowest_um,
                                                wish.highest_um, wish.what));
        return found;
    }
    if (*wanted < 1 || *wanted > static_cast<int>(info().bands.size()))
        throw input_error(path, fmt::format("no band {}; it has {}", *wanted, info().bands.size()));
    if (!info().bands[static_cast<std::size_t>(*wanted) - 1].wavelength_um)
        throw input_error(path, fmt::format("band {} has no wavelength", *wanted));
    return *wanted;
}

int ImageChannels::twin(int number) const {
    const auto um = info().bands[static_cast<std::size_t>(number) - 1].wavelength_um;
    for (std::size_t b = 0; b < info().bands.size(); ++b)
        if (static_cast<int>(b) + 1 != number && info().bands[b].wavelength_um &&
            std::abs(*info().bands[b].wavelength_um - *um) < 1e-3)
            return static_cast<int>(b) + 1;
    return 0;
}

Channel ImageChannels::read(int number, Expect expect) {
    const auto& band = info().bands[static_cast<std::size_t>(number) - 1];
    const bool right = is_radiance(band.unit) || (expect == Expect::RadianceOrTemperature && band.unit == "K") ||
                       (expect == Expect::RadianceOrReflectance && band.unit == "1");
    if (!right)
        throw input_error(
            image_.path().string(),
            fmt::format("band {} is in '{}', expected a spectral radiance (W m-2 sr-1 um-1){}", number, band.unit,
                        expect == Expect::RadianceOrTemperature   ? " or a brightness temperature (K)"
                        : expect == Expect::RadianceOrReflectance ? " or a reflectance (1)"
                                                                  : ""));
    Channel channel;
    channel.number = number;
    channel.name = band.description.empty() ? fmt::format("band {}", number) : band.description;
    channel.unit = band.unit;
    channel.centre_um = *band.wavelength_um;
    if (sensor_) {
        channel.detector = band_of_image(*sensor_, band, image_.path());
        channel.response = channel.detector->response;
    } else {
        const double half_um = 0.5 * band.fwhm_um.value_or(0.02 * channel.centre_um);
        channel.response = {Quantity::Response, {channel.centre_um - half_um, channel.centre_um + half_um}, {1.0, 1.0}};
    }
    channel.values = image_.read_band(number);
    return channel;
}

std::vector<float> reflectances(const Channel& channel, const std::vector<float>& sun_zenith_deg, double distance_AU) {
    if (channel.unit == "1") return channel.values;
    constexpr double kLowestSun_deg = 85.0;
    const double scale = kPi * distance_AU * distance_AU / solar_irradiance_W_m2_um(channel.response);
    std::vector<float> out(channel.values.size(), std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < out.size(); ++i) {
        const double zenith_deg = static_cast<double>(sun_zenith_deg[i]);
        if (zenith_deg < kLowestSun_deg)
            out[i] = static_cast<float>(scale * static_cast<double>(channel.values[i]) / std::cos(zenith_deg * kDegree_rad));
    }
    return out;
}

}  // namespace pyroscene::imagery
