#include "new_project.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <takt/config/known_drives.hpp>
#include <takt/program/version.hpp>
#include <utility>

#include "installed_files.hpp"
#include "json.hpp"
#include "project_devices.hpp"
#include "project_templates.hpp"
#include "tool_bus.hpp"

namespace takt::cli {

namespace {

constexpr std::size_t MostAxes = 64;

/// Path inside the project and contents, in the order in which they are told.
using Files = std::vector<std::pair<std::string, std::string>>;

struct NamedDevice {
    ProjectDevice source;
    std::string slave;
    std::string axis;  ///< empty: no drive
};

struct Project {
    std::string name;
    std::string interface;      ///< on which the devices were found; empty: none
    std::filesystem::path eni;  ///< network file; empty: none
    std::vector<NamedDevice> devices;
    std::size_t axes{0};
};

std::string replaceAll(std::string_view text, const std::map<std::string, std::string>& values) {
    std::string result{text};
    for (const auto& [key, value] : values) {
        const std::string placeholder = "{{" + key + "}}";
        for (std::size_t at = 0; (at = result.find(placeholder, at)) != std::string::npos;
             at += value.size()) {
            result.replace(at, placeholder.size(), value);
        }
    }
    return result;
}

/// As the value of an attribute.
std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '"':
                result += "&quot;";
                break;
            default:
                result += c;
        }
    }
    return result;
}

std::string readWhole(const std::filesystem::path& path) {
    std::ifstream file{path, std::ios::binary};
    std::ostringstream text;
    text << file.rdbuf();
    if (!file) throw std::runtime_error{fmt::format("{} cannot be read", path.string())};
    return text.str();
}

/// The folder's name as the name of machine, program and class: a letter, then letters, digits and
/// '_'.
std::string projectName(const std::filesystem::path& folder) {
    const auto absolute = std::filesystem::absolute(folder).lexically_normal();
    std::string name =
        (absolute.has_filename() ? absolute : absolute.parent_path()).filename().string();
    for (char& c : name) {
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    }
    if (name.empty() || std::isalpha(static_cast<unsigned char>(name.front())) == 0)
        name = "machine_" + name;
    name.resize(std::min<std::size_t>(name.size(), 32));
    static const std::set<std::string> taken{"run", "trace", "test",   "trace_test",
                                             "all", "clean", "install"};
    return taken.contains(name) ? name + "_machine" : name;
}

std::string className(const std::string& name) {
    std::string result;
    bool upper = true;
    for (const char c : name) {
        if (c == '_') {
            upper = true;
            continue;
        }
        result += upper ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
        upper = false;
    }
    return result + "Program";
}

std::string axisName(std::size_t number) {
    static constexpr std::string_view Letters{"XYZABCUVW"};
    return number < Letters.size() ? std::string{Letters[number]}
                                   : fmt::format("Axis{}", number + 1);
}

Project makeProject(const NewProjectOptions& options, std::vector<ProjectDevice> devices) {
    Project project;
    project.name = projectName(options.folder);
    project.interface = options.interface;
    project.eni = options.eni;
    for (ProjectDevice& device : devices) {
        NamedDevice named{
            std::move(device), fmt::format("device{}", project.devices.size() + 1), {}};
        if (isDrive(named.source.device)) {
            named.axis = axisName(project.axes++);
            named.slave = named.axis;
            for (char& c : named.slave)
                c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        }
        if (!named.source.slave.empty()) named.slave = named.source.slave;
        project.devices.push_back(std::move(named));
    }
    if (project.axes == 0)
        throw std::runtime_error{"none of the devices is a CiA 402 drive; a machine needs an axis"};
    if (project.axes > MostAxes) {
        throw std::runtime_error{fmt::format("{} drives are more than {}", project.axes, MostAxes)};
    }
    return project;
}

std::string esiElements(const Project& project) {
    std::string text;
    std::set<std::string> told;
    for (const NamedDevice& device : project.devices) {
        const std::string file = device.source.file.filename().string();
        if (!file.empty() && told.insert(file).second)
            text += fmt::format("    <Esi file=\"devices/{}\"/>\n", escaped(file));
    }
    return text;
}

