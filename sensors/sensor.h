#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/spectrum.h"
#include "sensors/scan.h"

namespace pyroscene::sensors {

/// How an instrument looks at the ground, in the words of the sensor files; ScanLaw says it in numbers.
enum class ScanType { Framing, Pushbroom, Whiskbroom, LineScanner, Conical, SpinScan, GeoScan };

/// One focal plane: bands of a group share pixels.
struct CameraGroup {
    std::string id;
    int samples = 0, lines = 0;                        ///< nx, ny; scanners: samples per line, detectors along track
    double focal_length_m = 0.0, pixel_pitch_m = 0.0;  ///< 0 = not in the file: no lines of sight
    std::array<double, 2> principal_point_px{};        ///< pixel CENTRES at integers, as the files write it
    std::array<double, 3> radial{};                    ///< Brown k1, k2, k3 on (x/f, y/f)
    std::array<double, 2> tangential{};                ///< Brown p1, p2
    ScanLaw scan{};                                    ///< of the first view
    struct View {
        std::string name;
        ScanLaw scan{};
    };
    std::vector<View> views{};  ///< cones look at the same ground twice; empty for all others
};

/// Circular orbit; height above the ellipsoid under the satellite.
struct Orbit {
    double height_m = 0.0;
    double inclination_deg = 0.0;                         ///< above 90 = retrograde
    std::optional<double> geostationary_longitude_deg{};  ///< of a satellite that stands still
};

/// How the images of an instrument are handed out, beside GeoTIFF.
enum class NativeForm { None, AvirisEnvi, AvirisNgEnvi, ModisL1b, ViirsL1b, OrientedFrames, AirborneStrip };

/// Point-spread function along one image axis.
struct Psf {
    enum class Shape { None, Box, Triangle, Gaussian, Trapezoid } shape = Shape::None;
    double width_samples = 1.0;         ///< FWHM (gaussian) or full base of box / triangle, in samples
    double second_width_samples = 0.0;  ///< trapezoid: the box of width_samples is convolved with a box of this width
};

/// Radiance noise of a band.
struct Noise {
    enum class Kind {
        None,
        NoiseEquivalentTemperature,
        NoiseEquivalentRadiance,
        SignalToNoise,
        SignalToNoiseAtAlbedo
    } kind = Kind::None;
    double value = 0.0;                   ///< K, W m-2 sr-1 um-1, or ratio
    double shot = 0.0;                    ///< of a NEdL: variance per radiance [W m-2 sr-1 um-1]
    double at_temperature_K = 300.0;      ///< of an NEdT
    std::optional<double> at_radiance{};  ///< W m-2 sr-1 um-1 of an SNR; absent: ratio to the signal itself
    std::optional<double> at_albedo{};
};

struct Band {
    std::string id, group;
    double centre_um = 0.0, fwhm_um = 0.0;
    Spectrum response;  ///< Quantity::Response, peak 1
    bool measured_response = false;
    std::string response_source;  ///< "boxcar 3 - 5 um" or "srf/modis-terra.csv, band 20"
    Noise noise;
    std::optional<double> saturation_radiance_W_m2_sr_um;
    std::optional<int> bits;
    /// A second, more sensitive range of the same detector (gain, or longer exposure): signals up to its maximum are counted
    /// over it, with its noise; `noise` and the saturation are those of the wide range.
    struct SensitiveRange {
        double maximum_W_m2_sr_um = 0.0;
        Noise noise;
        std::optional<double>
            share_of_counts{};  ///< dual slope: of the one scale that both ranges share; else each counts to 2^bits
    };
    std::optional<SensitiveRange> sensitive_range;
    double noise_factor = 1.0;  ///< on `noise`: of a shorter exposure than the one it was stated for
    /// Signals beyond this many times the saturation run over the counter and come out as what exceeds it, modulo the full
    /// scale; nullopt = they are clipped however bright.
    std::optional<double> fold_over;
};

/// Light that misses its pixel: a share of it spread by a Gaussian over the neighbourhood.
struct StrayLight {
    double share = 0.0;         ///< 0..1, 0 = none
    double fwhm_samples = 0.0;  ///< along both axes
};

struct Sensor {
    std::string id, name, platform_name, source_path;
    bool airborne = true;
    double altitude_agl_m = 0.0, ground_speed_m_s = 0.0;
    std::optional<Orbit> orbit;
    ScanType scan = ScanType::Framing;
    std::array<double, 3> boresight_offset_rad{};  ///< roll, pitch, heading misalignment between body and camera
    std::vector<CameraGroup> groups;
    Psf psf_across, psf_along;
    StrayLight stray;
    std::vector<Band> bands;  ///< in file order
    NativeForm native_form = NativeForm::None;
    std::vector<double> native_gain;                     ///< AvirisEnvi: counts per uW cm-2 nm-1 sr-1 of each band
    std::vector<std::array<std::string, 2>> confidence;  ///< {path of a number, code}, in file order; the last match wins
    std::vector<std::array<std::string, 2>> sources;     ///< {key used in the codes, text}

    /// Throws an input error listing the groups there are.
    [[nodiscard]] const CameraGroup& group(const std::string& id) const;
    [[nodiscard]] std::vector<int> bands_of(const std::string& group_id) const;
    [[nodiscard]] int band_index(const std::string& id) const;  ///< -1 = none
};

/// A shipped sensor by id, or a YAML file by path (a name with '/' or ending in .yaml or .yml). Strict: an unknown key is
/// an error with line and nearest key; all problems of a file are reported in one input error.
Sensor load_sensor(const std::string& id_or_path);
/// Ids of the shipped sensors, sorted.
std::vector<std::string> sensor_ids();

}  // namespace pyroscene::sensors
