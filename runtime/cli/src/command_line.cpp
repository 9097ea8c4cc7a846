#include <unistd.h>

#include <CLI/CLI.hpp>
#include <climits>
#include <optional>
#include <string>
#include <string_view>
#include <takt/cli/command_line.hpp>
#include <takt/daemon/run.hpp>
#include <takt/daemon/sim.hpp>
#include <takt/program/entry.hpp>
#include <utility>

#include "bus_verbs.hpp"
#include "new_project.hpp"
#include "remote.hpp"

namespace takt::cli {

namespace {

/// "10s", "500 ms": a length of time with its unit.
core::Duration parseLength(const char* option, const std::string& text) {
    static const std::map<std::string, double> units{
        {"ms", 1e6}, {"s", 1e9}, {"min", 60e9}, {"h", 3600e9}};
    std::size_t end = 0;
    double value = 0;
    try {
        value = std::stod(text, &end);
    } catch (const std::exception&) {
        end = 0;
    }
    const std::size_t unitAt = text.find_first_not_of(' ', end);
    const auto unit = unitAt == std::string::npos ? units.end() : units.find(text.substr(unitAt));
    if (end == 0 || unit == units.end() || !(value > 0) || value * unit->second > 9e18) {
        throw CLI::ValidationError(
            option, "'" + text + "' is not a length of time; use for example 10s, 500ms, 5min");
    }
    return core::Duration{static_cast<std::int64_t>(value * unit->second)};
}

std::filesystem::path executableFolder() {
    std::error_code error;
    const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
    return error ? std::filesystem::path{} : self.parent_path();
}

/// A script whose variable is not set must not run another machine than the one it means.
std::string interfaceNamed(const std::string& text) {
    return text.empty() ? "no interface is named; `ip link` lists what there is" : std::string{};
}

/// What `run` needs beyond the options struct until all of the line has been read.
struct RunArguments {
    daemon::RunOptions options;
    std::string length;
    std::string watchdog;
    bool sim{false};
};

void addRun(CLI::App& app, RunArguments& run) {
    auto* command = app.add_subcommand("run", "run a machine until its programs have finished");
    auto& options = run.options;
    command->add_option("machine", options.machine, "machine.xml")->required();
    auto* sim = command->add_flag("--sim", run.sim,
                                  "on the simulated machine; so it is without --interface");
    auto* fast = command->add_flag("--fast", options.fast,
                                   "simulated, as fast as the computer can; implies --sim");
    command
        ->add_option("--interface", options.interface,
                     "on the network at this interface, in real time")
        ->check(interfaceNamed)
        ->excludes(sim)
        ->excludes(fast);
    command->add_option("--program", options.programLibrary,
                        "run this program library instead of those in the machine file");
    command->add_flag("--manual", options.manual, "run without programs");
    command->add_option("--for", run.length, "stop after this time in operation, e.g. 10s");
    command->add_option("--trace", options.trace, "write every cycle to this CSV file");
    command->add_option("--plot", options.plot, "draw the run into this SVG file");
    command->add_option("--top-view", options.topView,
                        "draw the way of a group among its keep-outs into this SVG file");
    command->add_option("--pcap", options.capture, "write every frame to this pcapng file");
    command->add_option(
        "--program-watchdog", run.watchdog,
        "simulated: end the run when a program does not come back for so long (10s)");
    command->add_option("--socket", options.socket, "path of the control socket");
    command
        ->add_option("--faults", options.faults,
                     "what goes wrong on the simulated machine, by cycle")
        ->excludes("--interface");
    command->add_option("--commands", options.commands,
                        "replay the operator's commands of this file, cycle by cycle");
    command->add_option("--record-commands", options.recordCommands,
                        "write the operator's commands to this file");
    command->add_flag("--quiet", options.quiet, "print errors only");
}

void addCheck(CLI::App& app, daemon::RunOptions& options) {
    auto* command =
        app.add_subcommand("check", "check a machine file and say what its network needs");
    command->add_option("machine", options.machine, "machine.xml")->required();
}

void addNew(CLI::App& app, NewProjectOptions& options) {
    auto* command = app.add_subcommand(
        "new", "write a machine of your own: machine file, program, build, test, CI");
    command->add_option("folder", options.folder, "a folder that is not there yet, or empty")
        ->required();
    command->add_option("--esi", options.esi, "device files; without: one CD300E drive");
    command->add_option("--device", options.devices,
                        "types wanted from the device files, in frame order");
    command->add_option("--eni", options.eni, "network file");
    command->add_option("--scan", options.interface,
                        "take the devices that are on this network interface");
    command->add_flag("--json", options.json, "tell the result as JSON");
}

void addSim(CLI::App& app, daemon::SimOptions& options) {
    auto* command = app.add_subcommand("sim", "serve the simulated machine on a network interface");
    command->add_option("machine", options.machine, "machine.xml")->required();
    command
        ->add_option("--interface", options.interface,
                     "network interface, for example one end of a veth pair")
        ->required();
    command->add_flag("--quiet", options.quiet, "print errors only");
}

/// What the bus tools were asked for; one struct for all, each verb takes its part.
struct BusArguments {
    BusOptions bus;
    StatesOptions states;
    ObjectOptions object;
};

CLI::App* addBusVerb(CLI::App& app, const char* name, const char* text, BusOptions& bus) {
    auto* command = app.add_subcommand(name, text);
    auto* interface = command->add_option("--interface", bus.interface, "network interface");
    command->add_option("--sim", bus.machine, "the simulated network of this machine file")
        ->excludes(interface);
    if (std::string_view{name} != "scan") {
        command
            ->add_option("--socket", bus.socket,
                         "control socket of a running machine; needed when several run")
            ->excludes(interface);
    }
    command->add_option("--esi", bus.esi, "more device files to know devices by");
    command->add_flag("--json", bus.json, "as JSON");
    return command;
}

void addBusVerbs(CLI::App& app, BusArguments& arguments) {
    BusOptions& bus = arguments.bus;
    addBusVerb(app, "scan", "who is on a network, and which device file describes it", bus);
    addBusVerb(app, "slaves", "one line for each device, with its state", bus);
    auto* states = addBusVerb(app, "states", "states of the devices, or lead them to one", bus);
    states->add_option("state", arguments.states.state, "INIT, PREOP, SAFEOP or OP");
    states->add_option("--slave", arguments.states.slave, "this device only: position or name");
    ObjectOptions& object = arguments.object;
    auto* upload = addBusVerb(app, "upload", "read an object of a device", bus);
    auto* download = addBusVerb(app, "download", "write an object of a device", bus);
    for (auto* command : {upload, download}) {
        command->add_option("slave", object.slave, "position or name")->required();
        command->add_option("object", object.object, "INDEX or INDEX:SUB, e.g. 0x1018:1")
            ->required();
        command->add_option("--type", object.type,
                            "uint16, int32, float …; without: as the device file says");
    }
    download->add_option("value", object.value, "decimal, or hexadecimal with 0x")->required();
    download->add_flag("--force", object.force,
                       "also while a program of the running machine runs or the axis moves");
}

/// \return empty: another verb was given
std::optional<int> runBusVerb(const CLI::App& app, BusArguments& arguments) {
    arguments.bus.executableFolder = executableFolder();
    arguments.bus.verb = app.get_subcommands().front()->get_name();
    arguments.states.bus = arguments.object.bus = arguments.bus;
    if (app.got_subcommand("scan")) return scan(arguments.bus);
    if (app.got_subcommand("slaves")) return slaves(arguments.bus);
    if (app.got_subcommand("states")) return states(arguments.states);
    if (app.got_subcommand("upload")) return upload(arguments.object);
    if (app.got_subcommand("download")) return download(arguments.object);
    return std::nullopt;
}

/// What is asked of a running machine.
struct RemoteArguments {
    WatchOptions watch;
    EventsOptions events;
    DiagOptions diag;
    JogOptions jog;
    OrderOptions order;
    std::string powerState;
    std::string programAction;
};

void addRemoteOptions(CLI::App& command, RemoteOptions& options, bool table) {
    command.add_option("--socket", options.socket,
                       "control socket of the machine; needed when several run");
    if (table) command.add_flag("--json", options.json, "one JSON object in each line");
}

void addTables(CLI::App& app, RemoteArguments& remote) {
    auto* watch =
        app.add_subcommand("watch", "show axes, network and programs of the running machine");
    watch->add_flag("--once", remote.watch.once, "print once and end");
    addRemoteOptions(*watch, remote.watch.remote, true);
    auto* events = app.add_subcommand("events", "show what has happened in the running machine");
    events->add_flag("--follow,-f", remote.events.follow, "go on with what happens now");
    addRemoteOptions(*events, remote.events.remote, true);
    auto* diag = app.add_subcommand(
        "diag", "how cycle, clocks and devices of the running machine are doing");
    addRemoteOptions(*diag, remote.diag.remote, true);
    auto* jog =
        app.add_subcommand("jog", "move an axis of the running machine step by step with the keys");
    jog->add_option("axis", remote.jog.axis, "name of the axis")->required();
    jog->add_option("--distance", remote.jog.distance,
                    "of one step, in units of the axis; 1 if not told")
        ->check(CLI::PositiveNumber);
    jog->add_option("--velocity", remote.jog.velocity,
                    "in units of the axis per second; 10 if not told")
        ->check(CLI::PositiveNumber);
    addRemoteOptions(*jog, remote.jog.remote, false);
}

void addOrders(CLI::App& app, RemoteArguments& remote) {
    auto& request = remote.order.request;
    auto* power = app.add_subcommand("power", "switch an axis of the running machine on or off");
    power->add_option("state", remote.powerState, "on or off")
        ->required()
        ->check(CLI::IsMember({"on", "off"}));
    power->add_option("axis", request.axis, "name of the axis")->required();
    auto* reset = app.add_subcommand(
        "reset", "clear the error of an axis; without one, reset the machine stop");
    reset->add_option("axis", request.axis, "name of the axis");
    auto* home = app.add_subcommand(
        "home", "find the reference of an axis; ends with ^C, and the axis stops");
    home->add_option("axis", request.axis, "name of the axis")->required();
    auto* stop =
        app.add_subcommand("stop", "stop the running machine: axes ramp down and are switched off");
    auto* program = app.add_subcommand("program",
                                       "stop a program of the running machine, let it go on, or "
                                       "put a fresh instance in its place");
    program->add_option("action", remote.programAction, "start, stop or reset")
        ->required()
        ->check(CLI::IsMember({"start", "stop", "reset"}));
    program->add_option("name", request.program, "name of the program")->required();
    for (CLI::App* command : {power, reset, home, stop, program}) {
        addRemoteOptions(*command, remote.order.remote, true);
    }
}

/// \return the exit code, or nothing when the line asks for something else
std::optional<int> runRemote(const CLI::App& app, RemoteArguments& remote) {
    std::string& verb = remote.order.request.verb;
    if (app.got_subcommand("watch")) return runWatch(remote.watch);
    if (app.got_subcommand("events")) return runEvents(remote.events);
    if (app.got_subcommand("diag")) return runDiag(remote.diag);
    if (app.got_subcommand("jog")) return runJog(remote.jog);
    if (app.got_subcommand("power")) verb = "power-" + remote.powerState;
    if (app.got_subcommand("reset"))
        verb = remote.order.request.axis.empty() ? "reset-stop" : "reset";
    if (app.got_subcommand("home")) verb = "home";
    if (app.got_subcommand("stop")) verb = "stop";
    if (app.got_subcommand("program")) verb = "program-" + remote.programAction;
    if (verb.empty()) return std::nullopt;
    return runOrder(remote.order);
}

}  // namespace

int commandLine(int argc, char** argv, std::vector<daemon::LinkedProgram> programs) {
    CLI::App app{"takt: a motion controller runtime for EtherCAT servo drives"};
    app.set_version_flag("--version", std::string{"takt "} + program::Version);
    app.require_subcommand(1);
    app.footer(
        "exit codes of run: 0 done, 1 configuration refused, 2 could not run, 3 axis or program "
        "failed,\n"
        "  4 program abandoned, 5 stop time-out, 128+n signal n; of check: 0 good, 1 errors, 2 "
        "could not run;\n"
        "  of commands to a running machine: 0 done, 1 refused or failed, 2 no machine");

    RunArguments runArguments;
    daemon::RunOptions checkOptions;
    addRun(app, runArguments);
    addCheck(app, checkOptions);
    NewProjectOptions newOptions;
    addNew(app, newOptions);
    BusArguments busArguments;
    addBusVerbs(app, busArguments);
    daemon::SimOptions simOptions;
    addSim(app, simOptions);
    RemoteArguments remote;
    addTables(app, remote);
    addOrders(app, remote);
    try {
        app.parse(argc, argv);
        if (!runArguments.length.empty())
            runArguments.options.length = parseLength("--for", runArguments.length);
        if (!runArguments.watchdog.empty()) {
            runArguments.options.programWatchdog =
                parseLength("--program-watchdog", runArguments.watchdog);
        }
    } catch (const CLI::ParseError& error) {
        // CLI11 has codes of its own; a wrong command line is a refused configuration.
        return app.exit(error) == 0 ? 0 : static_cast<int>(daemon::ExitCode::Refused);
    }

    if (app.got_subcommand("new")) {
        newOptions.executableFolder = executableFolder();
        return newProject(newOptions);
    }
    if (const auto code = runBusVerb(app, busArguments)) return *code;
    if (const auto code = runRemote(app, remote)) return *code;
    if (app.got_subcommand("check")) {
        checkOptions.searchDirs.push_back(executableFolder());
        return daemon::check(checkOptions);
    }
    if (app.got_subcommand("sim")) return daemon::sim(simOptions);
    runArguments.options.searchDirs.push_back(executableFolder());
    return daemon::run(runArguments.options, std::move(programs));
}

}  // namespace takt::cli
