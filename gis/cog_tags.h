#pragma once

#include <filesystem>
#include <vector>

#include "gis/tags.h"

namespace pyroscene::gis {

/// Metadata domains in a Cloud-Optimized GeoTIFF.
///
/// GDAL's COG driver is a copy driver, and copying to GeoTIFF keeps only the default domain; updating the finished file would
/// move its directory to the end and spoil the layout. So the copy carries one item of default metadata as long as the items
/// of all other domains, and after the driver has finished, that item is overwritten in place by them. No offset in the file
/// changes. (GDAL keeps metadata as XML text in the TIFF tag 42112, which sits uncompressed in the header.)
class CogTags {
public:
    explicit CogTags(const std::vector<Tag>& tags);

    /// Default-domain tags and the reservation: to be set on the source of the copy.
    [[nodiscard]] const std::vector<Tag>& before_writing() const noexcept { return plain_; }
    /// Replaces the reservation in the finished file. Throws a runtime error when it is not there.
    void complete(const std::filesystem::path& file) const;

private:
    std::vector<Tag> plain_;
    std::string reservation_, replacement_;  ///< XML elements of the same length
};

}  // namespace pyroscene::gis
