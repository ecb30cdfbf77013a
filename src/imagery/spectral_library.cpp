#include "imagery/spectral_library.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "base/csv.h"
#include "base/error.h"
#include "base/files.h"

namespace pyroscene::imagery {
namespace {

std::string trimmed(const std::string& text) {
    const auto from = text.find_first_not_of(" \t\r\n"), to = text.find_last_not_of(" \t\r\n");
    return from == std::string::npos ? "" : text.substr(from, to - from + 1);
}

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

/// The keys of an ENVI header, lower case; values in braces without them, over as many lines as they run.
std::map<std::string, std::string> read_envi_header(const std::filesystem::path& path) {
    const auto text = read_text_file(path);
    if (!text.starts_with("ENVI")) throw input_error(path.string(), "is no ENVI header");
    std::map<std::string, std::string> header;
    for (std::size_t at = text.find('\n'); at != std::string::npos && at < text.size();) {
        const auto equals = text.find('=', at), line = text.find('\n', at + 1);
        if (equals == std::string::npos) break;
        if (line != std::string::npos && line < equals) {  // a line without a value
            at = line;
            continue;
        }
        const auto key = lower(trimmed(text.substr(at, equals - at)));
        const auto value = text.find_first_not_of(" \t", equals + 1);
        if (value != std::string::npos && text[value] == '{') {
            const auto close = text.find('}', value);
            if (close == std::string::npos) throw input_error(path.string(), fmt::format("'{}' has no closing brace", key));
            header[key] = text.substr(value + 1, close - value - 1);
            at = text.find('\n', close);
        } else {
            header[key] = trimmed(text.substr(equals + 1, line == std::string::npos ? line : line - equals - 1));
            at = line;
        }
    }
    return header;
}

std::vector<std::string> list_of(const std::string& text) {
    std::vector<std::string> items;
    for (std::size_t at = 0; at <= text.size();) {
        const auto comma = std::min(text.find(',', at), text.size());
        items.push_back(trimmed(text.substr(at, comma - at)));
        at = comma + 1;
    }
    return items;
}

template <class T>
std::vector<double> numbers_as(const std::string& bytes, std::size_t offset, std::size_t count, bool swap) {
    std::vector<double> out(count);
    for (std::size_t i = 0; i < count; ++i) {
        char raw[sizeof(T)];
        std::memcpy(raw, bytes.data() + offset + i * sizeof(T), sizeof(T));
        if (swap) std::reverse(raw, raw + sizeof(T));
        T value;
        std::memcpy(&value, raw, sizeof(T));
        out[i] = static_cast<double>(value);
    }
    return out;
}

struct EnviType {
    int code;
    std::size_t bytes;
    std::vector<double> (*read)(const std::string&, std::size_t, std::size_t, bool);
};
constexpr EnviType kTypes[] = {
    {1, 1, numbers_as<std::uint8_t>},   {2, 2, numbers_as<std::int16_t>}, {3, 4, numbers_as<std::int32_t>},
    {4, 4, numbers_as<float>},          {5, 8, numbers_as<double>},       {12, 2, numbers_as<std::uint16_t>},
    {13, 4, numbers_as<std::uint32_t>},
};

/// Ascending wavelengths, the spectra in the same order.
void sort_by_wavelength(SpectralLibrary& library) {
    std::vector<std::size_t> order(library.x.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return library.x[a] < library.x[b]; });
    const auto reorder = [&](std::vector<double>& values) {
        std::vector<double> sorted;
        sorted.reserve(order.size());
        for (const auto i : order) sorted.push_back(values[i]);
        values = std::move(sorted);
    };
    reorder(library.x);
    for (auto& spectrum : library.spectra) reorder(spectrum);
    const auto twin = std::adjacent_find(library.x.begin(), library.x.end());
    if (twin != library.x.end()) throw input_error(library.path, fmt::format("wavelength {} um is there twice", *twin));
}

SpectralLibrary read_envi(std::filesystem::path data) {
    auto header_path = data;
    if (lower(data.extension().string()) == ".hdr") {
        data.replace_extension();  // name.hdr belongs to name.sli, name.sli.hdr to name.sli
        if (lower(data.extension().string()) != ".sli") data += ".sli";
    } else {
        header_path.replace_extension(".hdr");
        std::error_code ignored;
        if (!std::filesystem::exists(header_path, ignored)) header_path = data.string() + ".hdr";
    }
    const auto header = read_envi_header(header_path);
    const auto subject = header_path.string();
    const auto text = [&](const char* key) {
        const auto found = header.find(key);
        if (found == header.end()) throw input_error(subject, fmt::format("no key '{}'", key));
        return found->second;
    };
    const auto count = [&](const char* key, double least) {
        const double value = parse_number(text(key), subject + ": " + key);
        if (!(value >= least)) throw input_error(subject, fmt::format("{} = {}", key, value));
        return static_cast<std::size_t>(value);
    };
    const auto samples = count("samples", 1), lines = count("lines", 1);
    const std::size_t offset = header.contains("header offset") ? count("header offset", 0) : 0;
    const auto code = static_cast<int>(count("data type", 1));
    const auto* type = std::find_if(std::begin(kTypes), std::end(kTypes), [&](const auto& t) { return t.code == code; });
    if (type == std::end(kTypes)) throw input_error(subject, fmt::format("data type {} is not supported", code));
    const bool big = header.contains("byte order") && count("byte order", 0) == 1;
    const auto unit = lower(text("wavelength units"));
    if (!unit.starts_with("micro") && !unit.starts_with("nano") && unit != "um" && unit != "nm")
        throw input_error(subject, fmt::format("wavelength units = '{}', expected nanometers or micrometers", unit));

    SpectralLibrary library{data.string(), false, {}, {}, {}};
    for (const auto& item : list_of(text("wavelength")))
        library.x.push_back((unit[0] == 'n' ? 1e-3 : 1.0) * parse_number(item, subject + ": wavelength"));
    library.names = list_of(text("spectra names"));
    if (library.x.size() != samples || library.names.size() != lines)
        throw input_error(subject, fmt::format("{} wavelengths and {} names for {} samples and {} lines", library.x.size(),
                                               library.names.size(), samples, lines));
    const auto bytes = read_text_file(data);
    if (bytes.size() < offset + samples * lines * type->bytes)
        throw input_error(data.string(), fmt::format("{} bytes, the header asks for {}", bytes.size(),
                                                     offset + samples * lines * type->bytes));
    const bool swap = big != (std::endian::native == std::endian::big);
    for (std::size_t k = 0; k < lines; ++k)
        library.spectra.push_back(type->read(bytes, offset + k * samples * type->bytes, samples, swap));
    sort_by_wavelength(library);
    return library;
}

SpectralLibrary read_table(const std::filesystem::path& path) {
    const CsvTable table = read_csv(path);
    SpectralLibrary library{table.path, false, {}, {}, {}};
    std::string abscissa;
    for (const auto& [column, per_um] :
         {std::pair{"wavelength_um", 1.0}, std::pair{"wavelength_nm", 1e-3}, std::pair{"band", 0.0}}) {
        if (!table.has(column)) continue;
        abscissa = column;
        library.by_band = per_um == 0.0;
        library.x = table.numbers(column);
        if (!library.by_band)
            for (double& v : library.x) v *= per_um;
        break;
    }
    if (abscissa.empty()) throw input_error(table.path, "no column 'wavelength_um', 'wavelength_nm' or 'band'");
    if (!std::is_sorted(library.x.begin(), library.x.end()))
        throw input_error(table.path, fmt::format("column '{}' must ascend", abscissa));
    for (const auto& column : table.columns) {
        if (column == "wavelength_um" || column == "wavelength_nm" || column == "fwhm_um" || column == "band") continue;
        library.names.push_back(column);
        library.spectra.push_back(table.numbers(column));
    }
    return library;
}

}  // namespace

SpectralLibrary read_spectral_library(const std::filesystem::path& path) {
    const auto ending = lower(path.extension().string());
    return ending == ".sli" || ending == ".hdr" ? read_envi(path) : read_table(path);
}

}  // namespace pyroscene::imagery
