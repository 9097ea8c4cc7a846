#include <algorithm>
#include <takt/config/diagnostics.hpp>
#include <tuple>
#include <utility>

namespace takt::config {

namespace {

const char* word(Severity severity) noexcept {
    switch (severity) {
        case Severity::Note:
            return "note";
        case Severity::Warning:
            return "warning";
        case Severity::Error:
            return "error";
    }
    return "error";
}

}  // namespace

std::string format(const Place& place) {
    return place.line > 0 ? place.file + ":" + std::to_string(place.line) : place.file;
}

void Diagnostics::error(Place place, std::string what, std::string allowed, std::string remedy) {
    add({std::move(place), Severity::Error, std::move(what), std::move(allowed),
         std::move(remedy)});
}

void Diagnostics::warning(Place place, std::string what, std::string allowed, std::string remedy) {
    add({std::move(place), Severity::Warning, std::move(what), std::move(allowed),
         std::move(remedy)});
}

void Diagnostics::note(Place place, std::string what, std::string allowed, std::string remedy) {
    add({std::move(place), Severity::Note, std::move(what), std::move(allowed), std::move(remedy)});
}

void Diagnostics::add(Diagnostic diagnostic) {
    if (diagnostic.severity == Severity::Error) ++errors_;
    if (diagnostic.severity == Severity::Warning) ++warnings_;
    if (items_.size() == MaxKept) {
        ++dropped_;
        return;
    }
    items_.push_back(std::move(diagnostic));
}

void Diagnostics::append(const Diagnostics& other) {
    for (const Diagnostic& item : other.items_) add(item);
    dropped_ += other.dropped_;
}

void Diagnostics::sort() {
    std::stable_sort(items_.begin(), items_.end(), [](const Diagnostic& a, const Diagnostic& b) {
        return std::tie(a.place.file, a.place.line) < std::tie(b.place.file, b.place.line);
    });
}

std::string format(const Diagnostic& diagnostic) {
    std::string line =
        format(diagnostic.place) + ": " + word(diagnostic.severity) + ": " + diagnostic.what;
    if (!diagnostic.allowed.empty()) line += "; allowed: " + diagnostic.allowed;
    if (!diagnostic.remedy.empty()) line += "; do: " + diagnostic.remedy;
    return line;
}

std::string format(const Diagnostics& diagnostics) {
    std::string text;
    for (const Diagnostic& item : diagnostics.items()) text += format(item) + "\n";
    if (diagnostics.dropped() != 0) {
        text += "… and " + std::to_string(diagnostics.dropped()) + " more\n";
    }
    return text;
}

}  // namespace takt::config
