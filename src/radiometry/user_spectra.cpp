#include "radiometry/user_spectra.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/csv.h"
#include "base/error.h"
#include "base/files.h"

namespace fs = std::filesystem;

namespace pyroscene::radiometry {
namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(" \t\r\n");
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

/// What a file holds, with the place in it of every sample.
struct Samples {
    std::vector<double> lambda_um, reflectance;
    std::vector<std::string> where;
};

/// Refuses what no reflectance spectrum is. Wavelengths that descend throughout are turned round.
Spectrum checked(const std::string& subject, Samples s) {
    const auto count = s.lambda_um.size();
    if (count < 2) throw input_error(subject, fmt::format("{} wavelengths, expected at least 2", count));
    const bool descends = s.lambda_um.back() < s.lambda_um.front();
    if (descends) {
        std::reverse(s.lambda_um.begin(), s.lambda_um.end());
        std::reverse(s.reflectance.begin(), s.reflectance.end());
        std::reverse(s.where.begin(), s.where.end());
    }
    for (std::size_t i = 0; i < count; ++i) {
        const double lambda = s.lambda_um[i], r = s.reflectance[i];
        if (!(lambda >= 0.1 && lambda <= 1000.0))
            throw input_error(s.where[i],
                              fmt::format("wavelength {:.6g} um, expected 0.1 to 1000 um; is the unit right?", lambda));
        if (i > 0 && !(lambda > s.lambda_um[i - 1])) {
            const auto later = descends ? i - 1 : i, earlier = descends ? i : i - 1;
            throw input_error(s.where[later],
                              fmt::format("wavelength {:.6g} um after {:.6g} um, expected {} as elsewhere",
                                          s.lambda_um[later], s.lambda_um[earlier], descends ? "descending" : "ascending"));
        }
        if (!(r >= 0.0 && r <= 1.0))
            throw input_error(s.where[i], fmt::format("reflectance {:.6g} at {:.6g} um, expected 0 to 1{}", r, lambda,
                                                      r > 1.0 && r <= 100.0 ? " (percent must be divided by 100)" : ""));
    }
    return {Quantity::Reflectance, std::move(s.lambda_um), std::move(s.reflectance)};
}

/// Which of two columns a table has. Both would say everything twice.
bool has_first(const CsvTable& table, const char* first, const char* second) {
    if (table.has(first) && table.has(second))
        throw input_error(table.path, fmt::format("has both {} and {}; keep one of them", first, second));
    if (!table.has(first) && !table.has(second))
        throw input_error(
            table.path, fmt::format("no column {} or {}; the table has {}", first, second, fmt::join(table.columns, ", ")));
    return table.has(first);
}

Spectrum from_csv(const fs::path& path) {
    const auto table = read_csv(path);
    for (const auto& column : table.columns)
        if (column != "wavelength_um" && column != "wavelength_nm" && column != "reflectance" && column != "emissivity")
            throw input_error(table.path,
                              fmt::format("column '{}' is unknown; there are wavelength_um or wavelength_nm, and "
                                          "reflectance or emissivity",
                                          column));
    const bool micrometres = has_first(table, "wavelength_um", "wavelength_nm");
    const bool reflectance = has_first(table, "reflectance", "emissivity");
    Samples s{table.numbers(micrometres ? "wavelength_um" : "wavelength_nm"),
              table.numbers(reflectance ? "reflectance" : "emissivity"),
              {}};
    for (double& lambda : s.lambda_um) lambda *= micrometres ? 1.0 : 1e-3;
    for (double& value : s.reflectance) value = reflectance ? value : 1.0 - value;
    for (const int line : table.row_lines) s.where.push_back(fmt::format("{}:{}", table.path, line));
    return checked(table.path, std::move(s));
}

/// "key = value" of an ENVI header; lists in braces may run over lines.
using Header = std::map<std::string, std::string>;

Header read_header(const fs::path& path) {
    std::istringstream in(read_text_file(path));
    Header header;
    std::string line;
    std::getline(in, line);
    if (trimmed(line) != "ENVI") throw input_error(path.string(), "is no ENVI header: its first line is not ENVI");
    while (std::getline(in, line)) {
        const auto equals = line.find('=');
        if (equals == std::string::npos) continue;
        std::string value = line.substr(equals + 1), more;
        while (value.find('{') != std::string::npos && value.find('}') == std::string::npos && std::getline(in, more))
            value += more;
        header[lower(trimmed(line.substr(0, equals)))] = trimmed(value);
    }
    return header;
}

std::vector<std::string> list_of(const std::string& value) {
    std::vector<std::string> out;
    const auto open = value.find('{'), close = value.find('}');
    if (open == std::string::npos || close == std::string::npos) return out;
    std::istringstream in(value.substr(open + 1, close - open - 1));
    for (std::string item; std::getline(in, item, ',');) out.push_back(trimmed(item));
    return out;
}

double header_number(const Header& header, const fs::path& path, const char* key, std::optional<double> fallback) {
    const auto it = header.find(key);
    if (it == header.end()) {
        if (fallback) return *fallback;
        throw input_error(path.string(), fmt::format("'{}' is missing", key));
    }
    return parse_number(it->second, fmt::format("{}, {}", path.string(), key));
}

template <class Word>
double value_at(const std::string& bytes, std::size_t offset, bool big_endian) {
    std::array<char, sizeof(Word)> raw{};
    std::memcpy(raw.data(), bytes.data() + offset, sizeof(Word));
    if (big_endian == (std::endian::native == std::endian::little)) std::reverse(raw.begin(), raw.end());
    Word word{};
    std::memcpy(&word, raw.data(), sizeof(Word));
    return static_cast<double>(word);
}

std::size_t line_of_spectrum(const Header& header, const fs::path& path, std::size_t lines, const std::string& name) {
    if (lines == 1) return 0;
    const auto it = header.find("spectra names");
    const auto names = it == header.end() ? std::vector<std::string>{} : list_of(it->second);
    for (std::size_t i = 0; i < std::min(names.size(), lines); ++i)
        if (lower(names[i]) == lower(name)) return i;
    throw input_error(path.string(),
                      fmt::format("holds {} spectra, none called '{}'; it has {}", lines, name, fmt::join(names, ", ")));
}

double micrometres_per_unit(const Header& header, const fs::path& path) {
    const auto it = header.find("wavelength units");
    const auto unit = it == header.end() ? std::string("unknown") : lower(it->second);
    if (unit == "micrometers" || unit == "micrometres" || unit == "um" || unit == "microns") return 1.0;
    if (unit == "nanometers" || unit == "nanometres" || unit == "nm") return 1e-3;
    throw input_error(path.string(), fmt::format("wavelength units {}, expected Micrometers or Nanometers",
                                                 it == header.end() ? "are missing" : "'" + it->second + "'"));
}

/// The header lies beside the library, as NAME.hdr or NAME.sli.hdr.
fs::path header_of(const fs::path& library) {
    std::error_code ignored;
    fs::path appended = library;
    appended += ".hdr";
    return fs::exists(appended, ignored) ? appended : fs::path(library).replace_extension(".hdr");
}

Spectrum from_envi(const fs::path& library, const std::string& name) {
    const auto path = header_of(library);
    const auto header = read_header(path);
    const auto samples = static_cast<std::size_t>(header_number(header, path, "samples", {}));
    const auto lines = static_cast<std::size_t>(header_number(header, path, "lines", {}));
    const auto skip = static_cast<std::size_t>(header_number(header, path, "header offset", 0.0));
    const int type = static_cast<int>(header_number(header, path, "data type", {}));
    const bool big_endian = header_number(header, path, "byte order", 0.0) != 0.0;
    const double scale = header_number(header, path, "reflectance scale factor", 1.0);
    if (type != 4 && type != 5)
        throw input_error(path.string(), fmt::format("data type {}, expected 4 or 5 (floating point)", type));
    if (!(scale > 0.0)) throw input_error(path.string(), fmt::format("reflectance scale factor {}", scale));
    const std::size_t width = type == 4 ? sizeof(float) : sizeof(double);
    const auto bytes = read_text_file(library);
    if (bytes.size() < skip + samples * lines * width)
        throw input_error(library.string(), fmt::format("{} bytes, expected {}: the library is cut off", bytes.size(),
                                                        skip + samples * lines * width));
    const auto it = header.find("wavelength");
    const auto wavelengths = it == header.end() ? std::vector<std::string>{} : list_of(it->second);
    if (wavelengths.size() != samples)
        throw input_error(path.string(), fmt::format("{} wavelengths, expected one for each of the {} samples",
                                                     wavelengths.size(), samples));
    const double unit = micrometres_per_unit(header, path);
    const std::size_t line = line_of_spectrum(header, path, lines, name);
    const double ignored = header_number(header, path, "data ignore value", std::numeric_limits<double>::quiet_NaN());
    Samples s;
    for (std::size_t i = 0; i < samples; ++i) {
        const std::size_t offset = skip + (line * samples + i) * width;
        const double value =
            type == 4 ? value_at<float>(bytes, offset, big_endian) : value_at<double>(bytes, offset, big_endian);
        if (std::abs(value - ignored) <= 1e-6 * std::abs(ignored)) continue;
        s.lambda_um.push_back(unit * parse_number(wavelengths[i], fmt::format("{}, wavelength", path.string())));
        s.reflectance.push_back(value / scale);
        s.where.push_back(fmt::format("{}, sample {}", library.string(), i + 1));
    }
    return checked(library.string(), std::move(s));
}

}  // namespace

