#include "render/band_output.h"

#include <algorithm>

namespace pyroscene::render {
namespace {

bool all_equal(const std::vector<float>& values, float to) {
    return std::all_of(values.begin(), values.end(), [to](float v) { return v == to; });
}

bool is_vacuum(const radiometry::ViewAtmosphere& air) {
    return all_equal(air.transmittance, 1.0F) && all_equal(air.path_thermal_W_m2_sr_um, 0.0F) &&
           all_equal(air.path_solar_a0, 0.0F) && all_equal(air.path_solar_a1, 0.0F) && all_equal(air.path_solar_a2, 0.0F) &&
           all_equal(air.solar_correlation, 1.0F) && all_equal(air.adjacency_W_m2_sr_um, 0.0F);
}

}  // namespace

BandOutput::BandOutput(const PreparedScene& prepared, bool with_terms)
    : prepared_(&prepared),
      kernels_(&spectral_kernels()),
      with_terms_(with_terms),
      vacuum_(is_vacuum(*prepared.scene.atmosphere)),
      bands_(prepared.scene.spectral->band_count()) {
    const radiometry::SpectralGrid& spectral = *prepared.scene.spectral;
    for (const auto& band : spectral.bands) begin_.push_back(band.begin);
    begin_.push_back(spectral.size());
    for (const double w : spectral.weight) weight_.push_back(static_cast<float>(w));
    const auto stride = static_cast<std::size_t>(prepared.tables.stride);
    weight_.resize(stride, 0.0F);
    for (auto* buffer : {&path_, &at_sensor_, &through_, &zero_}) buffer->assign(stride, 0.0F);
    view_.resize(prepared.tables.stride);  // padded: `at` fills the wavelengths, the rest stays as it is
    for (auto* term : {&view_.transmittance, &view_.solar_correlation}) std::fill(term->begin(), term->end(), 1.0F);
    for (auto* term : {&view_.path_thermal, &view_.path_solar, &view_.adjacency})
        std::fill(term->begin(), term->end(), 0.0F);
}

void BandOutput::compute(const Pixel& pixel, const PixelView& view, float* total, float* terms) {
    const SceneTables& t = prepared_->tables;
    if (!vacuum_) {
        prepared_->scene.atmosphere->at(view.view_zenith_rad, view.relative_azimuth_rad, view.ground_m, view_);
        for (std::size_t i = 0; i < path_.size(); ++i)
            path_[i] = view_.path_thermal[i] + view_.path_solar[i] + view_.adjacency[i];
    }
    const auto scale = static_cast<float>(1.0 / pixel.truth().seen);
    const GroundSpectra& ground = pixel.ground();
    std::array<const float*, 7> parts{pixel.flame(), ground.part(GroundSpectra::Emission)};
    int count = 2;
    if (t.has_sky) parts[static_cast<std::size_t>(count++)] = ground.part(GroundSpectra::Sky);
    if (prepared_->flame_light != nullptr) parts[static_cast<std::size_t>(count++)] = ground.part(GroundSpectra::FlameLight);
    if (t.has_thermal_sky || prepared_->flame_light != nullptr || prepared_->smoke) {
        parts[static_cast<std::size_t>(count++)] = ground.part(GroundSpectra::ThermalSky);
    }
    if (prepared_->smoke) {
        parts[static_cast<std::size_t>(count++)] = pixel.smoke();
        parts[static_cast<std::size_t>(count++)] = pixel.scattered();
    }
    kernels_->at_sensor(t.stride, count, parts.data(), t.has_sun ? ground.part(GroundSpectra::Sun) : zero_.data(),
                        view_.solar_correlation.data(), view_.transmittance.data(), scale, path_.data(), at_sensor_.data());
    kernels_->band_sums(bands_, begin_.data(), weight_.data(), at_sensor_.data(), total);
    if (with_terms_) compute_terms(pixel, scale, terms);
}

void BandOutput::compute_terms(const Pixel& pixel, float scale, float* terms) {
    const SceneTables& t = prepared_->tables;
    const GroundSpectra& ground = pixel.ground();
    kernels_->product(t.stride, scale, weight_.data(), view_.transmittance.data(), through_.data());
    const auto put = [&](Term term, const float* weight, const float* spectrum) {
        kernels_->band_sums(bands_, begin_.data(), weight, spectrum, terms + static_cast<int>(term) * bands_);
    };
    put(Term::GroundEmission, through_.data(), ground.part(GroundSpectra::Emission));
    put(Term::ReflectedSky, through_.data(), ground.part(GroundSpectra::Sky));
    put(Term::ReflectedThermalSky, through_.data(), ground.part(GroundSpectra::ThermalSky));
    put(Term::ReflectedFlame, through_.data(), ground.part(GroundSpectra::FlameLight));
    put(Term::FlameEmission, through_.data(), pixel.flame());
    if (prepared_->smoke) {
        put(Term::SmokeEmission, through_.data(), pixel.smoke());
        put(Term::SmokeScattering, through_.data(), pixel.scattered());
    }
    put(Term::PathSolar, weight_.data(), view_.path_solar.data());
    put(Term::PathThermal, weight_.data(), view_.path_thermal.data());
    put(Term::Adjacency, weight_.data(), view_.adjacency.data());
    kernels_->product(t.stride, 1.0F, ground.part(GroundSpectra::Sun), view_.solar_correlation.data(), at_sensor_.data());
    put(Term::ReflectedSun, through_.data(), at_sensor_.data());
}

}  // namespace pyroscene::render
