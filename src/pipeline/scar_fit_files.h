#pragma once

#include <filesystem>
#include <string>

#include "fire/scar_fit.h"

namespace pyroscene::pipeline {

/// A time-temperature record as its file has it.
struct ScarRecordFile {
    fire::ScarRecord record;
    bool celsius = false;  ///< the file's temperatures are degrees Celsius
};

/// Reads a CSV table with a time column (time_s or t_s) and a temperature column (temperature_K, T_K, temperature_C, T_C,
/// temperature_degC or T_degC). Throws an input error naming file and line.
ScarRecordFile read_scar_record(const std::filesystem::path& path);

/// The `scar` section of a scenario with the fitted coefficients, 9 digits.
std::string scar_yaml(const fire::ScarFit& fit);

/// What the fit found, for people: coefficients with standard errors, covariance, sum of squares, verdict.
std::string scar_fit_text(const ScarRecordFile& file, const fire::ScarFit& fit, const std::string& algorithm);

/// Writes PREFIX.png (data, curve and residuals), PREFIX.json and, when the fit converged, PREFIX.yaml; creates the folder.
/// Whole files only. Returns what was written, one name per line.
std::string write_scar_fit(const std::filesystem::path& prefix, const std::filesystem::path& csv, const ScarRecordFile& file,
                           const fire::ScarFit& fit, const std::string& algorithm);

}  // namespace pyroscene::pipeline
