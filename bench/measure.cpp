#include "bench/measure.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <system_error>

namespace pyroscene::bench {
namespace {

double seconds(const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); }

[[noreturn]] void run_child(const std::function<std::vector<double>()>& work, int threads, int pipe_end) {
    int status = 1;
    try {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
        const std::vector<double> results = work();
        const auto bytes = results.size() * sizeof(double);
        if (write(pipe_end, results.data(), bytes) == static_cast<ssize_t>(bytes)) status = 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "benchmark failed: %s\n", e.what());
    }
    _exit(status);
}

template <class Get>
double median(const std::vector<Usage>& runs, Get&& get) {
    std::vector<double> values;
    for (const Usage& run : runs) values.push_back(get(run));
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

Usage median_of(const std::vector<Usage>& runs) {
    Usage m;
    m.cpu_s = median(runs, [](const Usage& u) { return u.cpu_s; });
    m.wall_s = median(runs, [](const Usage& u) { return u.wall_s; });
    m.peak_MB = median(runs, [](const Usage& u) { return u.peak_MB; });
    for (std::size_t i = 0; i < runs.front().results.size(); ++i) {
        m.results.push_back(median(runs, [i](const Usage& u) { return u.results.at(i); }));
    }
    return m;
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "pyroscene_bench_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a folder for the benchmark");
    path = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
}

Usage measure(const std::function<std::vector<double>()>& work, int threads) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) throw std::runtime_error("no pipe for the benchmark's child process");
    const auto start = std::chrono::steady_clock::now();
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("no child process for the benchmark");
    if (child == 0) {
        close(ends[0]);
        run_child(work, threads, ends[1]);
    }
    close(ends[1]);
    Usage usage;
    double value = 0.0;
    while (read(ends[0], &value, sizeof value) == static_cast<ssize_t>(sizeof value)) usage.results.push_back(value);
    close(ends[0]);
    int status = 0;
    rusage used{};
    wait4(child, &status, 0, &used);
    usage.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw std::runtime_error("a benchmark's child process failed");
    usage.cpu_s = seconds(used.ru_utime) + seconds(used.ru_stime);
    usage.peak_MB = static_cast<double>(used.ru_maxrss) / 1024.0;
    return usage;
}

Pair measure_alternately(const std::function<std::vector<double>()>& first,
                         const std::function<std::vector<double>()>& second, int pairs, int threads) {
    std::vector<Usage> a, b;
    std::vector<double> ratios;
    for (int p = 0; p < pairs; ++p) {
        a.push_back(measure(first, threads));
        b.push_back(measure(second, threads));
        ratios.push_back(a.back().cpu_s / b.back().cpu_s);
    }
    std::sort(ratios.begin(), ratios.end());
    return {median_of(a), median_of(b), ratios[ratios.size() / 2]};
}

Usage measure_median(const std::function<std::vector<double>()>& work, int runs, int threads) {
    std::vector<Usage> all;
    for (int r = 0; r < runs; ++r) all.push_back(measure(work, threads));
    return median_of(all);
}

}  // namespace pyroscene::bench
