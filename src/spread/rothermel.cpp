#include "spread/rothermel.h"

#include <algorithm>
#include <cmath>

namespace pyroscene::spread {
namespace {

// The model was fitted in ft, lb, Btu and minutes: it is computed in them.
constexpr double kFoot_m = 0.3048, kPound_kg = 0.45359237, kBtu_J = 1055.05585262, kMinute_s = 60.0;
constexpr double kFootPerMinute_m_s = kFoot_m / kMinute_s, kMile_ft = 5280.0;
constexpr double kPoundPerFoot2_kg_m2 = kPound_kg / (kFoot_m * kFoot_m);

constexpr double kParticleDensity_lb_ft3 = 32.0, kTotalMinerals = 0.0555, kEffectiveMinerals = 0.010;

/// Particles of one class of the bed, dead or live.
struct Particles {
    double load_lb_ft2 = 0.0, sav_per_ft = 0.0, moisture = 0.0;

    [[nodiscard]] double surface() const noexcept { return load_lb_ft2 * sav_per_ft / kParticleDensity_lb_ft3; }
    /// Effective heating number, or 0 for an absent class.
    [[nodiscard]] double weight(double decay_per_ft) const noexcept {
        return load_lb_ft2 > 0.0 ? load_lb_ft2 * std::exp(-decay_per_ft / sav_per_ft) : 0.0;
    }
};
constexpr std::size_t kDead = 4, kLive = 2;  ///< 1 h, 10 h, 100 h, cured herbs; herbs, woody plants

/// One category of the bed, weighted by the surface of its classes.
template <std::size_t N>
struct Category {
    std::array<Particles, N> classes;
    double surface = 0.0, sav_per_ft = 0.0, moisture = 0.0, net_load_lb_ft2 = 0.0, heat_sink = 0.0;

