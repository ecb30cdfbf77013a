#include "pipeline/native.h"

#include <fmt/format.h>

namespace pyroscene::pipeline {

std::vector<std::filesystem::path> write_native(const ProductJob& job, const RenderedImage& image,
                                                const analysis::OrthoLookup& lookup, RunReport& report) {
    std::vector<std::filesystem::path> written;
    const NativeJob native{job, image, lookup, report, job.files.folder / "native", written};
    using sensors::NativeForm;
    if (job.sensor.native_form != NativeForm::None) std::filesystem::create_directories(native.folder);
    switch (job.sensor.native_form) {
        case NativeForm::AvirisEnvi:
        case NativeForm::AvirisNgEnvi:
            write_aviris(native);
            break;
        case NativeForm::ModisL1b:
            write_modis(native);
            break;
        case NativeForm::ViirsL1b:
            write_viirs(native);
            break;
        case NativeForm::OrientedFrames:
            write_oriented_frame(native);
            break;
        case NativeForm::AirborneStrip:
            write_strip(native);
            break;
        case NativeForm::None:
            report.warn(fmt::format("acquisition '{}': sensor '{}' has no native form beside GeoTIFF", job.acquisition.id,
                                    job.sensor.id));
    }
    return written;
}

}  // namespace pyroscene::pipeline
