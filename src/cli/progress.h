#pragma once

#include <chrono>
#include <string>

namespace pyroscene::cli {

/// Progress on standard error: a bar with the time left on a terminal, one plain line per step otherwise.
class Progress {
public:
    explicit Progress(bool quiet);
    /// To be called from one thread at a time.
    void update(const std::string& step, double fraction_done);
    /// Ends a bar that stands on the screen.
    void finish();

private:
    bool quiet_, terminal_, bar_open_ = false;
    std::string step_;
    int shown_percent_ = -1;
    std::chrono::steady_clock::time_point step_start_;
};

}  // namespace pyroscene::cli
