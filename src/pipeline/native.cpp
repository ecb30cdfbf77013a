#include "pipeline/native.h"

#include <fmt/format.h>

namespace pyroscene::pipeline {

void write_native(const ProductJob& job, const RenderedImage& image, const analysis::OrthoLookup& lookup,
                  RunReport& report) {
    const NativeJob native{job, image, lookup, report, job.files.folder / "native"};
    using sensors::NativeForm;
    if (job.sensor.native_form != NativeForm::None) std::filesystem::create_directories(native.folder);
    switch (job.sensor.native_form) {
        case NativeForm::AvirisEnvi:
        case NativeForm::AvirisNgEnvi:
            return write_aviris(native);
        case NativeForm::ModisL1b:
            return write_modis(native);
        case NativeForm::ViirsL1b:
            return write_viirs(native);
        case NativeForm::OrientedFrames:
            return write_oriented_frame(native);
        case NativeForm::AirborneStrip:
            return write_strip(native);
        case NativeForm::None:
            report.warn(fmt::format("acquisition '{}': sensor '{}' has no native form beside GeoTIFF", job.acquisition.id,
                                    job.sensor.id));
    }
}

}  // namespace pyroscene::pipeline
