#include "config/yaml.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include "base/error.h"
#include "base/files.h"
#include "config/scalar.h"

namespace fs = std::filesystem;

namespace pyroscene::config {

namespace {

/// Problems of one file, shared by the document and all its nodes.
struct Log {
    std::string file;
    std::vector<Problem> problems;

    void report(int line, std::string key_path, std::string message) {
        const auto same = [&](const Problem& p) { return p.line == line && p.key_path == key_path && p.message == message; };
        if (std::any_of(problems.begin(), problems.end(), same)) return;  // the same value was read twice
        problems.push_back({file, line, std::move(key_path), std::move(message)});
    }
};

int line_of(const YAML::Node& node) { return node.Mark().is_null() ? 0 : node.Mark().line + 1; }

std::string join_path(const std::string& parent, std::string_view key) {
    return parent.empty() ? std::string(key) : fmt::format("{}.{}", parent, key);
}

std::string kind_text(const YAML::Node& node) {
    if (node.IsMap()) return "a map";
    if (node.IsSequence()) return "a list";
    if (node.IsScalar()) return fmt::format("'{}'", node.Scalar());
    return "nothing";
}

bool quoted(const YAML::Node& node) { return node.Tag() == "!"; }

/// Looks once through the whole tree for what no reader would notice: keys given twice, keys that are no words, and
/// aliases that repeat or contain themselves without end.
class TreeCheck {
public:
    explicit TreeCheck(Log& log) : log_(log) {}

    void visit(const YAML::Node& node, const std::string& path, int depth) {
        constexpr int kMaximumDepth = 64, kMaximumNodes = 200'000;
        if (depth > kMaximumDepth || ++visited_ > kMaximumNodes)
            throw input_error(fmt::format("{}:{}", log_.file, line_of(node)), "nested too deeply or too large");
        if (node.IsMap()) visit_map(node, path, depth);
        if (!node.IsSequence()) return;
        std::size_t i = 0;
        for (const auto& item : node) visit(item, fmt::format("{}[{}]", path, i++), depth + 1);
    }

private:
    void visit_map(const YAML::Node& map, const std::string& path, int depth) {
        std::map<std::string, int> first_line;
        for (const auto& entry : map) {
            const int line = line_of(entry.first);
            if (!entry.first.IsScalar()) {
                log_.report(line, path, fmt::format("a key must be a word, found {}", kind_text(entry.first)));
                continue;
            }
            const std::string& key = entry.first.Scalar();
            const auto [first, is_new] = first_line.emplace(key, line);
            if (!is_new)
                log_.report(line, path, fmt::format("key '{}' is given twice (first in line {})", key, first->second));
            visit(entry.second, join_path(path, key), depth + 1);
        }
    }

    Log& log_;
    int visited_ = 0;
};

}  // namespace

std::string Problem::text() const {
    std::string place = line > 0 ? fmt::format("{}:{}", file, line) : file;
    if (!key_path.empty()) place += ": " + key_path;
    return place + ": " + message;
}

/// Children are kept, so that a key counts as known whichever copy of its map was asked.
struct Node::Impl {
    std::shared_ptr<Log> log;
    YAML::Node yaml;  // undefined when absent
    bool present = false;
    int line = 0;  // of the key; absent: of the map that lacks it
    std::string key_path;
    bool shape_reported = false;
    std::set<std::string, std::less<>> known;
    std::map<std::string, Node, std::less<>> children;
    std::vector<Node> items;

