#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "scenario/readers.h"

namespace pyroscene::scenario {
namespace {

Mosaic read_mosaic(const config::Node& node, const std::vector<Acquisition>& acquisitions) {
    Mosaic mosaic;
    const auto id = node.required_child("id"), of = node.required_child("of");
    mosaic.id = id.as_text("");
    if (id.is_scalar() && !is_safe_name(mosaic.id))
        id.report(fmt::format("'{}' cannot be a folder name; use letters, digits, '.', '_', '-'", mosaic.id));
    const auto named = [&](const std::string& word) {
        return std::find_if(acquisitions.begin(), acquisitions.end(), [&](const Acquisition& a) { return a.id == word; });
    };
    if (mosaic.id == "state" || named(mosaic.id) != acquisitions.end())
        id.report(fmt::format("'{}' is taken by an acquisition or the fire states; choose another id", mosaic.id));
    mosaic.of = read_words(of);
    std::set<std::string> sensors;
    for (const auto& word : mosaic.of) {
        if (const auto found = named(word); found != acquisitions.end())
            sensors.insert(found->sensor);
        else
            of.report(fmt::format("there is no acquisition '{}'", word));
    }
    if (sensors.size() > 1) of.report("a mosaic is made of images of one sensor");
    if (of.present() && std::set(mosaic.of.begin(), mosaic.of.end()).size() < 2)
        of.report("name two acquisitions or more, each once");
    const std::string rule = node.choice("rule", "nearest_nadir", {"nearest_nadir", "latest", "earliest"});
    mosaic.rule = rule == "latest"     ? Mosaic::Rule::Latest
                  : rule == "earliest" ? Mosaic::Rule::Earliest
                                       : Mosaic::Rule::NearestNadir;
    node.finish();
    return mosaic;
}

}  // namespace

std::vector<Mosaic> read_mosaics(const config::Node& node, const std::vector<Acquisition>& acquisitions) {
    std::vector<Mosaic> mosaics;
    if (!node.present()) return mosaics;
    if (!node.is_list()) node.report("expected a list of mosaics ('- {id: ..., of: [..., ...]}')");
    std::set<std::string> ids;
    for (const auto& item : node.items()) {
        mosaics.push_back(read_mosaic(item, acquisitions));
        if (!ids.insert(mosaics.back().id).second)
            item.child("id").report(fmt::format("'{}' is used twice", mosaics.back().id));
    }
    return mosaics;
}

}  // namespace pyroscene::scenario
