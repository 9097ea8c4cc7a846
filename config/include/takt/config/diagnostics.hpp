#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace takt::config {

enum class Severity : std::uint8_t {
    Note,     ///< worth knowing, nothing is wrong
    Warning,  ///< works, but probably not as meant
    Error,    ///< the file is refused
};

/// Where something stands. Line 0 = the file as a whole.
struct Place {
    std::string file;
    int line{0};
};

/// "machine.xml:40", or the bare file name where there is no line.
[[nodiscard]] std::string format(const Place& place);

struct Diagnostic {
    Place place;
    Severity severity{Severity::Error};
    std::string what;     ///< what is wrong, one sentence without a full stop
    std::string allowed;  ///< what would be accepted; may be empty
    std::string remedy;   ///< what to do about it; may be empty
};

/// Everything found wrong in one or several files, collected so that all of it is told at once.
class Diagnostics {
public:
    /// A hostile file could raise millions; what comes after so many is only counted.
    static constexpr std::size_t MaxKept = 1000;

    void error(Place place, std::string what, std::string allowed = {}, std::string remedy = {});
    void warning(Place place, std::string what, std::string allowed = {}, std::string remedy = {});
    void note(Place place, std::string what, std::string allowed = {}, std::string remedy = {});
    void add(Diagnostic diagnostic);
    void append(const Diagnostics& other);
    /// By file, then line; what stands in one line keeps the order in which it was found.
    void sort();

    [[nodiscard]] bool empty() const noexcept { return items_.empty(); }
    [[nodiscard]] bool hasErrors() const noexcept { return errors_ != 0; }
    /// All errors and warnings, dropped ones included.
    [[nodiscard]] std::size_t errorCount() const noexcept { return errors_; }
    [[nodiscard]] std::size_t warningCount() const noexcept { return warnings_; }
    [[nodiscard]] std::size_t dropped() const noexcept { return dropped_; }
    [[nodiscard]] const std::vector<Diagnostic>& items() const noexcept { return items_; }

private:
    std::vector<Diagnostic> items_;
    std::size_t errors_{0};
    std::size_t warnings_{0};
    std::size_t dropped_{0};
};

/// "file:line: error: what; allowed: …; do: …" without line end.
[[nodiscard]] std::string format(const Diagnostic& diagnostic);
/// One line for each, every line ended.
[[nodiscard]] std::string format(const Diagnostics& diagnostics);

}  // namespace takt::config
