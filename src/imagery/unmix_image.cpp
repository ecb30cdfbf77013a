#include "imagery/unmix_image.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

#include <fmt/format.h>

#include "base/buffer.h"
#include "base/error.h"
#include "base/files.h"
#include "gis/image_stream.h"
#include "imagery/endmember_table.h"

namespace pyroscene::imagery {
namespace {

constexpr std::size_t kBlockValues = std::size_t{1} << 20;  ///< of the image that are in memory at once, twice
constexpr const char* kFractionPrefix = "fraction_";

int lines_per_block(const gis::ImageInfo& info) {
    const std::size_t line = static_cast<std::size_t>(info.cols) * info.bands.size();
    return static_cast<int>(std::clamp<std::size_t>(kBlockValues / line, 1, static_cast<std::size_t>(info.rows)));
}

/// Calls work(first line, lines, pixels [band][line][sample]) block after block while the next one is read.
template <class Work>
void for_each_block(gis::ImageStream& image, const UnmixJob& job, Work&& work) {
    const gis::ImageInfo& info = image.info();
    const int step = lines_per_block(info);
    const auto line = static_cast<std::size_t>(info.cols) * info.bands.size();
    Buffer<float> current, next;
    const auto read = [&](int first, Buffer<float>& into) {
        const int count = std::min(step, info.rows - first);
        into.resize(line * static_cast<std::size_t>(count));
        image.read(first, count, into);
    };
    read(0, current);
    for (int first = 0; first < info.rows; first += step) {
        if (job.cancelled != nullptr && job.cancelled->load()) throw Cancelled();
        tbb::task_group computing;
        computing.run([&] { work(first, std::min(step, info.rows - first), std::span<const float>(current)); });
        try {
            if (first + step < info.rows) read(first + step, next);
        } catch (...) {
            computing.wait();
            throw;
        }
        computing.wait();
        std::swap(current, next);
        if (job.on_progress) job.on_progress(static_cast<double>(std::min(first + step, info.rows)) / info.rows);
    }
}

/// The classes of a truth file and where their fractions are.
struct TruthClasses {
    gis::ImageFile file;
    std::vector<std::string> names;
    std::vector<std::size_t> planes;

