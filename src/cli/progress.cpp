#include "cli/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

namespace pyroscene::cli {

Progress::Progress(bool quiet) : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1) {}

void Progress::update(const std::string& step, double fraction_done) {
    if (quiet_) return;
    const auto now = std::chrono::steady_clock::now();
    if (step != step_) {
        finish();
        step_ = step;
        step_start_ = now;
        shown_percent_ = -1;
        if (!terminal_) fmt::print(stderr, "{}\n", step);
    }
    if (!terminal_) return;
    const int percent = static_cast<int>(std::floor(100.0 * std::clamp(fraction_done, 0.0, 1.0)));
    if (percent == shown_percent_) return;
    shown_percent_ = percent;
    constexpr int kWidth = 30;
    const int filled = percent * kWidth / 100;
    const double elapsed_s = std::chrono::duration<double>(now - step_start_).count();
    std::string rate;
    if (percent > 0 && elapsed_s > 0.0)
        rate = fmt::format("{:.0f} %/s, {:.0f} s left", percent / elapsed_s, elapsed_s * (100.0 - percent) / percent);
    fmt::print(stderr, "\r{:<28} [{:#<{}}{:.<{}}] {:3d} %  {:<24}", step, "", filled, "", kWidth - filled, percent, rate);
    std::fflush(stderr);
    bar_open_ = true;
    if (percent >= 100) finish();
}

void Progress::finish() {
    if (bar_open_) fmt::print(stderr, "\n");
    bar_open_ = false;
}

}  // namespace pyroscene::cli