std::string slaveElements(const Project& project) {
    std::string text;
    if (!project.eni.empty()) return text;
    for (const NamedDevice& device : project.devices) {
        const wire::DeviceDescription& description = device.source.device;
        const std::string pdos =
            device.axis.empty() ? std::string{} : axisPdos(description, "      ");
        text += fmt::format("    <Slave name=\"{}\" device=\"{}\" revision=\"0x{:08X}\"",
                            device.slave, escaped(description.type), description.identity.revision);
        text += pdos.empty() ? "/>\n" : fmt::format(">\n{}    </Slave>\n", pdos);
    }
    return text;
}

std::string axisElement(const NamedDevice& device) {
    const bool known = config::deliveredCountsPerTurn(device.source.device.type).has_value();
    return fmt::format(R"(
  <Axis name="{}" unit="mm">
    <Drive slave="{}" maxSpeed="3000 rpm"/>
{}    <Scaling {}perTurn="10 mm"/>
    <Limits velocity="300 mm/s" acceleration="2000 mm/s^2" jerk="40000 mm/s^3"
            softNegative="-10 mm" softPositive="400 mm"/>
    <Homing method="35"/>
  </Axis>
)",
                       device.axis, escaped(device.slave),
                       known ? ""
                             : "    <!-- countsPerTurn: position units of the drive for one motor "
                               "turn; see its manual. -->\n",
                       known ? "" : "countsPerTurn=\"10000\" ");
}

std::string twinElement(const NamedDevice& device) {
    return fmt::format(R"(    <Device slave="{}">
      <Mechanics start="0 mm" inertia="2 kg cm^2" friction="0.1 Nm">
        <HardStops from="-30 mm" to="420 mm"/>
      </Mechanics>
    </Device>
)",
                       escaped(device.slave));
}

/// The network's own cycle and slaves, or those of a network file.
std::string networkAttributes(const Project& project) {
    std::string text = project.eni.empty()
                           ? std::string{"cycle=\"1 ms\""}
                           : fmt::format("eni=\"{}\"", escaped(project.eni.filename().string()));
    if (!project.interface.empty())
        text += fmt::format(" interface=\"{}\"", escaped(project.interface));
    return text;
}

std::string machineFile(const Project& project) {
    std::string text = fmt::format(
        R"(<?xml version="1.0" encoding="UTF-8"?>
<!-- Every number carries its unit. `takt check machine.xml` says what is wrong with it, and where. -->
<Machine name="{0}"
         xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
         xsi:noNamespaceSchemaLocation="machine.xsd">

  <!-- {4} -->
  <Network {3}>
{1}{2}  </Network>
)",
        project.name, esiElements(project), slaveElements(project), networkAttributes(project),
        project.eni.empty() ? "The devices in the order in which frames pass them."
                            : "Devices, cycle and process image are those of the network "
                              "file.");
    text +=
        "\n  <!-- perTurn: travel of the load for one turn of the motor. Put your mechanics and "
        "limits here. -->";
    for (const NamedDevice& device : project.devices) {
        if (!device.axis.empty()) text += axisElement(device);
    }
    text += fmt::format("\n  <Program name=\"{0}\" library=\"build/lib{0}.so\"/>\n", project.name);
    text +=
        "\n  <!-- Used only when the machine is simulated: where things stand at power-up, and "
        "their ends. -->\n  <Twin>\n";
    for (const NamedDevice& device : project.devices) {
        if (!device.axis.empty()) text += twinElement(device);
    }
    return text + "  </Twin>\n</Machine>\n";
}

std::map<std::string, std::string> placeholders(const Project& project) {
    std::string names;
    std::string told;
    for (const NamedDevice& device : project.devices) {
        if (device.axis.empty()) continue;
        names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", device.axis);
        told += fmt::format("{}{} ({})", told.empty() ? "" : ", ", device.axis,
                            device.source.device.type);
    }
    const std::string count = std::to_string(project.axes);
    return {
        {"name", project.name},
        {"class", className(project.name)},
        {"count", count},
        {"axisNames", names},
        {"axesText", fmt::format("{} {}: {}", count, project.axes == 1 ? "axis" : "axes", told)},
        {"version", program::Version}};
}

