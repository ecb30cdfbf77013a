#pragma once

#include "pipeline/rendered_image.h"

namespace pyroscene::pipeline {

/// Writes the image as the users of the instrument know it (docs/outputs.md, "Native forms") into the folder `native` of the
/// acquisition, by the `native_form` of the sensor file; warns when it has none.
/// \param lookup  of the map the ortho products lie on
/// \return the files written
std::vector<std::filesystem::path> write_native(const ProductJob& job, const RenderedImage& image,
                                                const analysis::OrthoLookup& lookup, RunReport& report);

/// What each form needs.
struct NativeJob {
    const ProductJob& job;
    const RenderedImage& image;
    const analysis::OrthoLookup& lookup;
    RunReport& report;
    std::filesystem::path folder;
    std::vector<std::filesystem::path>& written;

    /// A file of the form, by its name.
    [[nodiscard]] std::filesystem::path file(const std::string& name) const { return written.emplace_back(folder / name); }
    [[nodiscard]] double unix_s() const { return job.scenario.start.unix_s + job.acquisition.time_s; }
    [[nodiscard]] const sensors::Band& band(std::size_t k) const {
        return job.sensor.bands[static_cast<std::size_t>(job.bands[k])];
    }
};
void write_aviris(const NativeJob& job);
void write_modis(const NativeJob& job);
void write_viirs(const NativeJob& job);
void write_oriented_frame(const NativeJob& job);  ///< needs the geometry
void write_strip(const NativeJob& job);           ///< needs the geometry

}  // namespace pyroscene::pipeline