Spectrum load_reflectance(const fs::path& path, const std::string& name) {
    const auto extension = lower(path.extension().string());
    if (extension == ".hdr") return from_envi(fs::path(path).replace_extension(".sli"), name);
    return extension == ".sli" ? from_envi(path, name) : from_csv(path);
}

std::vector<std::array<double, 2>> gaps_um(const Spectrum& spectrum) {
    const auto& lambda_um = spectrum.lambda_um;
    std::vector<double> steps;  // relative, as bands are wide in proportion to their wavelength
    for (std::size_t i = 1; i < lambda_um.size(); ++i) steps.push_back(lambda_um[i] / lambda_um[i - 1] - 1.0);
    if (steps.empty()) return {};
    auto sorted = steps;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    std::vector<std::array<double, 2>> gaps;
    for (std::size_t i = 0; i < steps.size(); ++i)
        if (steps[i] > std::max(10.0 * *middle, 0.05)) gaps.push_back({lambda_um[i], lambda_um[i + 1]});
    return gaps;
}

void add_spectra(SurfaceLibrary& library, const std::map<std::string, fs::path>& files) {
    for (const auto& [name, file] : files) {
        auto spectrum = load_reflectance(file, name);
        const auto known = std::find(library.names.begin(), library.names.end(), name);
        if (known != library.names.end()) {
            library.reflectance[static_cast<std::size_t>(known - library.names.begin())] = std::move(spectrum);
            continue;
        }
        library.names.push_back(name);
        library.reflectance.push_back(std::move(spectrum));
    }
}

void check_coverage(const SurfaceLibrary& library, const std::string& name, double lower_um, double upper_um) {
    const auto& s = library.reflectance[static_cast<std::size_t>(library.index_of(name))];
    if (s.lambda_um.front() <= lower_um * 1.001 && s.lambda_um.back() >= upper_um * 0.999) return;
    throw input_error(fmt::format("surface '{}'", name),
                      fmt::format("its spectrum covers {:.4g} to {:.4g} um, the bands need {:.4g} to {:.4g} um",
                                  s.lambda_um.front(), s.lambda_um.back(), lower_um, upper_um));
}

}  // namespace pyroscene::radiometry
