#include "listed_script.hpp"

#include <algorithm>
#include <iterator>
#include <takt/wire/device_description.hpp>
#include <takt/wire/registers.hpp>

#include "command_runner.hpp"

namespace takt::fieldbus::ethercat {

namespace {

using wire::AlState;

Script commandsOf(const ListedSlave& listed, Transition transition) {
    Script script;
    for (std::size_t i = 0; i < listed.commands.size(); ++i) {
        if (!listed.commands[i].transitions.has(transition)) continue;
        script.emplace_back(CommandStep{listed.commands[i], i});
    }
    return script;
}

Script objectsOf(const ListedSlave& listed, Transition transition) {
    Script script;
    for (const ListedObject& object : listed.objects) {
        if (!object.transitions.has(transition)) continue;
        script.emplace_back(ObjectStep{{object.index, object.subindex},
                                       object.data,
                                       true,
                                       object.origin,
                                       object.completeAccess});
    }
    return script;
}

bool asksForState(const Step& step) {
    const auto& command = std::get<CommandStep>(step).command;
    return command.ado == wire::reg::AlControl && writes(command);
}

void append(Script& script, Script&& more) {
    std::move(more.begin(), more.end(), std::back_inserter(script));
}

/// Objects first: they need the mailbox, which a state below may not have.
Script down(const ListedSlave& listed, Transition transition, StateStep own) {
    Script commands = commandsOf(listed, transition);
    const bool complete = std::any_of(commands.begin(), commands.end(), asksForState);
    Script script = objectsOf(listed, transition);
    if (!complete) script.emplace_back(own);
    append(script, std::move(commands));
    return script;
}

}  // namespace

SlaveScripts makeListedScripts(const SlaveParams& slave) {
    const ListedSlave& listed = *slave.listed;
    const wire::StateTimeouts timeouts =
        slave.device ? slave.device->timeouts : wire::StateTimeouts{};
    SlaveScripts scripts;
    scripts.toPreOp = commandsOf(listed, Transition::InitToPreOp);
    append(scripts.toPreOp, objectsOf(listed, Transition::InitToPreOp));
    scripts.inPreOp = objectsOf(listed, Transition::PreOpToSafeOp);
    append(scripts.inPreOp, startupSteps(slave));
    Script toSafeOp = commandsOf(listed, Transition::PreOpToSafeOp);
    const auto request = std::find_if(toSafeOp.begin(), toSafeOp.end(), asksForState);
    scripts.armSync.assign(toSafeOp.begin(), request);
    scripts.toSafeOp.assign(request, toSafeOp.end());
    scripts.toOp = objectsOf(listed, Transition::SafeOpToOp);
    append(scripts.toOp, commandsOf(listed, Transition::SafeOpToOp));
    // The list does not acknowledge errors; the way to SAFEOP does.
    scripts.recover = {StateStep{AlState::SafeOp, timeouts.safeOpOp}};
    append(scripts.recover, commandsOf(listed, Transition::SafeOpToOp));
    scripts.backToSafeOp =
        down(listed, Transition::OpToSafeOp, {AlState::SafeOp, timeouts.backToSafeOp});
    scripts.backToPreOp =
        down(listed, Transition::SafeOpToPreOp, {AlState::PreOp, timeouts.backToInit});
    scripts.backToInit =
        down(listed, Transition::PreOpToInit, {AlState::Init, timeouts.backToInit});
    return scripts;
}

CommonScripts makeCommonScripts(const NetworkParams& network) {
    CommonScripts scripts;
    if (!network.listed) return scripts;
    const auto& commands = network.listed->commands;
    for (std::size_t i = 0; i < commands.size(); ++i) {
        for (std::size_t t = 0; t < TransitionCount; ++t) {
            if (!commands[i].transitions.has(static_cast<Transition>(t))) continue;
            auto& list = commands[i].beforeSlaves ? scripts.before : scripts.after;
            list[t].emplace_back(CommandStep{commands[i], i});
        }
    }
    return scripts;
}

}  // namespace takt::fieldbus::ethercat
