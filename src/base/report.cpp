#include "base/report.h"

#include <algorithm>

namespace pyroscene {

void RunReport::warn(std::string message) {
    const std::lock_guard lock(mutex_);
    if (std::find(warnings_.begin(), warnings_.end(), message) != warnings_.end()) return;
    if (on_warning) on_warning(message);
    warnings_.push_back(std::move(message));
}

void RunReport::count(const std::string& name, std::int64_t increment) {
    const std::lock_guard lock(mutex_);
    counters_[name] += increment;
}

void RunReport::add_time(const std::string& phase, double seconds) {
    const std::lock_guard lock(mutex_);
    timings_s_[phase] += seconds;
}

void RunReport::record(const std::string& name, double value) {
    const std::lock_guard lock(mutex_);
    values_[name] = value;
}

std::vector<std::string> RunReport::warnings() const {
    const std::lock_guard lock(mutex_);
    return warnings_;
}
std::map<std::string, std::int64_t> RunReport::counters() const {
    const std::lock_guard lock(mutex_);
    return counters_;
}
std::map<std::string, double> RunReport::timings_s() const {
    const std::lock_guard lock(mutex_);
    return timings_s_;
}
std::map<std::string, double> RunReport::values() const {
    const std::lock_guard lock(mutex_);
    return values_;
}

}  // namespace pyroscene
