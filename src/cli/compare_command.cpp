#include "cli/compare_command.h"

#include <fmt/format.h>

#include "imagery/compare_images.h"

namespace pyroscene::cli {

void compare_command(const CompareOptions& o) {
    imagery::CompareJob job;
    job.synthetic = o.synthetic;
    job.real = o.real;
    job.output = o.output.empty() ? std::filesystem::path("out") / (job.synthetic.stem().string() + "_comparison")
                                  : std::filesystem::path(o.output);
    job.register_images = !o.no_registration;
    job.largest_shift = o.largest_shift;
    if (o.has_threshold) job.threshold = o.threshold;
    const auto report = imagery::compare_images(job);
    if (o.quiet) return;
    fmt::print("shift of the real image: {:.2f} m east, {:.2f} m north (correlation peak {:.3f}{})\n", report.shift_east_m,
               report.shift_north_m, report.registration_response,
               report.shift_believed ? "" : "; the shift found was too large to be believed");
    fmt::print("{:<32} {:>10} {:>10} {:>10} {:>8} {:>8} {:>8} {:>12}\n", "band", "pixels", "bias", "rmse", "corr", "ssim",
               "dice", "front m");
    for (const auto& b : report.bands)
        fmt::print("{:<32} {:>10} {:>10.4g} {:>10.4g} {:>8.4f} {:>8.4f} {:>8.4f} {:>12.4g}\n", b.name, b.agreement.pixels,
                   b.agreement.bias, b.agreement.rmse, b.agreement.correlation, b.agreement.ssim, b.fire.dice,
                   b.fire.front_distance_mean * report.pixel_m);
    fmt::print("written: {}\n", (job.output / "report.html").string());
}

}  // namespace pyroscene::cli
