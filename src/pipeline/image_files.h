#pragma once

#include <optional>
#include <vector>

#include "gis/tiff_writer.h"
#include "pipeline/geolocation.h"
#include "pipeline/render_phase.h"

namespace pyroscene::pipeline {

/// Radiance, truth and geolocation of one camera group, written a few lines at a time as they are rendered. Files appear in
/// finish(), radiance last: its presence says that the acquisition is rendered.
class ImageFiles {
public:
    /// \param plume  the scene has the terms of smoke
    ImageFiles(const GroupJob& job, bool plume);

    /// So many lines are handed over at a time (the last time what is left).
    [[nodiscard]] int lines_at_once() const noexcept { return lines_at_once_; }
    /// Applies the detector and writes radiance and truth.
    void add(const render::RadianceImage& lines, RunReport& report);
    void finish(const Geolocation& geolocation, RunReport& report);

private:
    void measure(std::size_t k, std::size_t first_pixel, std::vector<float>& plane, std::vector<std::uint8_t>& saturated);
    void add_pixel_truth(const render::RadianceImage& lines, const gis::RasterPart& part);

    const GroupJob* job_;
    std::vector<sensors::Band> bands_;     ///< as measured with
    std::vector<std::int64_t> saturated_;  ///< pixels per band
    int lines_at_once_;
    std::optional<gis::TiffWriter> radiance_, truth_;
};

}  // namespace pyroscene::pipeline
