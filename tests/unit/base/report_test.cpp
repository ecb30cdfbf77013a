#include "base/report.h"

#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace pyroscene {
namespace {

TEST(RunReport, KeepsAWarningOnceAndTellsTheListener) {
    RunReport report;
    std::vector<std::string> heard;
    report.on_warning = [&](const std::string& text) { heard.push_back(text); };
    report.warn("frames far apart");
    report.warn("no arrival raster");
    report.warn("frames far apart");
    EXPECT_EQ(report.warnings(), (std::vector<std::string>{"frames far apart", "no arrival raster"}));
    EXPECT_EQ(heard, report.warnings());
}

TEST(RunReport, CountsFromManyThreads) {
    RunReport report;
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&] {
            for (int i = 0; i < 1000; ++i) report.count("rays", 3);
        });
    for (auto& thread : threads) thread.join();
    EXPECT_EQ(report.counters().at("rays"), 12000);
}

TEST(RunReport, AddsUpTheTimesOfAPhase) {
    RunReport report;
    report.add_time("render", 1.5);
    report.add_time("render", 0.25);
    EXPECT_DOUBLE_EQ(report.timings_s().at("render"), 1.75);
    { const PhaseTimer timer(report, "prepare"); }
    EXPECT_GE(report.timings_s().at("prepare"), 0.0);
}

TEST(Monitor, WithoutAFlagIsNeverCancelled) {
    EXPECT_FALSE(Monitor{}.is_cancelled());
    const std::atomic<bool> stop{true};
    EXPECT_TRUE((Monitor{.progress = {}, .cancelled = &stop}).is_cancelled());
}

}  // namespace
}  // namespace pyroscene