Files makeFiles(const Project& project, const InstalledFiles& installed) {
    const auto values = placeholders(project);
    Files files{{"machine.xml", machineFile(project)},
                {project.name + ".cpp", replaceAll(templates::Program, values)},
                {"CMakeLists.txt", replaceAll(templates::CMakeLists, values)},
                {"test/trace_test.cpp", replaceAll(templates::TraceTest, values)},
                {".github/workflows/ci.yml", replaceAll(templates::CiFile, values)},
                {"README.md", replaceAll(templates::Readme, values)},
                {".gitignore", replaceAll(templates::GitIgnore, values)},
                {"machine.xsd", readWhole(installed.schema)}};
    std::map<std::string, std::filesystem::path> copied;
    if (!project.eni.empty()) {
        files.emplace_back(project.eni.filename().string(), readWhole(project.eni));
    }
    for (const NamedDevice& device : project.devices) {
        const std::filesystem::path& source = device.source.file;
        const std::string name = source.filename().string();
        if (name.empty()) continue;
        const auto [place, fresh] = copied.try_emplace(name, source);
        if (fresh) files.emplace_back("devices/" + name, readWhole(source));
        if (!std::filesystem::equivalent(place->second, source)) {
            throw std::runtime_error{fmt::format("{} and {} have the same name; rename one of them",
                                                 place->second.string(), source.string())};
        }
    }
    return files;
}

void refuseFolder(const std::filesystem::path& folder) {
    if (!std::filesystem::exists(folder)) return;
    if (!std::filesystem::is_directory(folder)) {
        throw std::runtime_error{
            fmt::format("{} is there and is no folder; nothing was written", folder.string())};
    }
    if (!std::filesystem::is_empty(folder)) {
        throw std::runtime_error{fmt::format(
            "{} is not empty; name a new folder; nothing was written", folder.string())};
    }
}

void write(const std::filesystem::path& folder, const Files& files) {
    for (const auto& [name, text] : files) {
        const std::filesystem::path path = folder / name;
        std::filesystem::create_directories(path.parent_path());
        std::ofstream file{path, std::ios::binary};
        file << text;
        file.close();
        if (!file) throw std::runtime_error{fmt::format("{} cannot be written", path.string())};
    }
}

std::vector<ProjectDevice> pickDevices(const NewProjectOptions& options,
                                       const InstalledFiles& installed) {
    std::vector<std::filesystem::path> files = options.esi;
    if (!options.eni.empty()) {
        for (const auto& file : deviceFiles(installed)) files.push_back(file);
        return devicesOfNetwork(options.eni, files);
    }
    if (!options.interface.empty()) {
        for (const auto& file : deviceFiles(installed)) files.push_back(file);
        BusOptions network;
        network.interface = options.interface;
        network.executableFolder = options.executableFolder;
        ToolBus bus{network};
        std::vector<wire::Identity> found;
        for (const auto& device : bus.segment().devices()) found.push_back(device.identity);
        return findDevices(files, found);
    }
    if (files.empty()) files = {installed.devices / "cd300e.xml"};
    return chooseDevices(files, options.devices);
}

void tell(const NewProjectOptions& options, const Project& project, const Files& files) {
    if (options.json) {
        std::vector<std::string> names;
        for (const auto& file : files) names.push_back(jsonText(file.first));
        fmt::print("{}\n", JsonObject{}
                               .add("name", project.name)
                               .addRaw("axes", std::to_string(project.axes))
                               .addRaw("files", jsonArray(names))
                               .text());
        return;
    }
    const auto values = placeholders(project);
    fmt::print("{}: {}\n", options.folder.string(), values.at("axesText"));
    for (const auto& file : files) fmt::print("  {}\n", file.first);
    fmt::print(
        "next:\n  cd {}\n  cmake -B build && cmake --build build\n"
        "  takt run machine.xml --fast --plot run.svg\n  ctest --test-dir build\n",
        options.folder.string());
}

}  // namespace

int newProject(const NewProjectOptions& options) {
    return runVerb("new", [&options] {
        refuseFolder(options.folder);
        const InstalledFiles installed = findInstalledFiles(options.executableFolder);
        const Project project = makeProject(options, pickDevices(options, installed));
        const Files files = makeFiles(project, installed);
        write(options.folder, files);
        tell(options, project, files);
        return 0;
    });
}

}  // namespace takt::cli
