#include <fmt/format.h>

#include <algorithm>
#include <takt/config/load_faults.hpp>

#include "element_reader.hpp"
#include "xml_document.hpp"

namespace takt::config {

namespace {

constexpr std::int64_t MostCycles = 1'000'000'000'000;

twin::LostFramesParams readLostFrames(ElementReader reader) {
    twin::LostFramesParams lost;
    lost.cycle = static_cast<std::uint64_t>(
        reader.integer("cycle", {0, MostCycles}, Presence::Required).value_or(0));
    lost.cycles = static_cast<std::uint64_t>(reader.integer("cycles", {1, MostCycles}).value_or(1));
    reader.finish();
    return lost;
}

}  // namespace

std::optional<twin::FaultParams> loadFaults(const std::filesystem::path& file,
                                            Diagnostics& diagnostics) {
    const auto document = loadXml(file, MaxMachineFile, diagnostics);
    if (!document) return std::nullopt;
    if (document->root().name() != "Faults") {
        diagnostics.error(
            {document->file(), document->root().line()},
            fmt::format("<{}> is not the root of a fault file", document->root().name()),
            "<Faults>");
        return std::nullopt;
    }
    twin::FaultParams faults;
    ElementReader root{document->root(), "faults", document->file(), diagnostics};
    for (const XmlElement element : root.children("LostFrames")) {
        faults.lostFrames.push_back(
            readLostFrames({element, "lost frames", document->file(), diagnostics}));
    }
    root.finish();
    std::sort(faults.lostFrames.begin(), faults.lostFrames.end(),
              [](const auto& a, const auto& b) { return a.cycle < b.cycle; });
    if (diagnostics.hasErrors()) return std::nullopt;
    return faults;
}

}  // namespace takt::config
