#include "pipeline/rendered_image.h"

#include <algorithm>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_for_each.h>

namespace pyroscene::pipeline {
namespace {

/// Longitudes and latitudes become map coordinates in place; PROJ wants a transformation for each thread.
void to_map(const std::string& crs_wkt, std::span<double> x, std::span<double> y) {
    tbb::enumerable_thread_specific<gis::MapProjection> projections([&] { return gis::MapProjection(crs_wkt); });
    constexpr std::size_t kGrain = 1U << 14U;  // making a transformation costs as much as using it a few thousand times
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, x.size(), kGrain), [&](const auto& part) {
        projections.local().to_map(x.subspan(part.begin(), part.size()), y.subspan(part.begin(), part.size()));
    });
}

/// Ground area of each pixel from its neighbours (central differences), and the median pixel size.
void measure_pixels(RenderedImage& r) {
    r.pixel_area_m2.assign(r.n, std::nanf(""));
    std::vector<float> valid;
    for (int line = 0; line < r.lines; ++line)
        for (int sample = 0; sample < r.samples; ++sample) {
            const auto at = [&](int s, int l) {
                return static_cast<std::size_t>(l) * static_cast<std::size_t>(r.samples) + static_cast<std::size_t>(s);
            };
            const int s0 = std::max(sample - 1, 0), s1 = std::min(sample + 1, r.samples - 1);
            const int end = r.scans.end_of_scan(line, r.lines), before = std::max(line - 1, 0);
            const int l0 = r.scans.end_of_scan(before, r.lines) == end ? before : line, l1 = std::min(line + 1, end - 1);
            if (s1 == s0 || l1 == l0) continue;
            const std::size_t a = at(s0, line), b = at(s1, line), c = at(sample, l0), d = at(sample, l1);
            const double ux = (r.x_m[b] - r.x_m[a]) / (s1 - s0), uy = (r.y_m[b] - r.y_m[a]) / (s1 - s0);
            const double vx = (r.x_m[d] - r.x_m[c]) / (l1 - l0), vy = (r.y_m[d] - r.y_m[c]) / (l1 - l0);
            const auto area = static_cast<float>(std::abs(ux * vy - uy * vx));
            if (!std::isfinite(area)) continue;
            r.pixel_area_m2[at(sample, line)] = area;
            valid.push_back(area);
        }
    if (valid.empty()) return;
    const auto middle = valid.begin() + static_cast<std::ptrdiff_t>(valid.size() / 2);
    std::nth_element(valid.begin(), middle, valid.end());
    r.gsd_m = std::sqrt(*middle);
}

}  // namespace

void GeolocationFile::read(std::initializer_list<GeolocationPlane> wanted) const {
    tbb::parallel_for_each(wanted, [&](GeolocationPlane p) { (void)plane(p); });
}

std::span<const double> GeolocationFile::plane(GeolocationPlane p) const {
    auto& plane = planes_[p];
    if (plane.empty()) plane = gis::read_image_band(path_, p + 1);
    return plane;
}

double GeolocationFile::at(GeolocationPlane p, int sample, int line) const {
    return gis::read_image_pixel(path_, p + 1, sample, line);
}

RenderedImage read_ground(const ProductJob& job) {
    RenderedImage r;
    const auto file = job.files.geolocation();
    r.geolocation = GeolocationFile(file);
    const auto info = gis::ImageStream(file).info();
    r.samples = info.cols;
    r.lines = info.rows;
    r.n = static_cast<std::size_t>(r.samples) * static_cast<std::size_t>(r.lines);
    r.geolocation.read({kLongitude, kLatitude});
    r.x_m.assign(r.where(kLongitude).begin(), r.where(kLongitude).end());
    r.y_m.assign(r.where(kLatitude).begin(), r.where(kLatitude).end());
    to_map(job.inputs.grid.crs_wkt, r.x_m, r.y_m);
    const auto number = [&](const char* key) {
        const auto found = info.metadata.find(key);
        return found == info.metadata.end() ? 0 : std::stoi(found->second);
    };
    r.scans = {number("LINES_PER_SCAN"), number("FIRST_LINE_OF_SCAN")};
    measure_pixels(r);
    return r;
}

RenderedImage read_rendered(const ProductJob& job) {
    RenderedImage r = read_ground(job);
    r.radiance = std::make_unique<gis::ImageStream>(job.files.radiance());
    if (job.scenario.products.truth) r.truth = std::make_unique<gis::ImageStream>(job.files.truth());
    return r;
}

analysis::OrthoLookup visible_ground(const ProductJob& job, const RenderedImage& r, const MapGrid& grid, RunReport& report) {
    auto lookup = analysis::ortho_lookup(grid, r.samples, r.lines, r.x_m, r.y_m, r.where(kHeight), r.scans);
    // Heights between two pixels differ from the terrain by less than a pixel on any slope a camera sees, and the facets of the
    // mesh differ from a bilinear surface by a fraction of a terrain cell where it is rough.
    const double tolerance_m = 1.5 * r.gsd_m + 0.2 * job.inputs.grid.cell_m + 1.0;
    const auto hidden = analysis::hide_unseen(lookup, analysis::heights_on(grid, job.inputs.terrain_m), tolerance_m);
    report.count("hidden_ortho_cells/" + job.acquisition.id + job.files.suffix, hidden);
    return lookup;
}

double ortho_cell_m(double gsd_m) {
    const double unit = std::pow(10.0, std::floor(std::log10(gsd_m)) - 1.0);
    return std::round(gsd_m / unit) * unit;
}

}  // namespace pyroscene::pipeline
