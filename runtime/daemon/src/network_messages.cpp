#include "network_messages.hpp"

namespace takt::daemon {

namespace {

/// Calls `visit("name", member)` for each plain member, in the order of the wire.
template <typename Report, typename Visit>
void eachOfDevice(Report& device, const Visit& visit) {
    visit("position", device.position);
    visit("station", device.station);
    visit("name", device.name);
    visit("type", device.type);
    visit("device", device.device);
    visit("file", device.file);
    visit("vendor", device.vendor);
    visit("product", device.product);
    visit("revision", device.revision);
    visit("state", device.state);
    visit("error", device.error);
    visit("alStatusCode", device.alStatusCode);
    visit("problem", device.problem);
    visit("group", device.group);
    visit("expected", device.expected);
    visit("lastSeen", device.lastSeen);
    visit("wrong", device.wrong);
    visit("lost", device.lost);
    visit("lostInRow", device.lostInRow);
    visit("workingCounter", device.workingCounter);
    visit("emergencies", device.emergencies);
    visit("lastEmergency", device.lastEmergency);
}

template <typename Report, typename Visit>
void eachOfNetwork(Report& network, const Visit& visit) {
    visit("machine", network.machine);
    visit("cycle", network.cycle);
    visit("state", network.state);
    visit("problem", network.problem);
    visit("framesSent", network.framesSent);
    visit("framesLost", network.framesLost);
    visit("framesLate", network.framesLate);
    visit("framesDuplicate", network.framesDuplicate);
    visit("framesMalformed", network.framesMalformed);
    visit("framesForeign", network.framesForeign);
    visit("sendFailures", network.sendFailures);
    visit("workingCounterErrors", network.workingCounterErrors);
    visit("missedCycles", network.missedCycles);
    visit("lateWakeUps", network.lateWakeUps);
    visit("missedByHost", network.missedByHost);
    visit("missedByBus", network.missedByBus);
    visit("missedByPrograms", network.missedByPrograms);
    visit("missedByAxes", network.missedByAxes);
    visit("clockLocked", network.clockLocked);
    visit("relocks", network.relocks);
    visit("driftPpm", network.driftPpm);
}

template <typename Report, typename Visit>
void eachOfTimes(Report& times, const Visit& visit) {
    visit("count", times.count);
    visit("least", times.least);
    visit("mean", times.mean);
    visit("mostOf99", times.mostOf99);
    visit("mostOf999", times.mostOf999);
    visit("most", times.most);
}

/// The measured times, with their names on the wire.
template <typename Report, typename Visit>
void eachTimes(Report& network, const Visit& visit) {
    visit("lateness", network.lateness);
    visit("reply", network.reply);
    visit("execution", network.execution);
    visit("phaseError", network.phaseError);
}

Json jsonOf(const TimesReport& times) {
    Json json = Json::object();
    eachOfTimes(times, [&json](const char* name, const auto& value) { json[name] = value; });
    json["bins"] = Json::array();
    for (const TimesReport::Bin& bin : times.bins)
        json["bins"].push_back({{"upTo", bin.upTo}, {"count", bin.count}});
    return json;
}

void take(const Json& json, TimesReport& times, std::string& error) {
    Members members{json, error};
    eachOfTimes(times, [&members](const char* name, auto& value) { members.take(name, value); });
    const Json* const bins = members.array("bins");
    if (bins == nullptr) return;
    for (const Json& item : *bins) {
        Members ofBin{item, error};
        TimesReport::Bin bin;
        ofBin.take("upTo", bin.upTo);
        ofBin.take("count", bin.count);
        times.bins.push_back(bin);
    }
}

}  // namespace

Json jsonOf(const NetworkReport& network) {
    Json json = Json::object();
    eachOfNetwork(network, [&json](const char* name, const auto& value) { json[name] = value; });
    eachTimes(network,
              [&json](const char* name, const auto& times) { json[name] = jsonOf(times); });
    json["devices"] = Json::array();
    for (const DeviceReport& device : network.devices) {
        Json item = Json::object();
        eachOfDevice(device, [&item](const char* name, const auto& value) { item[name] = value; });
        json["devices"].push_back(std::move(item));
    }
    return json;
}

NetworkReport networkOf(const Json& json, std::string& error) {
    NetworkReport network;
    Members members{json, error};
    eachOfNetwork(network, [&](const char* name, auto& value) { members.take(name, value); });
    eachTimes(network, [&](const char* name, TimesReport& times) {
        if (const Json* found = members.object(name)) take(*found, times, error);
    });
    const Json* const devices = members.array("devices");
    if (devices == nullptr) return network;
    for (const Json& item : *devices) {
        DeviceReport device;
        Members ofDevice{item, error};
        eachOfDevice(device, [&](const char* name, auto& value) { ofDevice.take(name, value); });
        network.devices.push_back(std::move(device));
    }
    return network;
}

}  // namespace takt::daemon
