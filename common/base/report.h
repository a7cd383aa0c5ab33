#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace multires {

/// Numbers a filter returns, in the order they are to be shown; keys are snake_case.
class Report {
public:
    using Value = std::variant<bool, int, double, std::vector<double>>;
    struct Entry {
        std::string key;
        Value value;
        std::string unit;  ///< "", "mesh units", "percent", ...
    };

    void add(std::string key, Value value, std::string unit = "") {
        entries_.push_back({std::move(key), std::move(value), std::move(unit)});
    }
    /// A line for the host's log, beside the numbers.
    void say(std::string line) { lines_.push_back(std::move(line)); }

    const std::vector<Entry>& entries() const { return entries_; }
    const std::vector<std::string>& lines() const { return lines_; }

private:
    std::vector<Entry> entries_;
    std::vector<std::string> lines_;
};

}  // namespace multires
