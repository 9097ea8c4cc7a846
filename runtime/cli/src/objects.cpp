#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <takt/wire/al_state.hpp>

#include "bus_verbs.hpp"
#include "json.hpp"
#include "object_value.hpp"

namespace takt::cli {

namespace {

const wire::ObjectEntryDescription* describe(const ToolDevice& device,
                                             core::ObjectAddress address) {
    if (device.description == nullptr) return nullptr;
    const wire::ObjectDescription* const object = device.description->findObject(address.index);
    if (object == nullptr) return nullptr;
    const auto entry =
        std::find_if(object->entries.begin(), object->entries.end(),
                     [&address](const auto& e) { return e.subindex == address.subindex; });
    return entry == object->entries.end() ? nullptr : &*entry;
}

std::string nameOf(core::ObjectAddress address) {
    return fmt::format("0x{:04X}:{:02X}", address.index, address.subindex);
}

void refuseFailed(const core::ObjectReply& reply, std::size_t position,
                  core::ObjectAddress address) {
    if (reply.state == core::ObjectState::Done) return;
    throw std::runtime_error{fmt::format("device {}, object {}: 0x{:08X} {}", position,
                                         nameOf(address), reply.abortCode,
                                         wire::explainAbort(reply.abortCode))};
}

void print(const ObjectOptions& options, std::size_t position, core::ObjectAddress address,
           const core::ObjectValue& value, wire::DataType type, const std::string& name) {
    if (options.bus.json) {
        fmt::print("{}\n", JsonObject{}
                               .addRaw("pos", std::to_string(position))
                               .add("object", nameOf(address))
                               .add("name", name)
                               .add("type", typeName(type))
                               .add("value", showValue(value, type))
                               .add("hex", showHex(value))
                               .text());
        return;
    }
    fmt::print("{}  {}  {}{}{}\n", showValue(value, type), showHex(value), typeName(type),
               name.empty() ? "" : "  ", name);
}

}  // namespace

int upload(const ObjectOptions& options) {
    return runVerb("upload", [&options] {
        const core::ObjectAddress address = parseAddress(options.object);
        std::optional<wire::DataType> type;
        if (!options.type.empty()) type = parseType(options.type);
        ToolBus bus{options.bus};
        const std::size_t position = bus.find(options.slave);
        const core::ObjectReply reply = bus.segment().upload(position, address);
        refuseFailed(reply, position, address);
        const auto* const entry = describe(bus.device(position), address);
        if (!type) type = entry != nullptr ? entry->type : typeOfSize(reply.value.size);
        print(options, position, address, reply.value, *type,
              entry != nullptr ? entry->name : std::string{});
        return 0;
    });
}

int download(const ObjectOptions& options) {
    return runVerb("download", [&options] {
        const core::ObjectAddress address = parseAddress(options.object);
        std::optional<wire::DataType> type;
        if (!options.type.empty()) type = parseType(options.type);
        ToolBus bus{options.bus};
        const std::size_t position = bus.find(options.slave);
        const auto* const entry = describe(bus.device(position), address);
        if (!type && entry != nullptr) type = entry->type;
        if (!type) {
            throw std::runtime_error{
                fmt::format("the type of {} is not known; name it with --type, or the device's "
                            "file with --esi",
                            nameOf(address))};
        }
        const core::ObjectValue value = parseValue(options.value, *type);
        const core::ObjectReply reply =
            bus.segment().download(position, address, value, options.force);
        refuseFailed(reply, position, address);
        print(options, position, address, value, *type,
              entry != nullptr ? entry->name : std::string{});
        return 0;
    });
}

}  // namespace takt::cli
