#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "radiometry/assemble_atmosphere.h"

namespace pyroscene::pipeline {

/// `pyroscene import-atmosphere`: output of MODTRAN or libRadtran to a look-up table that a scenario can name.
struct ImportAtmosphereRequest {
    std::vector<std::filesystem::path> files;  ///< outputs, or CSV lists of runs (column `file`)
    std::filesystem::path output;              ///< netCDF
    radiometry::RunHints hints;                ///< for all files; what a list says about one of them wins
    std::string format = "auto";               ///< auto, tape7, csv, json, chn, uvspec, table
    std::vector<std::string> uvspec_columns;   ///< in file order
    bool uvspec_thermal = false;
    bool without_sun = false;
    std::string command_line;
};

struct ImportAtmosphereResult {
    radiometry::AtmosphereTable table;
    std::vector<std::string> notes;
    std::size_t runs = 0;
};

/// Reads all runs of all files. Throws an input error naming file and line.
std::vector<radiometry::AtmosphereRun> read_atmosphere_runs(const ImportAtmosphereRequest& request);

/// Reads, assembles, writes. Throws an input error for what cannot be used, a runtime error for what cannot be written.
ImportAtmosphereResult import_atmosphere(const ImportAtmosphereRequest& request);

/// The runs of a MODTRAN6 JSON file with MODTRANOUTPUT.
std::vector<radiometry::AtmosphereRun> read_modtran_json(const std::string& path, const std::string& text,
                                                         const radiometry::RunHints& hints, const Spectrum& sun);

/// Writes a table as netCDF, with the variables of data/atmosphere.
void write_atmosphere_table(const std::filesystem::path& path, const radiometry::AtmosphereTable& table,
                            const std::map<std::string, std::string>& attributes);

}  // namespace pyroscene::pipeline