    [[nodiscard]] double fraction(std::size_t k, std::size_t pixel) const {
        return file.pixels[planes[k] * static_cast<std::size_t>(file.cols) * static_cast<std::size_t>(file.rows) + pixel];
    }
};

TruthClasses read_truth(const std::filesystem::path& path, const gis::ImageInfo& image) {
    constexpr int kMostPlanes = 8;  // fractions come first
    TruthClasses truth{gis::read_image(path, kMostPlanes), {}, {}};
    if (truth.file.cols != image.cols || truth.file.rows != image.rows)
        throw input_error(path.string(), fmt::format("{} x {} pixels, the image has {} x {}", truth.file.cols,
                                                     truth.file.rows, image.cols, image.rows));
    for (std::size_t b = 0; b < truth.file.bands.size(); ++b) {
        const std::string& name = truth.file.bands[b].description;
        if (!name.starts_with(kFractionPrefix)) continue;
        truth.names.push_back(name.substr(std::string_view(kFractionPrefix).size()));
        truth.planes.push_back(b);
    }
    if (truth.names.empty()) throw input_error(path.string(), "no band named fraction_...");
    return truth;
}

/// Mean spectra of the pixels that hold (nearly) nothing but one class. Classes without such pixels are left out.
/// From which fraction on a pixel speaks for each class: the job's limit, or, for classes that never reach it, 90 % of what their
/// purest pixel holds, if that is enough for the job. Infinite for classes without such pixels.
std::vector<double> pure_limits(const TruthClasses& truth, const UnmixJob& job) {
    constexpr double kNearPurest = 0.9;
    const auto pixels = static_cast<std::size_t>(truth.file.cols) * static_cast<std::size_t>(truth.file.rows);
    std::vector<double> limits;
    for (std::size_t k = 0; k < truth.names.size(); ++k) {
        double purest = 0.0;
        for (std::size_t p = 0; p < pixels; ++p)
            if (truth.fraction(k, p) > purest) purest = truth.fraction(k, p);
        if (purest >= job.pure_fraction)
            limits.push_back(job.pure_fraction);
        else
            limits.push_back(job.purest_fraction && purest >= *job.purest_fraction
                                 ? kNearPurest * purest
                                 : std::numeric_limits<double>::infinity());
    }
    return limits;
}

analysis::Endmembers pure_spectra(gis::ImageStream& image, const TruthClasses& truth, const UnmixJob& job) {
    const auto limits = pure_limits(truth, job);
    const gis::ImageInfo& info = image.info();
    const std::size_t classes = truth.names.size(), bands = info.bands.size();
    std::vector<double> sums(classes * bands, 0.0);
    std::vector<std::int64_t> counts(classes, 0);
    for_each_block(image, job, [&](int first, int lines, std::span<const float> pixels) {
        const std::size_t n = static_cast<std::size_t>(lines) * static_cast<std::size_t>(info.cols);
        const std::size_t begin = static_cast<std::size_t>(first) * static_cast<std::size_t>(info.cols);
        for (std::size_t p = 0; p < n; ++p) {
            for (std::size_t k = 0; k < classes; ++k) {
                if (!(truth.fraction(k, begin + p) >= limits[k])) continue;
                bool valid = true;
                for (std::size_t b = 0; b < bands; ++b) valid = valid && std::isfinite(pixels[b * n + p]);
                if (!valid) continue;
                ++counts[k];
                for (std::size_t b = 0; b < bands; ++b) sums[k * bands + b] += static_cast<double>(pixels[b * n + p]);
            }
        }
    });
    analysis::Endmembers library{{}, static_cast<int>(bands), {}};
    for (std::size_t k = 0; k < classes; ++k) {
        if (counts[k] == 0) continue;
        library.names.push_back(truth.names[k]);
        for (std::size_t b = 0; b < bands; ++b)
            library.spectra.push_back(sums[k * bands + b] / static_cast<double>(counts[k]));
    }
    if (library.names.empty())
        throw input_error(
            job.truth->string(),
            fmt::format("no pixel holds {} or more of one class; lower the limit or give endmembers", job.pure_fraction));
    return library;
}

/// Classes of the truth that the library has under the same name, and where.
struct Match {
    std::size_t truth_class = 0, endmember = 0;
};
std::vector<Match> matches(const analysis::Endmembers& library, const TruthClasses& truth) {
    std::vector<Match> out;
    for (std::size_t k = 0; k < truth.names.size(); ++k) {
        const auto found = std::find(library.names.begin(), library.names.end(), truth.names[k]);
        if (found != library.names.end()) out.push_back({k, static_cast<std::size_t>(found - library.names.begin())});
    }
    return out;
}

/// Compares planes of fractions with the truth, which is put into the planes from `beside` on.
std::vector<FractionScore> scores(const std::vector<Match>& matched, const TruthClasses& truth, std::span<float> planes,
                                  std::size_t beside, std::size_t pixels) {
    std::vector<FractionScore> out;
    for (const auto& [truth_class, endmember] : matched) {
        const auto plane = planes.subspan(endmember * pixels, pixels),
                   truth_plane = planes.subspan((beside + out.size()) * pixels, pixels);
        FractionScore score{truth.names[truth_class], 0, 0.0, 0.0};
        for (std::size_t p = 0; p < pixels; ++p) {
            const double truth_fraction = truth.fraction(truth_class, p);
            truth_plane[p] = static_cast<float>(truth_fraction);
            const double error = static_cast<double>(plane[p]) - truth_fraction;
            if (!std::isfinite(error)) continue;
            ++score.pixels;
            score.mean_error += error;
            score.rms_error += error * error;
        }
        if (score.pixels > 0) {
            score.mean_error /= static_cast<double>(score.pixels);
            score.rms_error = std::sqrt(score.rms_error / static_cast<double>(score.pixels));
        }
        out.push_back(std::move(score));
    }
    return out;
}

void write_scores(const std::filesystem::path& path, const std::vector<FractionScore>& scored) {
    std::string text = "endmember,pixels,rms_error,mean_error\n";
    for (const auto& s : scored) text += fmt::format("{},{},{:.9g},{:.9g}\n", s.name, s.pixels, s.rms_error, s.mean_error);
    write_text_file(path, text);
}

void write_result(const UnmixJob& job, bool with_noise, const gis::ImageInfo& info, const analysis::Endmembers& library,
                  const std::vector<FractionScore>& scored, std::span<const float> planes) {
    gis::OutputRaster out;
    out.cols = info.cols;
    out.rows = info.rows;
    out.like = job.image;
    out.synthetic = info.metadata.contains("synthetic");
    out.metadata["SOURCE_IMAGE"] = job.image.filename().string();
    for (const auto& name : library.names) out.bands.push_back({"fraction of " + name, "1", {}, {}, {}});
    out.bands.push_back({"residual_rms", with_noise ? "standard deviations" : info.bands.front().unit, {}, {}, {}});
    out.bands.push_back({"chosen: sum of 2^k over the endmembers in use, k from 0", "", {}, {}, {}});
    out.bands.push_back({"unexplained: 1 = no mixture of the endmembers", "", {}, {}, {}});
    for (const auto& score : scored) out.bands.push_back({"truth: fraction of " + score.name, "1", {}, {}, {}});
    if (info.on_map)
        gis::write_cog(job.output, out, planes);
    else
        gis::write_geotiff(job.output, out, planes);
}

}  // namespace

UnmixReport unmix_image(const UnmixJob& job) {
    if (!job.endmembers && !job.truth) throw input_error("unmix", "endmembers or a truth file is needed");
    const auto cores = job.threads > 0 ? static_cast<std::size_t>(job.threads)
                                       : std::size_t{std::max(1U, std::thread::hardware_concurrency())};
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, cores);
    const gis::CompressionThreads compression_limit(job.threads);
    gis::ImageStream image(job.image);
    const gis::ImageInfo& info = image.info();
    std::optional<TruthClasses> truth;
    if (job.truth) truth = read_truth(*job.truth, info);
    UnmixReport report;
    report.library =
        job.endmembers ? read_endmembers(*job.endmembers, job.image, info, job.sensor) : pure_spectra(image, *truth, job);
    auto settings = job.settings;
    if (job.noise) settings.noise = read_noise(*job.noise, job.image, info);
    const analysis::Unmixer unmixer(report.library, settings);

