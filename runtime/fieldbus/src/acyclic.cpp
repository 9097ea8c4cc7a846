#include "acyclic.hpp"

#include <algorithm>

namespace takt::fieldbus::ethercat {

bool AcyclicSlice::add(FrameSet& frames, std::size_t machine, const Request& request,
                       std::size_t& budget) noexcept {
    const std::size_t bytes = wire::DatagramOverhead + request.length;
    if (bytes > budget || frames.full()) return false;
    if (request.length > frames.room() || frames.room() == 0) {
        // One frame more at most: fill() is called with one frame left.
        if (!frames.openFrame() || request.length > frames.room()) return false;
    }
    const DatagramId id = frames.append(request.command, request.adp, request.ado, request.length);
    std::copy(request.data.begin(), request.data.end(), frames.data(id).begin());
    waiting_.push_back({static_cast<std::uint16_t>(machine), id});
    budget -= bytes;
    return true;
}

void AcyclicSlice::fill(FrameSet& frames, std::span<AcyclicMachine* const> machines,
                        std::size_t budget, core::HostTime now) noexcept {
    waiting_.clear();
    if (work_.empty()) return;
    const std::size_t start = start_;
    // From where the last slice was full to the end, then from the beginning.
    for (const bool wrapped : {false, true}) {
        std::size_t i = work_.firstFrom(wrapped ? 0 : start);
        for (; i != WorkSet::none() && !(wrapped && i >= start); i = work_.firstFrom(i + 1)) {
            Request request;
            if (!machines[i]->next(now, request)) {
                if (!machines[i]->busy()) work_.clear(i);
                continue;
            }
            if (waiting_.size() == waiting_.capacity() || !add(frames, i, request, budget)) {
                start_ = i;
                return;
            }
        }
    }
    start_ = 0;
}

void AcyclicSlice::deliver(const FrameSet& frames, std::span<AcyclicMachine* const> machines,
                           core::HostTime now) noexcept {
    for (const Waiting& waiting : waiting_) {
        AcyclicMachine& machine = *machines[waiting.machine];
        machine.take(now, frames.reply(waiting.datagram));
        if (!machine.busy()) work_.clear(waiting.machine);
    }
    waiting_.clear();
}

}  // namespace takt::fieldbus::ethercat
