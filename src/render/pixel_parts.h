#pragma once

#include <optional>
#include <vector>

#include "render/fire_detail.h"
#include "render/pixel.h"

namespace pyroscene::render {

/// Gathers the rays of pixels whose shares are wider than the fire they may hold: from the request's base shares on, a share
/// whose ground holds fire is halved until its rays stand as dense as FireDetail asks for, one at random in each part (a
/// function of pixel and part). Weights are those of the point-spread function, so energy is right on average whatever is
/// halved. One per thread.
class PartTracer {
public:
    PartTracer(const FireDetail& detail, const ImageRequest& request) : detail_(&detail), request_(&request) {}

    /// Starts a run of pixels; false when their base shares are narrow enough for any fire, and nothing need be traced.
    bool begin(int line, int first_sample, int end_sample);
    void trace(int sample, Pixel& pixel);

private:
    /// What the ray of a part met, and where the part lies on the ground.
    struct Seen {
        SceneRay ray;
        std::optional<Pixel::Met> met;
        Vec3 across_m, along_m;
        GroundBox box;
    };
    void look(int sample, const Pixel& pixel);
    bool shares_are_wide(int sample);
    [[nodiscard]] FireDetail::Spacing pixel_spacing() const;
    void split(const PixelPart& part, bool along_line, bool across_lines);

    const FireDetail* detail_;
    const ImageRequest* request_;
    int line_ = 0;
    ImageRequest::PartsOfLine parts_of_line_;
    std::vector<PixelPart> parts_, finer_;
    std::vector<PartView> views_;
    std::vector<Seen> seen_;
};

}  // namespace pyroscene::render
