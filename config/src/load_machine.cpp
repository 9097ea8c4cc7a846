#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <system_error>
#include <takt/config/load_machine.hpp>

#include "machine_parts.hpp"
#include "machine_schema.hpp"
#include "xml_encoding.hpp"

namespace takt::config {

namespace {

using Folders = std::vector<std::filesystem::path>;

std::optional<std::filesystem::path> findLibrary(const std::filesystem::path& library,
                                                 const Folders& folders) {
    for (const std::filesystem::path& folder : folders) {
        const std::filesystem::path candidate = (folder / library).lexically_normal();
        std::error_code fault;
        if (std::filesystem::is_regular_file(candidate, fault)) return candidate;
    }
    return std::nullopt;
}

/// The children of a name, none of them if there are more than any machine has.
std::vector<XmlElement> boundedChildren(ElementReader& machine, std::string_view name) {
    constexpr std::size_t Most = 1000;
    std::vector<XmlElement> elements = machine.children(name);
    if (elements.size() <= Most) return elements;
    machine.error({}, fmt::format("there are {} <{}>", elements.size(), name), "at most 1000");
    return {};
}

/// Reports names that stand twice among the elements of one kind.
class UniqueNames {
public:
    explicit UniqueNames(const char* kind) : kind_{kind} {}

