#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace pyroscene {

/// What a run did: timings, counters and warnings, collected while it runs and written even when it fails.
/// Calls are thread-safe; none of them belongs into a per-ray loop.
class RunReport {
public:
    void warn(std::string message);
    void count(const std::string& name, std::int64_t increment);
    void add_time(const std::string& phase, double seconds);
    /// A physical result worth keeping, unit in the name ("energy/front_power_W").
    void record(const std::string& name, double value);

    [[nodiscard]] std::vector<std::string> warnings() const;
    [[nodiscard]] std::map<std::string, std::int64_t> counters() const;
    [[nodiscard]] std::map<std::string, double> timings_s() const;
    [[nodiscard]] std::map<std::string, double> values() const;

    /// Called for each warning as it happens (the CLI prints it). May be empty.
    std::function<void(const std::string&)> on_warning;

private:
    mutable std::mutex mutex_;
    std::vector<std::string> warnings_;
    std::map<std::string, std::int64_t> counters_;
    std::map<std::string, double> timings_s_, values_;
};

/// Adds the wall time of its own life to a phase of the report.
class PhaseTimer {
public:
    PhaseTimer(RunReport& report, std::string phase)
        : report_(report), phase_(std::move(phase)), start_(std::chrono::steady_clock::now()) {}
    PhaseTimer(const PhaseTimer&) = delete;
    PhaseTimer& operator=(const PhaseTimer&) = delete;
    ~PhaseTimer() {
        report_.add_time(phase_, std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count());
    }

private:
    RunReport& report_;
    std::string phase_;
    std::chrono::steady_clock::time_point start_;
};

/// What long work tells its caller and asks of it. Both members may be left empty.
struct Monitor {
    std::function<void(double fraction_done)> progress;  ///< called from one thread at a time
    const std::atomic<bool>* cancelled = nullptr;

    [[nodiscard]] bool is_cancelled() const noexcept {
        return cancelled != nullptr && cancelled->load(std::memory_order_relaxed);
    }
};

}  // namespace pyroscene
