#include "network_walk.hpp"

#include <algorithm>

namespace takt::fieldbus::ethercat {

namespace {

using wire::AlState;

constexpr std::uint32_t GoodCyclesBeforeOp = 20;
constexpr std::uint32_t QuietRoundsBeforeOp = 20;
constexpr core::Duration ReadyTimeout = std::chrono::seconds{30};
constexpr std::uint32_t StatusGap = 8;  ///< cycles between two rounds of AL status reads

}  // namespace

const char* name(NetworkState state) noexcept {
    switch (state) {
        case NetworkState::Off:
            return "Off";
        case NetworkState::PreOp:
            return "PREOP";
        case NetworkState::GoingSafeOp:
            return "going to SAFEOP";
        case NetworkState::SafeOp:
            return "SAFEOP";
        case NetworkState::GoingOp:
            return "going to OP";
        case NetworkState::Op:
            return "OP";
        case NetworkState::GoingDown:
            return "going down";
        case NetworkState::Init:
            return "INIT";
        case NetworkState::Failed:
            return "failed";
    }
    return "?";
}

NetworkWalk::NetworkWalk(const NetworkParams& network,
                         std::vector<std::unique_ptr<SlaveAgent>>& agents,
                         std::vector<SlaveScripts>& scripts, SlaveAgent& everyone,
                         const CommonScripts& common, ProcessData& data)
    : network_{network},
      agents_{agents},
      scripts_{scripts},
      everyone_{everyone},
      common_{common},
      data_{data} {}

void NetworkWalk::begin(std::size_t reference) noexcept {
    reference_ = reference;
    problem_ = {};
    opWanted_ = initWanted_ = asked_ = allWell_ = false;
    goodInRow_ = quietRounds_ = sinceStatus_ = 0;
    state_ = NetworkState::PreOp;
}

bool NetworkWalk::supervised() const noexcept {
    return state_ == NetworkState::SafeOp || state_ == NetworkState::GoingOp ||
           state_ == NetworkState::Op;
}

void NetworkWalk::step(core::CycleNumber cycle, core::HostTime now,
                       const BusReading& reading) noexcept {
    cycle_ = cycle;
    goodInRow_ = data_.allGood() ? goodInRow_ + 1 : 0;
    if (initWanted_) startDown();
    switch (state_) {
        case NetworkState::Off:
        case NetworkState::Init:
        case NetworkState::Failed:
            break;
        case NetworkState::PreOp:
            if (!opWanted_) break;
            state_ = NetworkState::GoingSafeOp;
            begin(Transition::PreOpToSafeOp, &SlaveScripts::toSafeOp, AlState::None);
            break;
        case NetworkState::GoingSafeOp:
            if (underWay()) break;
            climbed(NetworkState::SafeOp);
            startWaiting(now);
            break;
        case NetworkState::SafeOp:
            supervise(reading, AlState::SafeOp);
            if (state_ == NetworkState::SafeOp) waitForOp(now, reading);
            break;
        case NetworkState::GoingOp:
            if (!underWay()) climbed(NetworkState::Op);
            break;
        case NetworkState::Op:
            supervise(reading, AlState::Op);
            if (opWanted_) recover();
            break;
        case NetworkState::GoingDown:
            goDown();
            break;
    }
    if (state_ != NetworkState::Op || asked_ || !allWell_) updateHealth();
}

// --- transitions
// --------------------------------------------------------------------------------

void NetworkWalk::begin(Transition transition, ScriptOf script, AlState atLeast) noexcept {
    transition_ = transition;
    script_ = script;
    atLeast_ = atLeast;
    // What comes before the way to SAFEOP has been done in bring-up.
    const bool nothingBefore = transition == Transition::PreOpToSafeOp ||
                               common_.before[static_cast<std::size_t>(transition)].empty();
    stage_ = nothingBefore ? Stage::Slaves : Stage::Before;
    startStage();
    static_cast<void>(underWay());
}

void NetworkWalk::startStage() noexcept {
    const auto number = static_cast<std::size_t>(transition_);
    switch (stage_) {
        case Stage::Before:
            everyone_.run(common_.before[number]);
            break;
        case Stage::Slaves:
            for (std::size_t i = 0; i < agents_.size(); ++i) {
                if (agents_[i]->al().state >= atLeast_) agents_[i]->run(scripts_[i].*script_);
            }
            break;
        case Stage::After:
            everyone_.run(common_.after[number]);
            break;
        case Stage::Over:
            break;
    }
}

bool NetworkWalk::underWay() noexcept {
    while (stage_ != Stage::Over) {
        if (anyRunning()) return true;
        const bool slavesFailed =
            std::any_of(agents_.begin(), agents_.end(), [](const auto& agent) {
                return agent->scriptState() == SlaveAgent::ScriptState::Failed;
            });
        // Going down, a slave that refuses or is gone does not hold up the others.
        const bool up = state_ != NetworkState::GoingDown;
        const bool failed =
            everyone_.scriptState() == SlaveAgent::ScriptState::Failed || slavesFailed;
        stage_ = up && failed ? Stage::Over : static_cast<Stage>(static_cast<unsigned>(stage_) + 1);
        startStage();
    }
    return false;
}

bool NetworkWalk::anyRunning() const noexcept {
    if (everyone_.scriptState() == SlaveAgent::ScriptState::Running) return true;
    return std::any_of(agents_.begin(), agents_.end(), [](const auto& agent) {
        return agent->scriptState() == SlaveAgent::ScriptState::Running;
    });
}

void NetworkWalk::fail(const NetworkProblem& problem) noexcept {
    problem_ = problem;
    problem_.cycle = cycle_;
    state_ = NetworkState::Failed;
}

bool NetworkWalk::blameFailed() noexcept {
    if (blame(everyone_, NetworkProblem::NoSlave)) return true;
    for (std::size_t i = 0; i < agents_.size(); ++i) {
        if (blame(*agents_[i], static_cast<std::uint16_t>(i))) return true;
    }
    return false;
}

bool NetworkWalk::blame(const SlaveAgent& agent, std::uint16_t slave) noexcept {
    if (agent.scriptState() != SlaveAgent::ScriptState::Failed) return false;
    const ScriptFailure& failure = agent.failure();
    NetworkProblem problem;
    problem.slave = slave;
    problem.wanted = failure.target;
    problem.seen = failure.seen.state;
    problem.alStatusCode = failure.seen.code;
    switch (failure.kind) {
        case ScriptFailure::Kind::StateRefused:
            problem.kind = NetworkProblem::Kind::StateRefused;
            break;
        case ScriptFailure::Kind::StateTimedOut:
            problem.kind = NetworkProblem::Kind::StateTimedOut;
            break;
        case ScriptFailure::Kind::ObjectAborted:
            problem.kind = NetworkProblem::Kind::ObjectRefused;
            problem.item = failure.address;
            problem.number = failure.abortCode;
            break;
        case ScriptFailure::Kind::CommandUnanswered:
        case ScriptFailure::Kind::CommandMismatch:
            problem.kind = failure.kind == ScriptFailure::Kind::CommandMismatch
                               ? NetworkProblem::Kind::CommandMismatch
                               : NetworkProblem::Kind::CommandUnanswered;
            problem.number = failure.number;
            if (const auto* step = std::get_if<CommandStep>(agent.failedStep())) {
                problem.item = static_cast<std::uint32_t>(step->number);
            }
            break;
        case ScriptFailure::Kind::None:
        case ScriptFailure::Kind::RegisterSilent:
        case ScriptFailure::Kind::StateSilent:
            problem.kind = NetworkProblem::Kind::Silent;
            break;
    }
    fail(problem);
    return true;
}

void NetworkWalk::climbed(NetworkState reached) noexcept {
    if (blameFailed()) return;
    state_ = reached;
    asked_ = allWell_ = false;
    if (reached == NetworkState::Op) opWanted_ = false;
}

// --- SAFEOP to OP
// ----------------------------------------------------------------------------------------

void NetworkWalk::startWaiting(core::HostTime now) noexcept {
    waitUntil_ = now + ReadyTimeout;
    goodInRow_ = quietRounds_ = 0;
    for (std::size_t i = 0; i < agents_.size(); ++i) {
        if (network_.slaves[i].dc.enabled) agents_[i]->wantDifference();
    }
}

/// One round of 0x092C reads after the other; all must stay below the limit.
bool NetworkWalk::clocksQuiet() noexcept {
    bool complete = true;
    bool below = true;
    for (std::size_t i = 0; i < agents_.size(); ++i) {
        if (!network_.slaves[i].dc.enabled || i == reference_) continue;
        const auto& difference = agents_[i]->difference();
        complete = complete && !agents_[i]->differencePending();
        below = below && difference && *difference < network_.dcLimit;
    }
    if (!complete) return false;
    if (quietRounds_ < QuietRoundsBeforeOp) quietRounds_ = below ? quietRounds_ + 1 : 0;
    const bool quiet = quietRounds_ >= QuietRoundsBeforeOp;
    if (!quiet) {
        for (std::size_t i = 0; i < agents_.size(); ++i) {
            if (network_.slaves[i].dc.enabled) agents_[i]->wantDifference();
        }
    }
    return quiet;
}

void NetworkWalk::waitForOp(core::HostTime now, const BusReading& reading) noexcept {
    const bool counters = goodInRow_ >= GoodCyclesBeforeOp;
    const bool clocks = !reading.hasReference || (clocksQuiet() && reading.clockLocked);
    if (counters && clocks) {
        state_ = NetworkState::GoingOp;
        begin(Transition::SafeOpToOp, &SlaveScripts::toOp, AlState::None);
    } else if (now > waitUntil_) {
        fail(whyNotReady(reading));
    }
}

NetworkProblem NetworkWalk::whyNotReady(const BusReading& reading) const noexcept {
    NetworkProblem problem;
    problem.wanted = AlState::Op;
    problem.seen = AlState::SafeOp;
    if (goodInRow_ < GoodCyclesBeforeOp) {
        problem.kind = NetworkProblem::Kind::WorkingCounter;
        return problem;
    }
    problem.kind = NetworkProblem::Kind::ClockNotLocked;
    if (quietRounds_ >= QuietRoundsBeforeOp || !reading.hasReference) return problem;
    problem.kind = NetworkProblem::Kind::DeviceClock;
    for (std::size_t i = 0; i < agents_.size(); ++i) {
        const core::Duration difference = agents_[i]->difference().value_or(core::Duration{0});
        if (i == reference_ || difference.count() <= problem.number) continue;
        problem.number = difference.count();
        problem.slave = static_cast<std::uint16_t>(i);
    }
    return problem;
}

// --- watching
// --------------------------------------------------------------------------------------------

void NetworkWalk::supervise(const BusReading& reading, AlState expected) noexcept {
    const bool oddStatus =
        reading.statusArrived && (reading.status != static_cast<std::uint16_t>(expected) ||
                                  reading.statusCounter != agents_.size());
    ++sinceStatus_;
    if (oddStatus || data_.wrongCounter() || !allWell_) {
        if (!asked_ || sinceStatus_ >= StatusGap) {
            for (const auto& agent : agents_) agent->wantStatus();
            asked_ = true;
            sinceStatus_ = 0;
        }
        noteFallen(expected);
    } else {
        asked_ = false;
    }
}

void NetworkWalk::noteFallen(AlState expected) noexcept {
    bool all = true;
    for (std::size_t i = 0; i < agents_.size(); ++i) {
        const SlaveAgent& agent = *agents_[i];
        if (agent.statusPending()) {
            all = false;
            continue;
        }
        const AlReading& al = agent.al();
        if (agent.answers() && al.state == expected && !al.error) continue;
        all = false;
        if (problem_.slave == i && problem_.alStatusCode == al.code && problem_.seen == al.state) {
            continue;
        }
        problem_ = {agent.answers() ? NetworkProblem::Kind::FellBack : NetworkProblem::Kind::Silent,
                    static_cast<std::uint16_t>(i),
                    expected,
                    al.state,
                    al.code,
                    0,
                    0,
                    cycle_};
        if (expected != AlState::Op) fail(problem_);
    }
    allWell_ = all;
}

void NetworkWalk::updateHealth() noexcept {
    for (std::size_t i = 0; i < agents_.size(); ++i) {
        const SlaveAgent& agent = *agents_[i];
        const AlReading& al = agent.al();
        data_.setOperational(i, agent.answers() && al.state == AlState::Op && !al.error, al.code);
    }
}

void NetworkWalk::recover() noexcept {
    opWanted_ = false;
    for (std::size_t i = 0; i < agents_.size(); ++i) {
        if (!data_.health(i).operational) agents_[i]->run(scripts_[i].recover);
    }
}

// --- down
// ------------------------------------------------------------------------------------------------

void NetworkWalk::startDown() noexcept {
    initWanted_ = opWanted_ = false;
    if (state_ == NetworkState::Off || state_ == NetworkState::Init ||
        state_ == NetworkState::GoingDown) {
        return;
    }
    downStage_ = 0;
    state_ = NetworkState::GoingDown;
    begin(Transition::OpToSafeOp, &SlaveScripts::backToSafeOp, AlState::Op);
}

void NetworkWalk::goDown() noexcept {
    if (underWay()) return;
    ++downStage_;
    if (downStage_ == 1) {
        begin(Transition::SafeOpToPreOp, &SlaveScripts::backToPreOp, AlState::SafeOp);
    } else if (downStage_ == 2) {
        begin(Transition::PreOpToInit, &SlaveScripts::backToInit, AlState::None);
    } else {
        state_ = NetworkState::Init;
    }
}

}  // namespace takt::fieldbus::ethercat
