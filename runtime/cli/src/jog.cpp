#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <stdexcept>

#include "remote.hpp"
#include "terminal.hpp"

namespace takt::cli {

namespace {

using namespace std::chrono_literals;

/// Well within the 100 ms after which the machine stops by itself.
constexpr auto HeartbeatEvery = 25ms;

/// Distances that can be chosen with up and down; the one given stands among them.
std::vector<double> stepsAround(double distance) {
    std::vector<double> steps{0.001, 0.01, 0.1, 1.0, 10.0, distance};
    std::sort(steps.begin(), steps.end());
    steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
    return steps;
}

class Jog {
public:
    Jog(const JogOptions& options, Remote& remote) : options_{options}, remote_{remote} {
        steps_ = stepsAround(options.distance);
        step_ = static_cast<std::size_t>(std::find(steps_.begin(), steps_.end(), options.distance) -
                                         steps_.begin());
    }

    /// \return the unit of the axis. \throw std::runtime_error when there is no such axis
    void find() {
        const auto status = remote_.status();
        look(status);
        unit_ = axis_.unit;
        if (unit_.empty())
            throw std::runtime_error{fmt::format("there is no axis '{}'", options_.axis)};
    }

    void run() {
        Terminal terminal;
        fmt::print(
            "axis {}: left/right (or - +) moves one step, up/down changes the step, space stops, q "
            "ends\r\n",
            options_.axis);
        for (;;) {
            if (const auto key = terminal.key(HeartbeatEvery)) {
                if (*key == Key::Quit) break;
                press(*key);
            }
            remote_.heartbeat();
            ask();
            while (const auto reply = remote_.receive(0ms)) take(*reply);
        }
        send("halt", 0.0);
        fmt::print("\r\n");
    }

private:
    void press(Key key) {
        switch (key) {
            case Key::Left:
                return inch(-steps_[step_]);
            case Key::Right:
                return inch(steps_[step_]);
            case Key::Up:
                step_ = std::min(step_ + 1, steps_.size() - 1);
                return;
            case Key::Down:
                step_ = step_ == 0 ? 0 : step_ - 1;
                return;
            case Key::Space:
                return static_cast<void>(send("halt", 0.0));
            case Key::Other:
            case Key::Quit:
                return;
        }
    }

    /// A held key repeats: while a step is under way no other is asked for.
    void inch(double distance) {
        if (inch_ != 0) return;
        note_.clear();
        inch_ = send("inch", distance);
        show();
    }

    std::uint64_t send(const char* verb, double distance) {
        daemon::ControlRequest request;
        request.verb = verb;
        request.axis = options_.axis;
        request.distance = distance;
        request.velocity = options_.velocity;
        return remote_.send(std::move(request));
    }

    void ask() {
        if (asked_) return;
        daemon::ControlRequest request;
        request.verb = "status";
        remote_.send(std::move(request));
        asked_ = true;
    }

    void take(const daemon::ControlReply& reply) {
        const bool over = reply.kind != daemon::ReplyKind::Accepted;
        if (reply.id == inch_ && over) inch_ = 0;
        if (!reply.error.empty()) note_ = reply.error;
        if (!reply.status) return;
        asked_ = false;
        look(*reply.status);
        show();
    }

    void look(const daemon::StatusReport& status) {
        machineStop_ = status.machineStop;
        for (const auto& axis : status.axes) {
            if (axis.name == options_.axis) axis_ = axis;
        }
    }

    void show() const {
        std::string note = note_;
        if (inch_ != 0) note = "under way";  // other keys than the space bar wait for its end
        if (!machineStop_.empty()) note = "MACHINE STOP by " + machineStop_;
        if (!axis_.error.empty()) note = axis_.error;
        fmt::print("\r\033[K{} {:12.4f} {}  {:<16} step {:g} {} at {:g} {}/s  {}", axis_.name,
                   axis_.actual, unit_, axis_.state, steps_[step_], unit_, options_.velocity, unit_,
                   note);
        std::fflush(stdout);
    }

    const JogOptions& options_;
    Remote& remote_;
    std::vector<double> steps_;
    std::size_t step_{0};
    std::string unit_;
    std::string note_;
    daemon::AxisReport axis_;  ///< as it was last seen
    std::string machineStop_;
    std::uint64_t inch_{0};  ///< request under way
    bool asked_{false};
};

}  // namespace

int runJog(const JogOptions& options) {
    try {
        Remote remote{options.remote, "takt jog " + options.axis};
        Jog jog{options, remote};
        jog.find();
        jog.run();
        return 0;
    } catch (const std::exception& error) {
        return noMachine(error.what());
    }
}

}  // namespace takt::cli
