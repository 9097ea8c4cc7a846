#include <array>
#include <takt/daemon/control_messages.hpp>

#include "json_members.hpp"
#include "network_messages.hpp"

namespace takt::daemon {

namespace {

constexpr std::array<std::string_view, 5> KindNames{"accepted", "refused", "done", "aborted",
                                                    "failed"};

/// The text as an object; a number that JSON cannot hold never gets this far.
std::optional<Json> parseObject(std::string_view line, std::string& error) {
    Json json = Json::parse(line.begin(), line.end(), nullptr, false);
    if (json.is_discarded()) {
        error = "this is not JSON";
        return std::nullopt;
    }
    if (!json.is_object()) {
        error = "this is not a JSON object";
        return std::nullopt;
    }
    return json;
}

Json jsonOf(const AxisReport& axis) {
    return {{"name", axis.name},
            {"unit", axis.unit},
            {"state", axis.state},
            {"set", numberOf(axis.set)},
            {"actual", numberOf(axis.actual)},
            {"velocity", numberOf(axis.velocity)},
            {"lag", numberOf(axis.lag)},
            {"powered", axis.powered},
            {"homed", axis.homed},
            {"needsEnableEdge", axis.needsEnableEdge},
            {"error", axis.error},
            {"holder", axis.holder}};
}

AxisReport axisOf(const Json& json, std::string& error) {
    AxisReport axis;
    Members members{json, error};
    members.take("name", axis.name);
    members.take("unit", axis.unit);
    members.take("state", axis.state);
    members.take("set", axis.set);
    members.take("actual", axis.actual);
    members.take("velocity", axis.velocity);
    members.take("lag", axis.lag);
    members.take("powered", axis.powered);
    members.take("homed", axis.homed);
    members.take("needsEnableEdge", axis.needsEnableEdge);
    members.take("error", axis.error);
    members.take("holder", axis.holder);
    return axis;
}

Json jsonOf(const GroupReport& group) {
    return {{"name", group.name},
            {"unit", group.unit},
            {"state", group.state},
            {"path", numberOf(group.path)},
            {"velocity", numberOf(group.velocity)},
            {"queued", group.queued},
            {"error", group.error}};
}

GroupReport groupOf(const Json& json, std::string& error) {
    GroupReport group;
    Members members{json, error};
    members.take("name", group.name);
    members.take("unit", group.unit);
    members.take("state", group.state);
    members.take("path", group.path);
    members.take("velocity", group.velocity);
    members.take("queued", group.queued);
    members.take("error", group.error);
    return group;
}

Json jsonOf(const ProgramReport& program) {
    Json watches = Json::object();
    for (const WatchReport& watch : program.watches) watches[watch.name] = numberOf(watch.value);
    return {{"name", program.name}, {"state", program.state}, {"watches", watches}};
}

ProgramReport programOf(const Json& json, std::string& error) {
    ProgramReport program;
    Members members{json, error};
    members.take("name", program.name);
    members.take("state", program.state);
    if (const Json* watches = members.object("watches")) {
        for (const auto& [name, value] : watches->items()) {
            program.watches.push_back(
                {name, value.is_number() ? value.get<double>() : std::nan("")});
        }
    }
    return program;
}

Json jsonOf(const StatusReport& status) {
    Json json{{"machine", status.machine},
              {"pid", status.pid},
              {"cycle", status.cycle},
              {"seconds", status.seconds},
              {"phase", status.phase},
              {"network", status.network},
              {"framesSent", status.framesSent},
              {"framesLost", status.framesLost},
              {"framesLate", status.framesLate},
              {"workingCounterErrors", status.workingCounterErrors},
              {"machineStop", status.machineStop},
              {"owner", status.owner},
              {"bridgeProcess", status.bridgeProcess},
              {"bridgeStarts", status.bridgeStarts},
              {"bridgePublished", status.bridgePublished},
              {"axes", Json::array()},
              {"groups", Json::array()},
              {"programs", Json::array()}};
    for (const AxisReport& axis : status.axes) json["axes"].push_back(jsonOf(axis));
    for (const GroupReport& group : status.groups) json["groups"].push_back(jsonOf(group));
    for (const ProgramReport& program : status.programs)
        json["programs"].push_back(jsonOf(program));
    return json;
}

StatusReport statusOf(const Json& json, std::string& error) {
    StatusReport status;
    Members members{json, error};
    members.take("machine", status.machine);
    members.take("pid", status.pid);
    members.take("cycle", status.cycle);
    members.take("seconds", status.seconds);
    members.take("phase", status.phase);
    members.take("network", status.network);
    members.take("framesSent", status.framesSent);
    members.take("framesLost", status.framesLost);
    members.take("framesLate", status.framesLate);
    members.take("workingCounterErrors", status.workingCounterErrors);
    members.take("machineStop", status.machineStop);
    members.take("owner", status.owner);
    members.take("bridgeProcess", status.bridgeProcess);
    members.take("bridgeStarts", status.bridgeStarts);
    members.take("bridgePublished", status.bridgePublished);
    if (const Json* axes = members.array("axes")) {
        for (const Json& axis : *axes) status.axes.push_back(axisOf(axis, error));
    }
    if (const Json* groups = members.array("groups")) {
        for (const Json& group : *groups) status.groups.push_back(groupOf(group, error));
    }
    if (const Json* programs = members.array("programs")) {
        for (const Json& program : *programs) status.programs.push_back(programOf(program, error));
    }
    return status;
}

std::vector<EventReport> eventsOf(const Json& json, std::string& error) {
    std::vector<EventReport> events;
    for (const Json& item : json) {
        EventReport event;
        Members members{item, error};
        members.take("number", event.number);
        members.take("cycle", event.cycle);
        members.take("seconds", event.seconds);
        members.take("text", event.text);
        events.push_back(std::move(event));
    }
    return events;
}

/// A name from outside may be no UTF-8: then its bad bytes are replaced instead of throwing.
std::string line(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::optional<ControlRequest> parseRequest(std::string_view text, std::string& error) {
    error.clear();
    const auto json = parseObject(text, error);
    if (!json) return std::nullopt;
    ControlRequest request;
    Members members{*json, error};
    members.take("id", request.id);
    members.take("do", request.verb);
    members.take("axis", request.axis);
    members.take("program", request.program);
    members.take("distance", request.distance);
    members.take("velocity", request.velocity);
    members.take("device", request.device);
    members.take("object", request.object);
    members.take("data", request.data);
    members.take("force", request.force);
    members.take("after", request.after);
    members.take("who", request.who);
    if (members.good() && request.verb.empty()) error = "\"do\" is missing";
    if (!members.good()) return std::nullopt;
    return request;
}

std::string encode(const ControlRequest& request) {
    Json json{{"id", request.id}, {"do", request.verb}};
    if (!request.axis.empty()) json["axis"] = request.axis;
    if (!request.program.empty()) json["program"] = request.program;
    if (request.distance != 0.0) json["distance"] = numberOf(request.distance);
    if (request.velocity != 0.0) json["velocity"] = numberOf(request.velocity);
    if (!request.device.empty()) json["device"] = request.device;
    if (!request.object.empty()) json["object"] = request.object;
    if (!request.data.empty()) json["data"] = request.data;
    if (request.force) json["force"] = true;
    if (request.after != 0) json["after"] = request.after;
    if (!request.who.empty()) json["who"] = request.who;
    return line(json);
}

std::optional<ControlReply> parseReply(std::string_view text, std::string& error) {
    error.clear();
    const auto json = parseObject(text, error);
    if (!json) return std::nullopt;
    ControlReply reply;
    Members members{*json, error};
    std::string kind;
    members.take("id", reply.id);
    members.take("is", kind);
    members.take("error", reply.error);
    members.take("cycle", reply.cycle);
    members.take("data", reply.data);
    members.take("abortCode", reply.abortCode);
    for (std::size_t i = 0; i < KindNames.size(); ++i) {
        if (KindNames[i] == kind) reply.kind = static_cast<ReplyKind>(i);
    }
    if (const Json* status = members.object("status")) reply.status = statusOf(*status, error);
    if (const Json* events = members.array("events")) reply.events = eventsOf(*events, error);
    if (const Json* network = members.object("network")) reply.network = networkOf(*network, error);
    if (!members.good()) return std::nullopt;
    return reply;
}

std::string encode(const ControlReply& reply) {
    Json json{{"id", reply.id}, {"is", KindNames[static_cast<std::size_t>(reply.kind)]}};
    if (!reply.error.empty()) json["error"] = reply.error;
    if (reply.cycle != 0) json["cycle"] = reply.cycle;
    if (!reply.data.empty()) json["data"] = reply.data;
    if (reply.abortCode != 0) json["abortCode"] = reply.abortCode;
    if (reply.network) json["network"] = jsonOf(*reply.network);
    if (reply.status) json["status"] = jsonOf(*reply.status);
    if (reply.events) {
        json["events"] = Json::array();
        for (const EventReport& event : *reply.events) {
            json["events"].push_back({{"number", event.number},
                                      {"cycle", event.cycle},
                                      {"seconds", event.seconds},
                                      {"text", event.text}});
        }
    }
    return line(json);
}

}  // namespace takt::daemon