    void add(const std::string& name, const ElementReader& reader) {
        if (name.empty()) return;
        const auto [first, fresh] = lines_.emplace(name, reader.place().line);
        if (fresh) return;
        reader.error("name",
                     fmt::format("there is {} of this name in line {}", kind_, first->second),
                     "each name once", "rename one of them");
    }

private:
    const char* kind_;
    std::map<std::string, int> lines_;
};

std::vector<AxisPart> readAxes(ElementReader& machine, NetworkPart& network) {
    std::vector<AxisPart> axes;
    UniqueNames names{"an axis"};
    for (const XmlElement element : boundedChildren(machine, "Axis")) {
        axes.push_back(
            readAxis({element, "axis", machine.place().file, machine.diagnostics()}, network));
        names.add(axes.back().params.name, axes.back().reader);
    }
    for (const AxisPart& axis : axes) {
        SlavePart* const slave = network.find(axis.params.drive.slave);
        if (axis.complete && slave != nullptr && slave->params.device) {
            addDriveObjects(*slave, axis, network.params.lostLimit);
        }
    }
    return axes;
}

std::vector<axis::GroupParams> readGroups(ElementReader& machine,
                                          const std::vector<AxisPart>& axes) {
    std::vector<axis::GroupParams> groups;
    UniqueNames names{"a group"};
    for (const XmlElement element : boundedChildren(machine, "Group")) {
        const ElementReader reader{element, "group", machine.place().file, machine.diagnostics()};
        groups.push_back(readGroup(reader, axes));
        names.add(groups.back().name, reader);
    }
    return groups;
}

std::vector<planner::roadmap::ObstacleParams> readAllObstacles(
    ElementReader& machine, const std::vector<AxisPart>& axes,
    const std::vector<axis::GroupParams>& groups) {
    std::vector<planner::roadmap::ObstacleParams> all;
    std::map<std::size_t, int> lines;  // of the obstacles of each group
    for (const XmlElement element : boundedChildren(machine, "Obstacles")) {
        const ElementReader reader{element, "obstacles", machine.place().file,
                                   machine.diagnostics()};
        auto obstacles = readObstacles(reader, axes, groups);
        if (!obstacles) continue;
        const auto [first, fresh] = lines.emplace(obstacles->group, element.line());
        if (!fresh) {
            reader.error("group",
                         fmt::format("the group has obstacles in line {} already", first->second),
                         "one <Obstacles> for each group", "put them together");
        }
        all.push_back(std::move(*obstacles));
    }
    return all;
}

std::vector<program::ProgramParams> readPrograms(ElementReader& machine, const Folders& folders,
                                                 ProgramLibraries libraries) {
    std::vector<program::ProgramParams> programs;
    UniqueNames names{"a program"};
    for (const XmlElement element : boundedChildren(machine, "Program")) {
        const ElementReader reader{element, "program", machine.place().file, machine.diagnostics()};
        programs.push_back(readProgram(reader, folders, libraries));
        ElementReader named = reader;
        named.relabel(fmt::format("program '{}'", programs.back().name));
        names.add(programs.back().name, named);
    }
    return programs;
}

void noteIdleSlaves(const NetworkPart& network) {
    for (const SlavePart& slave : network.slaves) {
        if (slave.hasAxis || slave.params.name.empty()) continue;
        slave.reader.diagnostics().note(slave.reader.place(),
                                        fmt::format("{}: no axis uses it", slave.reader.label()));
    }
}

MachineConfig readMachine(const XmlDocument& document, const Folders& librarySearch,
                          ProgramLibraries libraries, Diagnostics& diagnostics) {
    const std::filesystem::path folder = std::filesystem::path{document.file()}.parent_path();
    MachineConfig machine;
    ElementReader root{document.root(), "machine", document.file(), diagnostics};
    machine.file = document.file();
    machine.name = root.name("name").value_or("");
    NetworkPart network = readNetwork(root.childReader("Network", Presence::Required), folder);
    const std::vector<AxisPart> axes = readAxes(root, network);
    Folders folders{folder};
    folders.insert(folders.end(), librarySearch.begin(), librarySearch.end());
    machine.programs = readPrograms(root, folders, libraries);
    machine.groups = readGroups(root, axes);
    machine.obstacles = readAllObstacles(root, axes, machine.groups);
    machine.machineStop = readMachineStop(root.childReader("MachineStop"), network, axes);
    machine.twin = readTwin(root.childReader("Twin"), network, axes);
    readRealtime(root.childReader("Realtime"), machine.scheduler);
    machine.bridge = readBridge(root.childReader("Bridge"), network.params.cycle);
    noteIdleSlaves(network);
    root.finish();
    machine.network = std::move(network.params);
    machine.scheduler.cycle = machine.network.cycle;
    for (SlavePart& slave : network.slaves) {
        machine.twinDevices.push_back(slave.twinDevice ? slave.twinDevice : slave.params.device);
        machine.network.slaves.push_back(std::move(slave.params));
    }
    for (const AxisPart& axis : axes) {
        machine.axes.push_back(axis.params);
        // One number for the bus and its axes: n_lost.
        machine.axes.back().supervision.lostCycles = machine.network.lostLimit;
    }
    return machine;
}

/// The first and last line of every start tag: the schema check names the last, everything else the
/// first.
void collectTagLines(XmlElement element, std::map<int, int>& firstOfLast) {
    int last = element.line();
    for (const XmlAttribute& attribute : element.attributes())
        last = std::max(last, attribute.line);
    for (int line = element.line(); line <= last; ++line)
        firstOfLast.try_emplace(line, element.line());
    for (const XmlElement child : element.children()) collectTagLines(child, firstOfLast);
}

/// Adds what the schema finds and our own rules, which say it better, have not found in the same
/// tag.
void addSchemaMessages(const XmlDocument& document, Diagnostics& diagnostics) {
    const std::vector<SchemaMessage> messages = validate(document.text(), machineSchema());
    if (messages.empty()) return;
    std::map<int, int> tags;
    collectTagLines(document.root(), tags);
    const auto tagOf = [&tags](int line) {
        const auto found = tags.find(line);
        return found != tags.end() ? found->second : line;
    };
    std::map<int, bool> reported;
    for (const Diagnostic& item : diagnostics.items()) {
        const bool here = item.place.file == document.file() && item.severity == Severity::Error;
        if (here) reported[tagOf(item.place.line)] = true;
    }
    for (const SchemaMessage& message : messages) {
        if (reported.contains(tagOf(message.line))) continue;
        diagnostics.error({document.file(), message.line}, message.text,
                          "what config/schema/machine.xsd describes");
    }
}

}  // namespace

program::ProgramParams readProgram(ElementReader reader, const Folders& folders,
                                   ProgramLibraries libraries) {
    program::ProgramParams program;
    program.origin = format(reader.place());
    const auto name = reader.name("name");
    program.name = name.value_or("");
    if (name) reader.relabel(fmt::format("program '{}'", *name));
    const auto library = reader.text("library");
    program.everyCycles =
        static_cast<std::uint32_t>(reader.integer("every", {1, 100'000}).value_or(1));
    const auto budget = reader.quantity("budget", Dimension::Share, Sign::Positive);
    program.budgetShare = budget ? budget->value : program.budgetShare;
    reader.finish();
    if (program.budgetShare > 1.0) {
        reader.error("budget", "a program cannot have more than the whole cycle", "up to 100 %");
    }
    if (!library) return program;
    if (libraries == ProgramLibraries::NotNeeded) {
        program.library = *library;
        return program;
    }
    if (const auto found = findLibrary(*library, folders)) {
        program.library = found->string();
        return program;
    }
    std::string places;
    for (const auto& folder : folders) {
        places +=
            fmt::format("{}{}", places.empty() ? "" : ", ", folder.empty() ? "." : folder.string());
    }
    reader.error("library", fmt::format("the library '{}' is not there", *library),
                 fmt::format("a file in one of: {}", places),
                 "build the program, or correct the name");
    return program;
}

LoadResult loadMachine(const std::filesystem::path& file, const Folders& librarySearch,
                       ProgramLibraries libraries) {
    LoadResult result;
    const auto document = loadXml(file, MaxMachineFile, result.diagnostics);
    if (!document) return result;
    if (document->root().name() != "Machine") {
        result.diagnostics.error(
            {document->file(), document->root().line()},
            fmt::format("<{}> is not the root of a machine file", document->root().name()),
            "<Machine>");
        return result;
    }
    MachineConfig machine = readMachine(*document, librarySearch, libraries, result.diagnostics);
    addSchemaMessages(*document, result.diagnostics);
    result.diagnostics.sort();
    if (!result.diagnostics.hasErrors()) result.machine = std::move(machine);
    return result;
}

}  // namespace takt::config
