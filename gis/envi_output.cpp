#include "gis/envi_output.h"

#include <algorithm>
#include <bit>
#include <fstream>
#include <type_traits>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <ogr_spatialref.h>

#include "base/error.h"
#include "base/files.h"
#include "gis/gdal_support.h"

namespace pyroscene::gis {
namespace {

/// ENVI's number of a sample type.
template <class T>
constexpr int envi_type() {
    if constexpr (std::is_same_v<T, std::int16_t>) return 2;
    if constexpr (std::is_same_v<T, std::int32_t>) return 3;
    if constexpr (std::is_same_v<T, float>) return 4;
    return 5;
}

template <class T>
std::string braces(const std::vector<T>& values, const char* format) {
    std::vector<std::string> words;
    for (const auto& value : values) words.push_back(fmt::format(fmt::runtime(format), value));
    return fmt::format("{{{}}}", fmt::join(words, ", "));
}

std::string map_fields(const MapGrid& grid) {
    OGRSpatialReference crs;
    crs.importFromWkt(grid.crs_wkt.c_str());
    int north = 0;
    const int zone = crs.GetUTMZone(&north);
    const auto corner =
        fmt::format("1, 1, {:.6f}, {:.6f}, {:.9g}, {:.9g}", grid.west_m, grid.north_m, grid.cell_m, grid.cell_m);
    const char* datum = crs.GetAttrValue("DATUM");
    const bool wgs84 = datum != nullptr && std::string(datum) == "WGS_1984";
    std::string out = zone != 0 && wgs84 ? fmt::format("map info = {{UTM, {}, {}, {}, WGS-84, units=Meters}}\n", corner,
                                                       zone, north != 0 ? "North" : "South")
                                         : fmt::format("map info = {{Arbitrary, {}, 0, North, units=Meters}}\n", corner);
    crs.morphToESRI();
    char* wkt = nullptr;
    if (crs.exportToWkt(&wkt) == OGRERR_NONE) out += fmt::format("coordinate system string = {{{}}}\n", wkt);
    CPLFree(wkt);
    return out;
}

template <class T>
std::string header_text(const EnviHeader& h) {
    std::string out = fmt::format(
        "ENVI\ndescription = {{{}}}\nsamples = {}\nlines = {}\nbands = {}\nheader offset = 0\nfile type = ENVI Standard\n"
        "data type = {}\ninterleave = bip\nbyte order = 1\n",
        h.description, h.samples, h.lines, h.bands, envi_type<T>());
    if (h.grid) out += map_fields(*h.grid);
    if (h.ignore_value) out += fmt::format("data ignore value = {:g}\n", *h.ignore_value);
    if (!h.band_names.empty()) out += "band names = " + braces(h.band_names, "{}") + "\n";
    if (!h.wavelength_nm.empty())
        out += "wavelength units = Nanometers\nwavelength = " + braces(h.wavelength_nm, "{:.4f}") +
               "\nfwhm = " + braces(h.fwhm_nm, "{:.4f}") + "\n";
    for (const auto& [key, value] : h.more) out += fmt::format("{} = {}\n", key, value);
    return out;
}

template <class T>
void most_significant_first(std::span<T> values) {
    if constexpr (std::endian::native == std::endian::little)
        for (T& value : values) {
            auto* bytes = reinterpret_cast<unsigned char*>(&value);
            std::reverse(bytes, bytes + sizeof(T));
        }
}

}  // namespace

template <class T>
void write_envi(const std::filesystem::path& path, const EnviHeader& header, const EnviLine<T>& line) {
    AtomicFile file(path);
    std::ofstream out(file.path(), std::ios::binary);
    std::vector<T> pixels(static_cast<std::size_t>(header.samples) * static_cast<std::size_t>(header.bands));
    for (int i = 0; i < header.lines; ++i) {
        line(i, pixels);
        most_significant_first(std::span(pixels));
        out.write(reinterpret_cast<const char*>(pixels.data()), static_cast<std::streamsize>(pixels.size() * sizeof(T)));
    }
    out.close();
    if (!out) throw runtime_error(path.string(), "cannot be written");
    file.commit();
    write_text_file(std::filesystem::path(path.string() + ".hdr"), header_text<T>(header));
}

template <class T>
void write_envi_rearranged(const std::filesystem::path& path, const EnviHeader& header, const std::filesystem::path& cube,
                           T fill, const std::function<std::ptrdiff_t(int line, int sample)>& source) {
    std::ifstream in(cube, std::ios::binary);
    const auto bands = static_cast<std::size_t>(header.bands);
    const auto bytes = static_cast<std::streamsize>(bands * sizeof(T));
    write_envi<T>(path, header, [&](int line, std::span<T> pixels) {
        for (int sample = 0; sample < header.samples; ++sample) {
            const auto pixel = pixels.subspan(static_cast<std::size_t>(sample) * bands, bands);
            const std::ptrdiff_t i = source(line, sample);
            if (i < 0) {
                std::fill(pixel.begin(), pixel.end(), fill);
                continue;
            }
            in.seekg(static_cast<std::streamoff>(i) * bytes);
            in.read(reinterpret_cast<char*>(pixel.data()), bytes);
            if (!in) throw runtime_error(cube.string(), "cannot be read again");
            most_significant_first(pixel);
        }
    });
}

template void write_envi_rearranged(const std::filesystem::path&, const EnviHeader&, const std::filesystem::path&,
                                    std::int16_t, const std::function<std::ptrdiff_t(int, int)>&);
template void write_envi_rearranged(const std::filesystem::path&, const EnviHeader&, const std::filesystem::path&, float,
                                    const std::function<std::ptrdiff_t(int, int)>&);

template void write_envi(const std::filesystem::path&, const EnviHeader&, const EnviLine<std::int16_t>&);
template void write_envi(const std::filesystem::path&, const EnviHeader&, const EnviLine<std::int32_t>&);
template void write_envi(const std::filesystem::path&, const EnviHeader&, const EnviLine<float>&);
template void write_envi(const std::filesystem::path&, const EnviHeader&, const EnviLine<double>&);

}  // namespace pyroscene::gis
