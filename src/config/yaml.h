#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pyroscene::config {

/// One thing wrong with a file: "file:line: key.path: message".
struct Problem {
    std::string file;
    int line = 0;  ///< 1-based, 0 = whole file
    std::string key_path, message;
    [[nodiscard]] std::string text() const;
};

/// Allowed values of a number; bounds are inclusive unless `open_minimum`. ".nan" is never in a range, ".inf" only where the
/// bound itself is infinite.
struct Range {
    double minimum = -1e300, maximum = 1e300;
    bool open_minimum = false;  ///< value must be > minimum
    static constexpr Range any() { return {}; }
    static constexpr Range positive() { return {0.0, 1e300, true}; }
    static constexpr Range not_negative() { return {0.0, 1e300, false}; }
    static constexpr Range between(double lo, double hi) { return {lo, hi, false}; }
};

/// A strict view of a YAML node. Every key that is asked for becomes known; finish() reports the others with the nearest
/// known key. Reading never throws: what is wrong is collected in the document, and a default is returned. A key with an
/// empty value or `null` counts as absent. Copies of a node, and nodes asked for twice, share what is known.
class Node {
public:
    Node() = default;  ///< absent
    [[nodiscard]] bool present() const noexcept;
    [[nodiscard]] bool is_map() const noexcept;
    [[nodiscard]] bool is_list() const noexcept;
    [[nodiscard]] bool is_scalar() const noexcept;
    [[nodiscard]] int line() const noexcept;
    [[nodiscard]] const std::string& key_path() const noexcept;
    [[nodiscard]] bool has(std::string_view key) const;
    [[nodiscard]] std::vector<std::string> keys() const;  ///< of a map, in file order; marks nothing known

    /// Child of a map (absent node when missing); marks the key known.
    [[nodiscard]] Node child(std::string_view key) const;
    [[nodiscard]] Node required_child(std::string_view key) const;  ///< reports a missing key
    [[nodiscard]] std::vector<Node> items() const;                  ///< of a list; a scalar or map is a list of one

    // Values of this node itself; report a wrong type or range and return the default.
    [[nodiscard]] double as_number(double fallback, Range range = {}) const;
    [[nodiscard]] long long as_integer(long long fallback, Range range = {}) const;
    [[nodiscard]] bool as_bool(bool fallback) const;
    [[nodiscard]] std::string as_text(std::string_view fallback) const;

    // Values of children: absent -> the default (or nullopt), wrong -> reported and the default.
    [[nodiscard]] double number(std::string_view key, double fallback, Range range = {}) const;
    [[nodiscard]] std::optional<double> optional_number(std::string_view key, Range range = {}) const;
    [[nodiscard]] long long integer(std::string_view key, long long fallback, Range range = {}) const;
    [[nodiscard]] bool boolean(std::string_view key, bool fallback) const;
    [[nodiscard]] std::string text(std::string_view key, std::string_view fallback) const;
    [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t expected_count = 0) const;  ///< 0 = any
    /// One of the allowed words; reports the list (and the nearest) otherwise.
    [[nodiscard]] std::string choice(std::string_view key, std::string_view fallback,
                                     const std::vector<std::string>& allowed) const;

    /// Accepts a key without reading it (documentation keys of sensor files).
    void ignore(std::string_view key) const;
    /// Reports every key of this map that nobody asked for: "unknown key 'x'; did you mean 'y'?".
    void finish() const;
    /// Adds a problem at this node's line.
    void report(std::string message) const;

private:
    friend class Document;
    struct Impl;
    std::shared_ptr<Impl> impl_;
};

/// A YAML file with the problems found so far.
class Document {
public:
    /// Throws an input error when the file is missing or is no YAML ("file:line: ...").
    explicit Document(const std::filesystem::path& path);
    [[nodiscard]] Node root() const;
    [[nodiscard]] const std::vector<Problem>& problems() const noexcept;
    void report(int line, std::string key_path, std::string message);
    /// Throws one input error that lists all problems, sorted by line, when there are any.
    void throw_if_any() const;

    struct Impl;

private:
    std::shared_ptr<Impl> impl_;
};

/// The candidate with the smallest edit distance, or empty when none is near (distance <= 1/3 of the length, at least 2).
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace pyroscene::config
