#include <fmt/format.h>

#include <takt/wire/al_state.hpp>

#include "bus_verbs.hpp"
#include "device_state.hpp"
#include "json.hpp"

namespace takt::cli {

int slaves(const BusOptions& options) {
    return runVerb("slaves", [&options] {
        const ToolBus bus{options};
        std::vector<std::string> lines;
        if (!options.json) {
            fmt::print("{:>3}  {:>5}  {:>5}  {:<16}  {:<14}  {:<16}  {}\n", "pos", "addr", "alias",
                       "name", "state", "type", "device");
        }
        for (std::size_t i = 0; i < bus.size(); ++i) {
            const ToolDevice device = bus.device(i);
            const auto& found = *device.found;
            const std::string problem = problemOf(found);
            const std::string alias =
                bus.segment().inOperation() ? std::string{} : std::to_string(found.alias);
            if (options.json) {
                lines.push_back(JsonObject{}
                                    .addRaw("pos", std::to_string(i))
                                    .addRaw("address", std::to_string(found.station))
                                    .addRaw("alias", alias.empty() ? "null" : alias)
                                    .add("name", device.name)
                                    .add("state", wire::name(found.state))
                                    .add("error", found.stateError)
                                    .addRaw("alStatusCode", std::to_string(found.alStatusCode))
                                    .add("type", device.type())
                                    .add("device", found.name)
                                    .text());
                continue;
            }
            fmt::print("{:>3}  {:>5}  {:>5}  {:<16}  {:<14}  {:<16}  {}{}{}\n", i, found.station,
                       alias.empty() ? "-" : alias, device.name.empty() ? "-" : device.name,
                       stateWord(found), device.type(), found.name, problem.empty() ? "" : ": ",
                       problem);
        }
        if (options.json) fmt::print("{}\n", jsonArray(lines));
        return 0;
    });
}

}  // namespace takt::cli
