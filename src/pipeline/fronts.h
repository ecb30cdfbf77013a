#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/report.h"
#include "fire/state.h"

namespace pyroscene::pipeline {

/// A connected piece of fire front: front cells that touch by an edge or a corner.
struct Front {
    int label = 0;  ///< from 1; the piece with most cells first, of equal ones the northernmost (then westernmost)
    int cells = 0;
    double area_m2 = 0.0;              ///< of its cells
    double flaming_area_m2 = 0.0;      ///< the part of it that flames
    double length_m = 0.0;             ///< along the front, see find_fronts
    double mean_depth_m = 0.0;         ///< flaming area / length
    double intensity_kW_m = 0.0;       ///< heat released / length
    double mean_flame_height_m = 0.0;  ///< over the flaming area, without detached flames
    double x_m = 0.0, y_m = 0.0;       ///< centroid, map coordinates
};

struct Fronts {
    std::vector<Front> fronts;
    Raster<int> label;  ///< 0 = no front
};

/// Connected fronts of a state. Length: a band of length L and width w has area L w and, through the centres of its rim cells
/// (OpenCV's contours, holes too), an outline of 2 (L - 1) + 2 (w - 1) cells; L is the larger root. Right to a few per
/// cent for bands of any direction, straight, bent or closed.
/// \param heat_flux_W_m2 of the same frame, on the same grid
Fronts find_fronts(const fire::FireState& state, const Raster<float>& heat_flux_W_m2);

/// label,cells,area_m2,... one row per front.
std::string fronts_csv(const Fronts& fronts);

/// Where the fronts of a state file are listed: state/t000003600_fronts.csv.
std::filesystem::path fronts_path(std::filesystem::path state_file);

/// Records number, total length and largest front of a frame as fronts/<frame>/... .
void record_fronts(RunReport& report, const Fronts& fronts, const std::string& frame);

}  // namespace pyroscene::pipeline
