#include "gis/cog_tags.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include <cpl_conv.h>
#include <cpl_string.h>
#include <fmt/format.h>

#include "base/error.h"

namespace pyroscene::gis {
namespace {

constexpr const char* kReservationKey = "PYROSCENE_RESERVED";

std::string xml_escaped(const std::string& text) {
    char* escaped = CPLEscapeString(text.c_str(), static_cast<int>(text.size()), CPLES_XML);
    std::string result(escaped);
    CPLFree(escaped);
    return result;
}

/// As the GeoTIFF driver writes items; `sample` counts bands from 0.
std::string xml_item(const Tag& tag) {
    const std::string sample = tag.band > 0 ? fmt::format(" sample=\"{}\"", tag.band - 1) : std::string();
    return fmt::format("<Item name=\"{}\"{} domain=\"{}\">{}</Item>\n", xml_escaped(tag.key), sample,
                       xml_escaped(tag.domain), xml_escaped(tag.value));
}

std::string xml_reservation(std::size_t length) {
    return fmt::format("<Item name=\"{}\">{}</Item>", kReservationKey, std::string(length, '0'));
}

}  // namespace

CogTags::CogTags(const std::vector<Tag>& tags) {
    for (const Tag& tag : tags)
        if (tag.domain.empty())
            plain_.push_back(tag);
        else
            replacement_ += xml_item(tag);
    if (replacement_.empty()) return;
    const std::size_t frame = xml_reservation(0).size();
    const std::size_t filler = replacement_.size() > frame ? replacement_.size() - frame : 1;
    reservation_ = xml_reservation(filler);
    replacement_.resize(reservation_.size(), ' ');
    plain_.push_back({.band = 0, .domain = "", .key = kReservationKey, .value = std::string(filler, '0')});
}

void CogTags::complete(const std::filesystem::path& file) const {
    if (reservation_.empty()) return;
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    // The header holds this text, the names and the tile index: far below this bound for any raster we write.
    constexpr std::size_t kMostHeader = 64 << 20, kPiece = 1 << 18;
    std::string header;
    std::size_t position = std::string::npos;
    while (position == std::string::npos && stream && header.size() < kMostHeader) {
        const std::size_t known = header.size();
        header.resize(known + kPiece);
        stream.read(header.data() + known, static_cast<std::streamsize>(kPiece));
        header.resize(known + static_cast<std::size_t>(stream.gcount()));
        position = header.find(reservation_, known - std::min(known, reservation_.size()));
    }
    if (position == std::string::npos)
        throw runtime_error(file.string(), "metadata cannot be placed: reservation not found");
    stream.clear();
    stream.seekp(static_cast<std::streamoff>(position));
    stream.write(replacement_.data(), static_cast<std::streamsize>(replacement_.size()));
    stream.close();
    if (!stream) throw runtime_error(file.string(), "cannot be written");
}

}  // namespace pyroscene::gis
