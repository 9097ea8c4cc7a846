#include "process_data.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

namespace takt::fieldbus::ethercat {

ProcessData::ProcessData(const LogicalLayout& layout)
    : layout_{layout},
      buffers_(layout.groups.size()),
      health_(layout.slaves.size()),
      counters_(layout.groups.size()) {
    std::size_t outputs = 0;
    std::size_t inputs = 0;
    for (std::size_t i = 0; i < buffers_.size(); ++i) {
        const ProcessGroup& group = layout.groups[i];
        buffers_[i].outputs = outputs;
        buffers_[i].inputs = inputs;
        outputs += group.outputBytes;
        inputs += group.inputBytes;
        counters_[i].expected = group.lrw
                                    ? group.expectedLrw()
                                    : static_cast<std::uint16_t>(group.writers + group.readers);
    }
    outputs_.resize(outputs);
    inputs_.resize(inputs);
}

void ProcessData::reset() noexcept {
    std::fill(outputs_.begin(), outputs_.end(), std::uint8_t{0});
    std::fill(inputs_.begin(), inputs_.end(), std::uint8_t{0});
    std::fill(health_.begin(), health_.end(), core::DeviceHealth{});
    for (GroupCounters& counters : counters_) {
        counters.lastSeen = 0;
        counters.wrong = counters.lost = 0;
    }
    for (Buffers& buffers : buffers_) buffers.good = false;
    allGood_ = wrongCounter_ = false;
}

core::DeviceImage ProcessData::image(std::size_t slave) noexcept {
    const SlavePlace& place = layout_.slaves[slave];
    const Buffers& buffers = buffers_[place.group];
    return {std::span{inputs_}.subspan(buffers.inputs + place.inputOffset, place.inputBytes),
            std::span{outputs_}.subspan(buffers.outputs + place.outputOffset, place.outputBytes),
            &health_[slave]};
}

void ProcessData::setOperational(std::size_t slave, bool operational,
                                 std::uint16_t alCode) noexcept {
    health_[slave].operational = operational;
    health_[slave].alStatusCode = alCode;
}

void ProcessData::append(FrameSet& frames, std::size_t group) noexcept {
    const ProcessGroup& data = layout_.groups[group];
    Buffers& buffers = buffers_[group];
    // A datagram without data is not worth sending: nobody counts it, and nobody counts a NOP.
    const auto add = [&frames](wire::Command command, std::uint32_t address, std::size_t size) {
        return size == 0 ? frames.append(wire::Command::Nop, 0, 0, 1)
                         : frames.appendLogical(command, address, static_cast<std::uint16_t>(size));
    };
    const std::size_t both = std::size_t{data.outputBytes} + data.inputBytes;
    buffers.first = data.lrw ? add(wire::Command::Lrw, data.logical, both)
                             : add(wire::Command::Lwr, data.logical, data.outputBytes);
    if (!data.lrw) buffers.second = add(wire::Command::Lrd, data.inputLogical(), data.inputBytes);
}

void ProcessData::fill(FrameSet& frames) noexcept {
    for (std::size_t i = 0; i < buffers_.size(); ++i) {
        const std::size_t size = layout_.groups[i].outputBytes;
        if (size == 0) continue;
        std::memcpy(frames.data(buffers_[i].first).data(), &outputs_[buffers_[i].outputs], size);
    }
}

ProcessData::Outcome ProcessData::judge(const FrameSet& frames, std::size_t group) noexcept {
    const ProcessGroup& data = layout_.groups[group];
    const Buffers& buffers = buffers_[group];
    const Reply first = frames.reply(buffers.first);
    GroupCounters& counters = counters_[group];
    if (!first.arrived) return {};
    if (data.lrw) {
        counters.lastSeen = first.workingCounter;
        return {true, first.workingCounter == counters.expected,
                first.data.subspan(data.outputBytes, data.inputBytes)};
    }
    // Both datagrams travel in the same frame.
    const Reply second = frames.reply(buffers.second);
    counters.lastSeen = static_cast<std::uint16_t>(first.workingCounter + second.workingCounter);
    return {true, first.workingCounter == data.writers && second.workingCounter == data.readers,
            second.data.first(data.inputBytes)};
}

void ProcessData::take(const FrameSet& frames, bool supervised) noexcept {
    allGood_ = true;
    wrongCounter_ = false;
    for (std::size_t i = 0; i < buffers_.size(); ++i) {
        const Outcome outcome = judge(frames, i);
        if (outcome.right) {
            if (!outcome.inputs.empty()) {
                std::memcpy(&inputs_[buffers_[i].inputs], outcome.inputs.data(),
                            outcome.inputs.size());
            }
            if (!buffers_[i].good) markGood(i);
            continue;
        }
        allGood_ = false;
        if (!outcome.arrived) {
            ++counters_[i].lost;
        } else if (supervised) {
            wrongCounter_ = true;
            ++counters_[i].wrong;
        }
        markBad(i);
    }
}

void ProcessData::markGood(std::size_t group) noexcept {
    const ProcessGroup& data = layout_.groups[group];
    buffers_[group].good = true;
    for (std::size_t i = data.firstSlave; i < data.firstSlave + data.slaveCount; ++i) {
        health_[i].inputsFresh = true;
        health_[i].lostInRow = 0;
    }
}

void ProcessData::markBad(std::size_t group) noexcept {
    const ProcessGroup& data = layout_.groups[group];
    buffers_[group].good = false;
    for (std::size_t i = data.firstSlave; i < data.firstSlave + data.slaveCount; ++i) {
        health_[i].inputsFresh = false;
        if (health_[i].lostInRow != std::numeric_limits<std::uint32_t>::max()) {
            ++health_[i].lostInRow;
        }
    }
}

}  // namespace takt::fieldbus::ethercat
