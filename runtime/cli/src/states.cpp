#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <stdexcept>
#include <takt/wire/al_state.hpp>

#include "bus_verbs.hpp"
#include "device_state.hpp"
#include "json.hpp"

namespace takt::cli {

namespace {

using wire::AlState;

AlState parseState(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    for (const AlState state : {AlState::Init, AlState::PreOp, AlState::SafeOp, AlState::Op}) {
        if (text == wire::name(state)) return state;
    }
    throw std::runtime_error{
        fmt::format("'{}' is not a state; there are INIT, PREOP, SAFEOP and OP", text)};
}

/// \return what kept devices from getting there; empty: nothing
std::string lead(ToolBus& bus, const std::vector<std::size_t>& positions, AlState target) {
    std::string refused;
    for (const std::size_t i : positions) {
        if (bus.segment().toState(i, target)) continue;
        const auto& found = bus.segment().devices()[i];
        const std::string problem = problemOf(found);
        refused += fmt::format("{}device {} stays in {}{}{}", refused.empty() ? "" : "; ", i,
                               stateWord(found), problem.empty() ? "" : ": ", problem);
    }
    return refused;
}

void print(const ToolBus& bus, const std::vector<std::size_t>& positions, bool json) {
    std::vector<std::string> lines;
    for (const std::size_t i : positions) {
        const ToolDevice device = bus.device(i);
        const auto& found = *device.found;
        if (json) {
            lines.push_back(JsonObject{}
                                .addRaw("pos", std::to_string(i))
                                .add("name", device.name)
                                .add("state", wire::name(found.state))
                                .add("error", found.stateError)
                                .addRaw("alStatusCode", std::to_string(found.alStatusCode))
                                .add("problem", problemOf(found))
                                .text());
        } else {
            fmt::print("{:>3}  {:<16}  {:<14}  {}\n", i,
                       device.name.empty() ? device.type() : device.name, stateWord(found),
                       problemOf(found));
        }
    }
    if (json) fmt::print("{}\n", jsonArray(lines));
}

}  // namespace

int states(const StatesOptions& options) {
    return runVerb("states", [&options] {
        std::optional<AlState> target;
        if (!options.state.empty()) target = parseState(options.state);
        ToolBus bus{options.bus};
        std::vector<std::size_t> positions;
        for (std::size_t i = 0; i < bus.size(); ++i) positions.push_back(i);
        if (!options.slave.empty()) positions = {bus.find(options.slave)};
        const std::string refused = target ? lead(bus, positions, *target) : std::string{};
        print(bus, positions, options.bus.json);
        if (!refused.empty()) throw std::runtime_error{refused};
        return 0;
    });
}

}  // namespace takt::cli
