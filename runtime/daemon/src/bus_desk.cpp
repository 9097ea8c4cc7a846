#include "bus_desk.hpp"

#include <algorithm>
#include <takt/fieldbus/pdo_layout.hpp>

namespace takt::daemon {

using fieldbus::ethercat::ObjectUser;

BusDesk::BusDesk(const Parts& parts) : parts_{parts} {
    const auto& slaves = parts.network.slaves;
    for (const axis::AxisParams& axis : parts.axisParams) {
        const auto slave = std::find_if(slaves.begin(), slaves.end(), [&axis](const auto& s) {
            return s.name == axis.drive.slave;
        });
        deviceOfAxis_.push_back(static_cast<std::size_t>(slave - slaves.begin()));
    }
}

Verdict BusDesk::begin(const ControlCommand& command, bool operating) noexcept {
    if (command.target >= parts_.network.slaves.size()) return {.refusal = Refusal::UnknownTarget};
    if (command.order == Order::Download) {
        const Verdict verdict = judgeWrite(command, operating);
        if (verdict.refusal != Refusal::None) return verdict;
    }
    if (!waiting_.push(command)) return {.refusal = Refusal::Busy};
    return {.pending = true};
}

Verdict BusDesk::judgeWrite(const ControlCommand& command, bool operating) const noexcept {
    if (!operating) return {.refusal = Refusal::NotOperating};
    const fieldbus::SlaveParams& slave = parts_.network.slaves[command.target];
    const bool ofTheCycle = fieldbus::findEntry(slave, fieldbus::Direction::Outputs,
                                                command.object.index, command.object.subindex)
                                .present();
    if (ofTheCycle) return {.refusal = Refusal::OfTheCycle};
    if (command.force) return {};
    const auto runs = [](const ProgramHost& program) {
        return !program.ended() && !program.held();
    };
    const auto program = std::find_if(parts_.programs.begin(), parts_.programs.end(), runs);
    if (program != parts_.programs.end()) {
        const auto which = static_cast<std::uint16_t>(program - parts_.programs.begin());
        return {.refusal = Refusal::ProgramsRun, .detail = which};
    }
    for (std::size_t i = 0; i < deviceOfAxis_.size(); ++i) {
        if (deviceOfAxis_[i] == command.target && isMoving(parts_.axes[i]))
            return {.refusal = Refusal::AxisMoves, .detail = static_cast<std::uint16_t>(i)};
    }
    return {};
}

bool BusDesk::start(const ControlCommand& command) noexcept {
    core::ObjectAccess& objects = parts_.master.objects(command.target, ObjectUser::Operator);
    if (command.order == Order::Upload) return objects.startRead(command.object);
    return objects.startWrite(command.object, command.value);
}

std::optional<ControlAnswer> BusDesk::cycle(core::CycleNumber cycle) noexcept {
    if (waiting_.empty()) return std::nullopt;
    if (!underWay_) {
        // While the axis itself asks for something, the request waits for the next cycle.
        underWay_ = !resting_ && start(waiting_.front());
        resting_ = false;
        return std::nullopt;
    }
    const ControlCommand& command = waiting_.front();
    const core::ObjectReply reply =
        parts_.master.objects(command.target, ObjectUser::Operator).reply();
    if (reply.state == core::ObjectState::Pending) return std::nullopt;
    const bool done = reply.state == core::ObjectState::Done;
    const ControlAnswer answer{.ticket = command.ticket,
                               .cycle = cycle,
                               .kind = done ? AnswerKind::Done : AnswerKind::Failed,
                               .value = reply.value,
                               .abortCode = reply.abortCode};
    waiting_.popFront();
    underWay_ = false;
    resting_ = true;
    return answer;
}

}  // namespace takt::daemon