    explicit Category(const std::array<Particles, N>& particles) noexcept : classes(particles) {
        for (const auto& p : classes) surface += p.surface();
        if (!(surface > 0.0)) return;
        for (const auto& p : classes) {
            const double share = p.surface() / surface;
            sav_per_ft += share * p.sav_per_ft;
            moisture += share * p.moisture;
            net_load_lb_ft2 += size_share(p) * p.load_lb_ft2 * (1.0 - kTotalMinerals);
            if (p.load_lb_ft2 > 0.0) heat_sink += share * std::exp(-138.0 / p.sav_per_ft) * (250.0 + 1116.0 * p.moisture);
        }
    }

private:
    static int size_bin(double sav_per_ft) noexcept {
        int bin = 0;
        for (const double limit : {16.0, 48.0, 96.0, 192.0, 1200.0}) bin += sav_per_ft >= limit ? 1 : 0;
        return bin;
    }
    /// Share of the surface in particles of the same size group.
    [[nodiscard]] double size_share(const Particles& p) const noexcept {
        const int bin = size_bin(p.sav_per_ft);
        if (bin == 0) return 0.0;
        double same = 0.0;
        for (const auto& other : classes)
            if (size_bin(other.sav_per_ft) == bin) same += other.surface();
        return same / surface;
    }
};

double cured_share(const FuelModel& model, double herb_moisture, Curing curing) noexcept {
    if (!model.dynamic || herb_moisture > 1.20) return 0.0;
    if (herb_moisture <= 0.30) return 1.0;
    const double share = curing == Curing::BehavePlus ? 1.333 - 1.11 * herb_moisture : (1.20 - herb_moisture) / 0.90;
    return std::clamp(share, 0.0, 1.0);
}

double moisture_damping(double moisture, double extinction) noexcept {
    const double q = moisture / extinction;
    return q >= 1.0 ? 0.0 : std::max(0.0, 1.0 - 2.59 * q + 5.11 * q * q - 3.52 * q * q * q);
}

/// Moisture of extinction of live fuel: the more fine dead fuel and the drier, the more live fuel burns.
double live_extinction(const Category<kDead>& dead, const Category<kLive>& live, double dead_extinction) noexcept {
    double dead_weight = 0.0, live_weight = 0.0, water = 0.0;
    for (const auto& p : dead.classes) {
        dead_weight += p.weight(138.0);
        water += p.moisture * p.weight(138.0);
    }
    for (const auto& p : live.classes) live_weight += p.weight(500.0);
    if (!(live_weight > 0.0) || !(dead_weight > 0.0)) return dead_extinction;
    const double ratio = dead_weight / live_weight, fine_moisture = water / dead_weight;
    return std::max(dead_extinction, 2.9 * ratio * (1.0 - fine_moisture / dead_extinction) - 0.226);
}

}  // namespace

FuelBed fuel_bed(const FuelModel& model, const Moistures& moisture, Curing curing) noexcept {
    const auto particles = [&](FuelClass c) {
        return Particles{model.load_kg_m2[c] / kPoundPerFoot2_kg_m2, model.surface_to_volume_per_m[c] * kFoot_m,
                         moisture[c]};
    };
    Particles herb = particles(kHerb), cured = herb;
    const double share = cured_share(model, moisture[kHerb], curing);
    cured.load_lb_ft2 = share * herb.load_lb_ft2;
    cured.moisture = moisture[kOneHour];
    herb.load_lb_ft2 -= cured.load_lb_ft2;
    const Category<kDead> dead({particles(kOneHour), particles(kTenHours), particles(kHundredHours), cured});
    const Category<kLive> live({herb, particles(kWoody)});

    FuelBed bed;
    const double surface = dead.surface + live.surface;
    if (!(surface > 0.0)) return bed;
    const double dead_share = dead.surface / surface, live_share = live.surface / surface;
    const double sigma = dead_share * dead.sav_per_ft + live_share * live.sav_per_ft;
    const double bulk_lb_ft3 = model.total_load_kg_m2() / kPoundPerFoot2_kg_m2 / (model.depth_m / kFoot_m);
    const double packing = bulk_lb_ft3 / kParticleDensity_lb_ft3;
    const double relative = packing / (3.348 * std::pow(sigma, -0.8189));

    const double power = 133.0 * std::pow(sigma, -0.7913);
    const double sigma15 = std::pow(sigma, 1.5);
    const double reaction_velocity =
        sigma15 / (495.0 + 0.0594 * sigma15) * std::pow(relative, power) * std::exp(power * (1.0 - relative));
    const double minerals = std::min(1.0, 0.174 * std::pow(kEffectiveMinerals, -0.19));
    const auto heat_Btu_lb = [](double J_kg) { return J_kg * kPound_kg / kBtu_J; };
    const double dead_heat = dead.net_load_lb_ft2 * heat_Btu_lb(model.heat_dead_J_kg) *
                             moisture_damping(dead.moisture, model.extinction_moisture);
    const double live_heat = live.net_load_lb_ft2 * heat_Btu_lb(model.heat_live_J_kg) *
                             moisture_damping(live.moisture, live_extinction(dead, live, model.extinction_moisture));
    const double reaction_Btu_ft2_min = reaction_velocity * minerals * (dead_heat + live_heat);
    const double flux_ratio = std::exp((0.792 + 0.681 * std::sqrt(sigma)) * (packing + 0.1)) / (192.0 + 0.2595 * sigma);
    const double sink_Btu_ft3 = bulk_lb_ft3 * (dead_share * dead.heat_sink + live_share * live.heat_sink);

    bed.rate_m_s = reaction_Btu_ft2_min * flux_ratio / sink_Btu_ft3 * kFootPerMinute_m_s;
    bed.reaction_intensity_W_m2 = reaction_Btu_ft2_min * kBtu_J / (kFoot_m * kFoot_m * kMinute_s);
    bed.residence_time_s = 384.0 / sigma * kMinute_s;
    bed.heat_J_m2 = bed.reaction_intensity_W_m2 * bed.residence_time_s;
    bed.surface_to_volume_per_m = sigma / kFoot_m;
    bed.relative_packing = relative;
    bed.slope_factor = 5.275 * std::pow(packing, -0.3);
    bed.wind_power = 0.02526 * std::pow(sigma, 0.54);
    const double c = 7.47 * std::exp(-0.133 * std::pow(sigma, 0.55)), e = 0.715 * std::exp(-3.59e-4 * sigma);
    bed.wind_scale = c * std::pow(relative, -e) * std::pow(1.0 / kFootPerMinute_m_s, bed.wind_power);
    return bed;
}

HeadFire head_fire(const FuelBed& bed, double midflame_m_s, double wind_from_upslope_rad, double slope_tangent,
                   bool wind_limit) noexcept {
    HeadFire head;
    if (!(bed.rate_m_s > 0.0)) return head;
    const double by_wind = midflame_m_s > 0.0 ? bed.wind_scale * std::pow(midflame_m_s, bed.wind_power) : 0.0;
    const double by_slope = bed.slope_factor * slope_tangent * slope_tangent;
    const double up = by_slope + by_wind * std::cos(wind_from_upslope_rad),
                 across = by_wind * std::sin(wind_from_upslope_rad);
    double factor = std::hypot(up, across);
    head.effective_wind_m_s = factor > 0.0 ? std::pow(factor / bed.wind_scale, 1.0 / bed.wind_power) : 0.0;
    const double reaction_Btu_ft2_min = bed.reaction_intensity_W_m2 / kBtu_J * (kFoot_m * kFoot_m * kMinute_s);
    const double limit_m_s = 0.9 * reaction_Btu_ft2_min * kFootPerMinute_m_s;
    if (wind_limit && head.effective_wind_m_s > limit_m_s) {
        head.limited = true;
        head.effective_wind_m_s = limit_m_s;
        factor = bed.wind_scale * std::pow(limit_m_s, bed.wind_power);
    }
    head.rate_m_s = bed.rate_m_s * (1.0 + factor);
    head.from_upslope_rad = std::atan2(across, up);
    return head;
}

namespace {

/// Share of the space below their tops that crowns fill.
double crown_fill(const Canopy& canopy) noexcept { return canopy.crown_ratio * canopy.cover / 3.0; }

}  // namespace

bool shelters(const Canopy& canopy) noexcept { return crown_fill(canopy) >= 0.05 && canopy.height_m / kFoot_m >= 6.0; }

double wind_adjustment(double fuel_depth_m, const Canopy& canopy) noexcept {
    const double height_ft = canopy.height_m / kFoot_m;
    const auto profile = [](double h_ft) { return std::log((20.0 + 0.36 * h_ft) / (0.13 * h_ft)); };
    if (shelters(canopy)) return 0.555 / (std::sqrt(crown_fill(canopy) * height_ft) * profile(height_ft));
    return 1.83 / profile(fuel_depth_m / kFoot_m);
}

double length_to_width(double effective_wind_m_s) noexcept {
    const double mph = effective_wind_m_s / kFoot_m * 3600.0 / kMile_ft;
    return std::clamp(0.936 * std::exp(0.1147 * mph) + 0.461 * std::exp(-0.0692 * mph) - 0.397, 1.0, 8.0);
}

double flame_length_m(double fireline_intensity_W_m) noexcept {
    constexpr double kBtuPerFootSecond_W_m = kBtu_J / kFoot_m;
    return 0.45 * kFoot_m * std::pow(fireline_intensity_W_m / kBtuPerFootSecond_W_m, 0.46);
}

}  // namespace pyroscene::spread
