#pragma once

#include <mutex>

#include "base/error.h"
#include "base/report.h"

namespace pyroscene::render {

/// Serialises progress calls of parallel work and turns the wish to cancel into an exception.
class Progress {
public:
    Progress(const Monitor& monitor, int steps) : monitor_(monitor), steps_(steps) {}

    void stop_if_cancelled() const {
        if (monitor_.is_cancelled()) throw Cancelled();
    }
    void advance() {
        if (!monitor_.progress) return;
        const std::scoped_lock lock(mutex_);
        ++done_;
        monitor_.progress(static_cast<double>(done_) / steps_);
    }

private:
    const Monitor& monitor_;
    std::mutex mutex_;
    int steps_, done_ = 0;
};

}  // namespace pyroscene::render
