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
                         std::vector<SlaveScripts>& scripts, ProcessData& data)
    : network_{network}, agents_{agents}, scripts_{scripts}, data_{data} {}

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
            runAll(&SlaveScripts::toSafeOp);
            state_ = NetworkState::GoingSafeOp;
            break;
        case NetworkState::GoingSafeOp:
            if (anyRunning()) break;
            climbed(NetworkState::SafeOp);
            startWaiting(now);
            break;
        case NetworkState::SafeOp:
            supervise(reading, AlState::SafeOp);
            if (state_ == NetworkState::SafeOp) waitForOp(now, reading);
            break;
        case NetworkState::GoingOp:
            if (!anyRunning()) climbed(NetworkState::Op);
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

void NetworkWalk::runAll(ScriptOf script) noexcept {
    for (std::size_t i = 0; i < agents_.size(); ++i) agents_[i]->run(scripts_[i].*script);
}

bool NetworkWalk::anyRunning() const noexcept {
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
    for (std::size_t i = 0; i < agents_.size(); ++i) {
        if (agents_[i]->scriptState() != SlaveAgent::ScriptState::Failed) continue;
        const ScriptFailure& failure = agents_[i]->failure();
        NetworkProblem problem;
        problem.slave = static_cast<std::uint16_t>(i);
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
            case ScriptFailure::Kind::None:
            case ScriptFailure::Kind::RegisterSilent:
            case ScriptFailure::Kind::ObjectAborted:
            case ScriptFailure::Kind::StateSilent:
                problem.kind = NetworkProblem::Kind::Silent;
                break;
        }
        fail(problem);
        return true;
    }
    return false;
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
        runAll(&SlaveScripts::toOp);
        state_ = NetworkState::GoingOp;
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
        if (!data_.health(i).operational) agents_[i]->run(scripts_[i].toOp);
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
    for (std::size_t i = 0; i < agents_.size(); ++i) {
        if (agents_[i]->al().state == AlState::Op) agents_[i]->run(scripts_[i].backToSafeOp);
    }
    downStage_ = 0;
    state_ = NetworkState::GoingDown;
}

/// A slave that refuses or is gone does not hold up the others.
void NetworkWalk::goDown() noexcept {
    if (anyRunning()) return;
    ++downStage_;
    if (downStage_ == 1) {
        for (std::size_t i = 0; i < agents_.size(); ++i) {
            const AlState state = agents_[i]->al().state;
            if (state == AlState::SafeOp || state == AlState::Op) {
                agents_[i]->run(scripts_[i].backToPreOp);
            }
        }
    } else if (downStage_ == 2) {
        runAll(&SlaveScripts::backToInit);
    } else {
        state_ = NetworkState::Init;
    }
}

}  // namespace takt::fieldbus::ethercat
