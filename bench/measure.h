#pragma once

#include <filesystem>
#include <functional>
#include <vector>

namespace pyroscene::bench {

/// A new folder that is removed at the end.
struct TemporaryFolder {
    /// Throws when none can be made.
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::filesystem::path path;
};

/// What a process used.
struct Usage {
    double cpu_s = 0.0;  ///< user + system
    double wall_s = 0.0;
    double peak_MB = 0.0;
    std::vector<double> results;
};

/// Runs `work` in a child process with the given number of threads and returns what the whole process used; `work` hands back
/// numbers. Throws when the child fails. The parent must not have started threads.
Usage measure(const std::function<std::vector<double>()>& work, int threads = 1);

/// Two pieces of work run alternately `pairs` times, so that a drifting machine meets both; the median of each figure.
struct Pair {
    Usage first, second;
    double cpu_ratio = 0.0;  ///< median of first / second of each pair
};
Pair measure_alternately(const std::function<std::vector<double>()>& first,
                         const std::function<std::vector<double>()>& second, int pairs, int threads = 1);

/// Median of several runs of one piece of work.
Usage measure_median(const std::function<std::vector<double>()>& work, int runs, int threads = 1);

}  // namespace pyroscene::bench
