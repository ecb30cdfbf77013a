#include "gis/crs.h"

#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <ogr_spatialref.h>
#include <proj.h>

#include "base/error.h"
#include "gis/gdal_support.h"
#include "gis/geodesy.h"

namespace pyroscene::gis {
namespace {

OGRSpatialReference read_crs(const std::string& text, const std::string& subject) {
    initialise_gdal();
    const GdalErrors errors;
    static const char* const options[] = {"ALLOW_NETWORK_ACCESS=NO", "ALLOW_FILE_ACCESS=NO", nullptr};
    OGRSpatialReference crs;
    if (text.empty() || crs.SetFromUserInput(text.c_str(), options) != OGRERR_NONE || crs.IsEmpty())
        throw input_error(subject,
                          fmt::format("'{}' is not a coordinate reference system that PROJ knows{}; expected for example "
                                      "EPSG:32611, a PROJ string or WKT",
                                      text, errors.failed() ? " (" + errors.message() + ")" : ""));
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (crs.IsCompound()) crs.StripVertical();
    return crs;
}

std::string wkt2(const OGRSpatialReference& crs, const std::string& subject) {
    static const char* const options[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", nullptr};
    char* text = nullptr;
    const GdalErrors errors;
    const bool done = crs.exportToWkt(&text, options) == OGRERR_NONE && text != nullptr;
    std::string wkt = done ? text : "";
    CPLFree(text);
    if (!done) throw input_error(subject, "the coordinate reference system cannot be written as WKT: " + errors.message());
    return wkt;
}

}  // namespace

bool CrsInfo::projected_in_metres() const noexcept { return projected && std::abs(metres_per_unit - 1.0) < 1e-9; }

CrsInfo parse_crs(const std::string& text, const std::string& subject) {
    const OGRSpatialReference crs = read_crs(text, subject);
    CrsInfo info;
    info.wkt = wkt2(crs, subject);
    info.name = crs.GetName() != nullptr ? crs.GetName() : "unnamed";
    info.geographic = crs.IsGeographic() != 0;
    info.projected = crs.IsProjected() != 0;
    if (info.projected) info.metres_per_unit = crs.GetLinearUnits();
    return info;
}

CrsInfo parse_map_crs(const std::string& text, const std::string& subject) {
    CrsInfo info = parse_crs(text, subject);
    if (!info.projected)
        throw input_error(subject,
                          fmt::format("the coordinate reference system '{}' is {}; expected a projected one in metres, "
                                      "such as a UTM zone",
                                      info.name, info.geographic ? "geographic (degrees)" : "not projected"));
    if (!info.projected_in_metres())
        throw input_error(
            subject, fmt::format("the coordinate reference system '{}' has a unit of {:.10g} m; expected metres", info.name,
                                 info.metres_per_unit));
    return info;
}

bool same_crs(const std::string& wkt_a, const std::string& wkt_b) {
    if (wkt_a == wkt_b) return true;
    const auto a = read_crs(wkt_a, "CRS"), b = read_crs(wkt_b, "CRS");
    static const char* const options[] = {"IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES", nullptr};
    return a.IsSame(&b, options) != 0;
}

struct CrsTransform::Impl {
    PJ_CONTEXT* context = proj_context_create();
    PJ* pipeline = nullptr;

    Impl() { proj_log_level(context, PJ_LOG_NONE), proj_context_set_enable_network(context, 0); }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        proj_destroy(pipeline);
        proj_context_destroy(context);
    }
    void run(PJ_DIRECTION direction, std::span<double> x, std::span<double> y) const;
};

void CrsTransform::Impl::run(PJ_DIRECTION direction, std::span<double> x, std::span<double> y) const {
    if (x.size() != y.size()) throw runtime_error("coordinate transformation", "x and y differ in number");
    constexpr auto stride = sizeof(double);
    proj_trans_generic(pipeline, direction, x.data(), stride, x.size(), y.data(), stride, y.size(), nullptr, 0, 0, nullptr,
                       0, 0);
    proj_errno_reset(pipeline);
    for (std::size_t i = 0; i < x.size(); ++i)
        if (!std::isfinite(x[i]) || !std::isfinite(y[i])) x[i] = y[i] = std::numeric_limits<double>::quiet_NaN();
}

CrsTransform::CrsTransform(const std::string& source, const std::string& target) : impl_(std::make_unique<Impl>()) {
    PJ* raw = proj_create_crs_to_crs(impl_->context, source.c_str(), target.c_str(), nullptr);
    if (raw != nullptr) impl_->pipeline = proj_normalize_for_visualization(impl_->context, raw);
    proj_destroy(raw);
    if (impl_->pipeline == nullptr) {
        const int code = proj_context_errno(impl_->context);
        throw input_error("coordinate transformation", fmt::format("PROJ knows no way from '{}' to '{}': {}", source, target,
                                                                   code != 0 ? proj_errno_string(code) : "unknown cause"));
    }
}
CrsTransform::CrsTransform(CrsTransform&&) noexcept = default;
CrsTransform::~CrsTransform() = default;

void CrsTransform::forward(std::span<double> x, std::span<double> y) const { impl_->run(PJ_FWD, x, y); }
void CrsTransform::inverse(std::span<double> x, std::span<double> y) const { impl_->run(PJ_INV, x, y); }

double y_axis_azimuth_rad(const CrsTransform& to_lonlat, double x, double y, double half_step) {
    std::array<double, 3> lon{x, x, x}, lat{y - half_step, y, y + half_step};
    to_lonlat.forward(lon, lat);
    const Vec3 chord = ecef_from_geodetic({lat[2], lon[2], 0.0}) - ecef_from_geodetic({lat[0], lon[0], 0.0});
    const LocalAxes axes = local_axes(lat[1], lon[1]);
    return std::atan2(dot(chord, axes.east), dot(chord, axes.north));
}

}  // namespace pyroscene::gis