    const auto k = static_cast<std::size_t>(report.library.count());
    const std::size_t pixels = static_cast<std::size_t>(info.cols) * static_cast<std::size_t>(info.rows);
    Buffer<float> planes;
    const auto matched = truth ? matches(report.library, *truth) : std::vector<Match>{};
    const std::size_t beside = k + 3;
    planes.resize((beside + matched.size()) * pixels);
    for_each_block(image, job, [&](int first, int lines, std::span<const float> values) {
        tbb::parallel_for(0, lines, [&](int line) {
            const auto n = static_cast<std::size_t>(info.cols);
            std::vector<float> fractions(k * n);
            const std::size_t at = static_cast<std::size_t>(first + line) * n;
            const auto plane = [&](std::size_t p) { return std::span(planes).subspan(p * pixels + at, n); };
            unmixer.unmix(values.data() + static_cast<std::size_t>(line) * n, static_cast<std::ptrdiff_t>(n) * lines,
                          info.cols, {fractions, plane(k), plane(k + 1), plane(k + 2)});
            for (std::size_t j = 0; j < k; ++j)
                std::copy_n(fractions.begin() + static_cast<std::ptrdiff_t>(j * n), n, plane(j).begin());
        });
    });
    std::vector<std::int64_t> chosen(k, 0);
    for (std::size_t p = 0; p < pixels; ++p) {
        if (std::isnan(planes[(k + 1) * pixels + p])) continue;
        ++report.pixels;
        report.unexplained += planes[(k + 2) * pixels + p] > 0.0F ? 1 : 0;
        const auto members = static_cast<std::uint32_t>(planes[(k + 1) * pixels + p]);
        for (std::size_t j = 0; j < k; ++j) chosen[j] += (members >> j & 1U) != 0 ? 1 : 0;
    }
    for (const auto count : chosen)
        report.chosen_percent.push_back(
            report.pixels > 0 ? 100.0 * static_cast<double>(count) / static_cast<double>(report.pixels) : 0.0);
    if (truth) report.scores = scores(matched, *truth, planes, beside, pixels);
    write_result(job, !settings.noise.empty(), info, report.library, report.scores, planes);
    const auto table = [&](const char* what) {
        return job.output.parent_path() / (job.output.stem().string() + "_" + what + ".csv");
    };
    if (!job.endmembers) write_endmembers(table("endmembers"), report.library, info);
    if (truth) write_scores(table("scores"), report.scores);
    return report;
}

}  // namespace pyroscene::imagery