    void report(std::string message) const { log->report(line, key_path, std::move(message)); }
    /// The pair of a key, null when there is none.
    [[nodiscard]] std::optional<std::pair<YAML::Node, YAML::Node>> find(std::string_view key) const {
        if (!present || !yaml.IsMap()) return std::nullopt;
        for (const auto& entry : yaml)
            if (entry.first.IsScalar() && entry.first.Scalar() == key) return std::pair(entry.first, entry.second);
        return std::nullopt;
    }
    /// False, and said once, when keys are asked of something that is no map.
    bool expect_map() {
        if (!present || yaml.IsMap()) return present;
        if (!shape_reported) report(fmt::format("expected a map of keys, found {}", kind_text(yaml)));
        shape_reported = true;
        return false;
    }
    bool expect_scalar(std::string_view expected) const {
        if (yaml.IsScalar()) return true;
        report(fmt::format("expected {}, found {}", expected, kind_text(yaml)));
        return false;
    }
};

bool Node::present() const noexcept { return impl_ && impl_->present; }
bool Node::is_map() const noexcept { return present() && impl_->yaml.IsMap(); }
bool Node::is_list() const noexcept { return present() && impl_->yaml.IsSequence(); }
bool Node::is_scalar() const noexcept { return present() && impl_->yaml.IsScalar(); }
int Node::line() const noexcept { return impl_ ? impl_->line : 0; }

const std::string& Node::key_path() const noexcept {
    static const std::string none;
    return impl_ ? impl_->key_path : none;
}

bool Node::has(std::string_view key) const {
    const auto entry = impl_ ? impl_->find(key) : std::nullopt;
    return entry && !entry->second.IsNull();
}

std::vector<std::string> Node::keys() const {
    std::vector<std::string> result;
    if (!is_map()) return result;
    for (const auto& entry : impl_->yaml)
        if (entry.first.IsScalar()) result.push_back(entry.first.Scalar());
    return result;
}

Node Node::child(std::string_view key) const {
    if (!impl_) return {};
    impl_->known.emplace(key);
    if (const auto old = impl_->children.find(key); old != impl_->children.end()) return old->second;
    Node node;
    node.impl_ = std::make_shared<Impl>();
    node.impl_->log = impl_->log;
    node.impl_->key_path = join_path(impl_->key_path, key);
    node.impl_->line = impl_->line;
    impl_->expect_map();
    if (const auto entry = impl_->find(key)) {
        node.impl_->line = line_of(entry->first);
        node.impl_->present = !entry->second.IsNull();
        node.impl_->yaml.reset(entry->second);
    }
    impl_->children.emplace(key, node);
    return node;
}

Node Node::required_child(std::string_view key) const {
    Node node = child(key);
    if (impl_ && !node.present() && !impl_->shape_reported) report(fmt::format("key '{}' is missing", key));
    return node;
}

std::vector<Node> Node::items() const {
    if (!present()) return {};
    if (!is_list()) return {*this};
    if (!impl_->items.empty()) return impl_->items;
    for (const YAML::Node& entry : impl_->yaml) {
        Node item;
        item.impl_ = std::make_shared<Impl>();
        item.impl_->log = impl_->log;
        item.impl_->key_path = fmt::format("{}[{}]", impl_->key_path, impl_->items.size());
        item.impl_->line = line_of(entry);
        item.impl_->yaml.reset(entry);
        item.impl_->present = true;
        impl_->items.push_back(std::move(item));
    }
    return impl_->items;
}

double Node::as_number(double fallback, Range range) const {
    constexpr const char* kExpected = "a number";
    if (!present() || !impl_->expect_scalar(kExpected)) return fallback;
    const auto value = quoted(impl_->yaml) ? std::nullopt : parse_double(impl_->yaml.Scalar());
    if (!value) {
        report(not_a_number_text(impl_->yaml.Scalar(), quoted(impl_->yaml) ? "a number without quotes" : kExpected));
        return fallback;
    }
    if (in_range(*value, range)) return *value;
    report(fmt::format("{}, found {}", range_text(range), impl_->yaml.Scalar()));
    return fallback;
}

long long Node::as_integer(long long fallback, Range range) const {
    constexpr const char* kExpected = "a whole number";
    if (!present() || !impl_->expect_scalar(kExpected)) return fallback;
    const auto value = quoted(impl_->yaml) ? std::nullopt : parse_integer(impl_->yaml.Scalar());
    if (!value) {
        report(not_a_number_text(impl_->yaml.Scalar(), quoted(impl_->yaml) ? "a whole number without quotes" : kExpected));
        return fallback;
    }
    if (in_range(static_cast<double>(*value), range)) return *value;
    report(fmt::format("{}, found {}", range_text(range), impl_->yaml.Scalar()));
    return fallback;
}

bool Node::as_bool(bool fallback) const {
    constexpr const char* kExpected = "true or false";
    if (!present() || !impl_->expect_scalar(kExpected)) return fallback;
    if (const auto value = quoted(impl_->yaml) ? std::nullopt : parse_bool(impl_->yaml.Scalar())) return *value;
    report(fmt::format("expected {}, found {}", kExpected, kind_text(impl_->yaml)));
    return fallback;
}

std::string Node::as_text(std::string_view fallback) const {
    if (!present() || !impl_->expect_scalar("a text")) return std::string(fallback);
    return impl_->yaml.Scalar();
}

double Node::number(std::string_view key, double fallback, Range range) const {
    return child(key).as_number(fallback, range);
}

std::optional<double> Node::optional_number(std::string_view key, Range range) const {
    const Node node = child(key);
    const double value = node.as_number(std::nan(""), range);
    return std::isnan(value) ? std::nullopt : std::optional(value);
}

long long Node::integer(std::string_view key, long long fallback, Range range) const {
    return child(key).as_integer(fallback, range);
}

bool Node::boolean(std::string_view key, bool fallback) const { return child(key).as_bool(fallback); }

std::string Node::text(std::string_view key, std::string_view fallback) const { return child(key).as_text(fallback); }

std::vector<double> Node::numbers(std::string_view key, std::size_t expected_count) const {
    const Node node = child(key);
    if (!node.present()) return {};
    if (node.is_map()) {
        node.report("expected a list of numbers, found a map");
        return {};
    }
    std::vector<double> values;
    for (const auto& item : node.items()) values.push_back(item.as_number(std::nan("")));
    if (std::any_of(values.begin(), values.end(), [](double v) { return std::isnan(v); })) return {};
    if (expected_count == 0 || values.size() == expected_count) return values;
    node.report(fmt::format("expected a list of {} numbers, found {}", expected_count, values.size()));
    return {};
}

std::string Node::choice(std::string_view key, std::string_view fallback, const std::vector<std::string>& allowed) const {
    const Node node = child(key);
    if (!node.present() || !node.impl_->expect_scalar(fmt::format("one of {}", fmt::join(allowed, ", "))))
        return std::string(fallback);
    const std::string word = node.as_text(fallback);
    if (std::find(allowed.begin(), allowed.end(), word) != allowed.end()) return word;
    const std::string guess = nearest(word, allowed);
    node.report(guess.empty()
                    ? fmt::format("'{}' is none of {}", word, fmt::join(allowed, ", "))
                    : fmt::format("'{}' is none of {}; did you mean '{}'?", word, fmt::join(allowed, ", "), guess));
    return std::string(fallback);
}

void Node::ignore(std::string_view key) const {
    if (impl_) impl_->known.emplace(key);
}

void Node::finish() const {
    if (!present() || !impl_->expect_map()) return;
    const std::vector<std::string> known(impl_->known.begin(), impl_->known.end());
    for (const auto& entry : impl_->yaml) {
        if (!entry.first.IsScalar() || impl_->known.contains(entry.first.Scalar())) continue;
        const std::string& key = entry.first.Scalar();
        const std::string guess = nearest(key, known);
        const std::string help =
            guess.empty() ? fmt::format("known here: {}", fmt::join(known, ", ")) : fmt::format("did you mean '{}'?", guess);
        impl_->log->report(line_of(entry.first), impl_->key_path, fmt::format("unknown key '{}'; {}", key, help));
    }
}

void Node::report(std::string message) const {
    if (impl_) impl_->report(std::move(message));
}

struct Document::Impl {
    std::shared_ptr<Log> log;
    Node root;
};

namespace {

YAML::Node parse_one_document(const std::string& text, const std::string& file) {
    try {
        const auto documents = YAML::LoadAll(text);
        if (documents.empty() || documents.front().IsNull()) throw input_error(file, "is empty, expected YAML");
        if (documents.size() > 1)
            throw input_error(fmt::format("{}:{}", file, line_of(documents[1])),
                              "holds several YAML documents, expected one");
        return documents.front();
    } catch (const YAML::Exception& failure) {
        const int line = failure.mark.is_null() ? 0 : failure.mark.line + 1;
        throw input_error(line > 0 ? fmt::format("{}:{}", file, line) : file, "is no valid YAML: " + failure.msg);
    }
}

}  // namespace

Document::Document(const fs::path& path) : impl_(std::make_shared<Impl>()) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) throw input_error(path.string(), "is a folder, expected a YAML file");
    if (!fs::exists(path, ignored)) throw input_error(path.string(), "does not exist");
    impl_->log = std::make_shared<Log>();
    impl_->log->file = path.string();
    const YAML::Node yaml = parse_one_document(read_text_file(path), impl_->log->file);
    TreeCheck(*impl_->log).visit(yaml, "", 0);
    auto& root = impl_->root.impl_;
    root = std::make_shared<Node::Impl>();
    root->log = impl_->log;
    root->yaml.reset(yaml);
    root->present = true;
    root->line = line_of(yaml);
}

Node Document::root() const { return impl_->root; }
const std::vector<Problem>& Document::problems() const noexcept { return impl_->log->problems; }

void Document::report(int line, std::string key_path, std::string message) {
    impl_->log->report(line, std::move(key_path), std::move(message));
}

void Document::throw_if_any() const {
    std::vector<Problem> sorted = impl_->log->problems;
    if (sorted.empty()) return;
    std::stable_sort(sorted.begin(), sorted.end(), [](const Problem& a, const Problem& b) { return a.line < b.line; });
    if (sorted.size() == 1) throw input_error("", sorted.front().text());
    std::string message = fmt::format("{} problems", sorted.size());
    for (const auto& problem : sorted) message += "\n" + problem.text();
    throw input_error(impl_->log->file, message);
}

}  // namespace pyroscene::config
