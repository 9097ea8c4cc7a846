#pragma once

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "takt_process.hpp"

namespace takt::test {

/// The columns of a trace as text, for looking at single cycles.
class TraceFile {
public:
    explicit TraceFile(const std::string& path) {
        std::istringstream text{readFile(path)};
        std::string line;
        if (std::getline(text, line)) names_ = split(line);
        while (std::getline(text, line)) rows_.push_back(split(line));
    }

    [[nodiscard]] std::size_t size() const { return rows_.size(); }
    [[nodiscard]] std::string at(std::size_t row, const std::string& column) const {
        const auto found = std::find(names_.begin(), names_.end(), column);
        const auto index = static_cast<std::size_t>(found - names_.begin());
        return row < rows_.size() && index < rows_[row].size() ? rows_[row][index] : std::string{};
    }
    [[nodiscard]] double number(std::size_t row, const std::string& column) const {
        return std::strtod(at(row, column).c_str(), nullptr);
    }
    [[nodiscard]] std::string last(const std::string& column) const {
        return rows_.empty() ? std::string{} : at(rows_.size() - 1, column);
    }
    [[nodiscard]] bool everWas(const std::string& column, const std::string& value) const {
        for (std::size_t row = 0; row < rows_.size(); ++row) {
            if (at(row, column) == value) return true;
        }
        return false;
    }

private:
    static std::vector<std::string> split(const std::string& line) {
        std::vector<std::string> cells;
        std::istringstream text{line};
        for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
        return cells;
    }

    std::vector<std::string> names_;
    std::vector<std::vector<std::string>> rows_;
};

}  // namespace takt::test
