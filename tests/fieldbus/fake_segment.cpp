#include "fake_segment.hpp"

#include <algorithm>
#include <takt/core/cycle_guard.hpp>

namespace takt::test {

namespace {

using wire::Command;

std::uint16_t get16(std::span<const std::uint8_t> b, std::size_t at) {
    return static_cast<std::uint16_t>(b[at] + 256 * b[at + 1]);
}
std::uint32_t get32(std::span<const std::uint8_t> b, std::size_t at) {
    return get16(b, at) + 65536U * get16(b, at + 2);
}
void put(std::span<std::uint8_t> b, std::size_t at, std::uint64_t value, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i) {
        b[at + i] = static_cast<std::uint8_t>(value);
        value /= 256;
    }
}

constexpr std::uint64_t HopDelay = 300;

}  // namespace

FakeDevice::FakeDevice(const wire::DeviceDescription& device) {
    memory[0x0004] = device.fmmuCount;
    memory[0x0005] = device.syncManagerCount;
    put(memory, 0x0008, device.lrwSupported ? 0x000C : 0x020C, 2);
    put(memory, 0x0110, 0x5A33, 2);  // ports 0 and 1 open, 2 and 3 closed
    put(memory, 0x0130, 1, 2);
    eeprom[8] = device.identity.vendor;
    eeprom[10] = device.identity.product;
    eeprom[12] = device.identity.revision;
    eeprom[14] = device.identity.serial;
    for (const auto& manager : device.syncManagers) {
        if (manager.use == wire::SyncManagerUse::MailboxOut) {
            mailboxOut = manager.start;
            mailboxOutSize = manager.defaultSize;
        }
        if (manager.use == wire::SyncManagerUse::MailboxIn) {
            mailboxIn = manager.start;
            mailboxInSize = manager.defaultSize;
        }
    }
    eeprom[24] = mailboxOut + 65536U * mailboxOutSize;
    eeprom[26] = mailboxIn + 65536U * mailboxInSize;
    eeprom[28] = 4;
}

void FakeDevice::state(std::uint8_t al, std::uint16_t code) {
    put(memory, 0x0130, al, 2);
    put(memory, 0x0134, code, 2);
}

void FakeDevice::emergency(std::uint16_t errorCode) {
    std::vector<std::uint8_t> message(mailboxInSize, 0);
    ownCounter = static_cast<std::uint8_t>(ownCounter % 7 + 1);
    put(message, 0, 10, 2);
    message[5] = static_cast<std::uint8_t>(3 + 16 * ownCounter);
    put(message, 6, 0x1000, 2);
    put(message, 8, errorCode, 2);
    message[10] = 0x81;
    message[11] = 0xAA;
    pending.push_back(message);
}

wire::LinkStatus FakeSegment::send(std::span<wire::Frame> frames) noexcept {
    const core::CycleGuardPause outside;
    if (down) return wire::LinkStatus::Down;
    for (wire::Frame& frame : frames) {
        frame.stamp = clock_.now();
        if (onSend) onSend(frame);
        const std::uint64_t number = frameNumber++;
        wire::Frame reply = frame;
        process(reply);
        if (lose.contains(number)) continue;
        if (onReply && !onReply(reply, number)) continue;
        replies.push_back(reply);
    }
    return wire::LinkStatus::Ok;
}

std::size_t FakeSegment::receive(std::span<wire::Frame> slots, core::HostTime deadline) noexcept {
    const core::CycleGuardPause outside;
    std::size_t got = 0;
    while (got < slots.size() && !replies.empty()) {
        slots[got] = replies.front();
        slots[got].stamp = clock_.now();
        replies.pop_front();
        ++got;
    }
    if (got == slots.size()) {
        clock_.sleepUntil(clock_.now() + std::chrono::microseconds{20});
    } else {
        clock_.sleepUntil(deadline);
    }
    return got;
}

void FakeSegment::process(wire::Frame& frame) {
    if (!devices.empty()) frame.bytes[6] |= wire::SourceSeenBit;
    wire::DatagramCursor cursor{frame.view()};
    while (cursor.next()) processDatagram(cursor.datagram());
}

void FakeSegment::processDatagram(const wire::DatagramView& datagram) {
    const auto command = static_cast<Command>(datagram.rawCommand());
    unsigned counter = datagram.workingCounter();
    const std::vector<std::uint8_t> sent(datagram.data().begin(), datagram.data().end());
    const auto now = static_cast<std::uint64_t>(clock_.now().time_since_epoch().count());
    bool referencePassed = false;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        FakeDevice& device = devices[i];
        if (device.dead) continue;
        const std::uint16_t adp = datagram.adp();
        const bool here = get16(device.memory, 0x0010) == adp;
        const std::uint64_t local = now + i * HopDelay;
        put(device.memory, 0x0910,
            local + get32(device.memory, 0x0920) +
                (static_cast<std::uint64_t>(get32(device.memory, 0x0924)) << 32) -
                get32(device.memory, 0x0928),
            8);
        bool served = false;
        switch (command) {
            case Command::Aprd:
            case Command::Apwr:
                if (adp == 0) {
                    const bool write = command == Command::Apwr;
                    served = access(device, datagram.ado(), datagram.data(), !write, write, false);
                }
                datagram.setAdp(static_cast<std::uint16_t>(adp + 1));
                break;
            case Command::Fprd:
                served =
                    here && access(device, datagram.ado(), datagram.data(), true, false, false);
                break;
            case Command::Fpwr:
                served =
                    here && access(device, datagram.ado(), datagram.data(), false, true, false);
                break;
            case Command::Brd:
                served = access(device, datagram.ado(), datagram.data(), true, false, true);
                datagram.setAdp(static_cast<std::uint16_t>(adp + 1));
                break;
            case Command::Bwr:
                served = access(device, datagram.ado(), datagram.data(), false, true, false);
                if (datagram.ado() == 0x0900) {
                    const std::uint64_t last = devices.size() - 1;
                    put(device.memory, 0x0900, local, 4);
                    put(device.memory, 0x0904, local + 2 * HopDelay * (last - i), 4);
                    put(device.memory, 0x0918, local, 8);
                    put(device.memory, 0x0110, i == last ? 0x5613 : 0x5A33, 2);
                }
                datagram.setAdp(static_cast<std::uint16_t>(adp + 1));
                break;
            case Command::Frmw:
                served = true;
                if (here) {
                    std::copy_n(device.memory.begin() + datagram.ado(), datagram.data().size(),
                                datagram.data().begin());
                    referencePassed = true;
                }
                (void)referencePassed;
                break;
            case Command::Lrw: {
                const bool read =
                    logical(device, datagram.logicalAddress(), datagram.data(), sent, 1);
                const bool write =
                    !device.refusesOutputs &&
                    logical(device, datagram.logicalAddress(), datagram.data(), sent, 2);
                counter += (read ? 1U : 0U) + (write ? 2U : 0U);
                break;
            }
            case Command::Lrd:
                served = logical(device, datagram.logicalAddress(), datagram.data(), sent, 1);
                break;
            case Command::Lwr:
                served = logical(device, datagram.logicalAddress(), datagram.data(), sent, 2);
                break;
            default:
                break;
        }
        if (served) ++counter;
    }
    datagram.setWorkingCounter(static_cast<std::uint16_t>(counter));
}

bool FakeSegment::access(FakeDevice& device, std::uint16_t at, std::span<std::uint8_t> data,
                         bool read, bool write, bool orIn) {
    const bool mail = (get16(device.memory, 0x0130) & 0x0F) >= 2;
    if (mail && at == device.mailboxOut && write) {
        std::copy(data.begin(), data.end(), device.memory.begin() + at);
        mailPosted(device);
        return true;
    }
    if (mail && at == device.mailboxIn && read) {
        if ((device.memory[0x080D] & 0x08) == 0) return false;
        std::copy_n(device.memory.begin() + at, data.size(), data.begin());
        device.memory[0x080D] = 0;
        refillBox(device);
        return true;
    }
    if (mail) refillBox(device);
    for (std::size_t i = 0; i < data.size(); ++i) {
        std::uint8_t& byte = device.memory[at + i];
        const std::uint8_t before = byte;
        if (write && at + i != 0x0130) byte = data[i];
        if (read) data[i] = static_cast<std::uint8_t>(orIn ? data[i] | before : before);
    }
    if (write) registerWritten(device, at, data.size());
    return true;
}

void FakeSegment::registerWritten(FakeDevice& device, std::uint16_t at, std::size_t length) {
    if (at == 0x0120 && length >= 2) {
        const std::uint16_t wanted = get16(device.memory, 0x0120);
        device.stateRequests.push_back(wanted);
        const auto target = static_cast<std::uint8_t>(wanted & 0x0F);
        const auto refusal = device.refusals.find(target);
        const std::uint16_t current = get16(device.memory, 0x0130) & 0x0F;
        if ((wanted & 0x10) == 0 && refusal != device.refusals.end()) {
            device.state(static_cast<std::uint8_t>(current | 0x10), refusal->second);
        } else {
            device.state(target, 0);
        }
    }
    if (at == 0x0502 && length == 6) {
        put(device.memory, 0x0508, device.eeprom[get16(device.memory, 0x0504)], 4);
        device.memory[0x0503] = 0;
    }
    if (at == 0x080E) {
        // Repeat request: put the last message out again and acknowledge.
        if ((device.memory[0x080E] & 2) != (device.memory[0x080F] & 2) &&
            !device.lastMessage.empty()) {
            std::copy(device.lastMessage.begin(), device.lastMessage.end(),
                      device.memory.begin() + device.mailboxIn);
            device.memory[0x080D] = 0x08;
        }
        device.memory[0x080F] = device.memory[0x080E] & 2;
    }
}

void FakeSegment::mailPosted(FakeDevice& device) {
    ++device.receivedMail;
    if (device.mailboxSilent) return;
    const std::uint8_t* mail = &device.memory[device.mailboxOut];
    const std::span<const std::uint8_t> box{mail, device.mailboxOutSize};
    const std::uint8_t counter = box[5] >> 4;
    if (counter != 0 && counter == device.lastCounter) return;
    device.lastCounter = counter;
    const std::uint32_t key = get16(box, 9) * 256U + box[11];
    std::vector<std::uint8_t> answer(device.mailboxInSize, 0);
    device.ownCounter = static_cast<std::uint8_t>(device.ownCounter % 7 + 1);
    put(answer, 0, 10, 2);
    answer[5] = static_cast<std::uint8_t>(3 + 16 * device.ownCounter);
    put(answer, 6, 0x3000, 2);
    std::copy_n(mail + 9, 3, answer.begin() + 9);
    const std::uint8_t command = box[8];
    const bool download = (command & 0xE0) == 0x20;
    if (const auto abort = device.aborts.find(key); abort != device.aborts.end()) {
        answer[8] = 0x80;
        put(answer, 12, abort->second, 4);
    } else if (download) {
        device.written.push_back(key);
        const bool expedited = (command & 0x02) != 0;
        const std::size_t size = expedited ? 4U - ((command >> 2) & 3U) : get32(box, 12);
        const std::uint8_t* data = mail + (expedited ? 12 : 16);
        device.objects[key].assign(data, data + size);
        answer[8] = 0x60;
    } else {
        const std::vector<std::uint8_t>& value = device.objects[key];
        if (value.size() <= 4) {
            answer[8] = static_cast<std::uint8_t>(0x43 + 4 * (4 - value.size()));
            std::copy(value.begin(), value.end(), answer.begin() + 12);
        } else {
            answer[8] = 0x41;
            put(answer, 0, 10 + value.size(), 2);
            put(answer, 12, value.size(), 4);
            std::copy(value.begin(), value.end(), answer.begin() + 16);
        }
    }
    device.pending.push_back(answer);
    refillBox(device);
}

void FakeSegment::refillBox(FakeDevice& device) {
    if ((device.memory[0x080D] & 0x08) != 0 || device.pending.empty()) return;
    device.lastMessage = device.pending.front();
    std::copy(device.lastMessage.begin(), device.lastMessage.end(),
              device.memory.begin() + device.mailboxIn);
    device.pending.pop_front();
    device.memory[0x080D] = 0x08;
}

bool FakeSegment::logical(FakeDevice& device, std::uint32_t address, std::span<std::uint8_t> data,
                          std::span<const std::uint8_t> sent, std::uint8_t type) {
    bool hit = false;
    for (std::size_t n = 0; n < 4; ++n) {
        const std::span<const std::uint8_t> fmmu{&device.memory[0x0600 + 16 * n], 16};
        if (fmmu[12] != 1 || fmmu[11] != type) continue;
        const std::uint32_t start = get32(fmmu, 0);
        const std::size_t length = get16(fmmu, 4);
        const std::uint16_t physical = get16(fmmu, 8);
        for (std::size_t i = 0; i < length; ++i) {
            const std::uint64_t at = std::uint64_t{start} + i;
            if (at < address || at >= std::uint64_t{address} + data.size()) continue;
            const std::size_t offset = at - address;
            if (fmmu[6] != 0 || fmmu[7] != 7) {  // one bit
                const unsigned bit = (device.memory[physical] >> fmmu[10]) & 1U;
                data[offset] =
                    static_cast<std::uint8_t>((data[offset] & ~(1U << fmmu[6])) | (bit << fmmu[6]));
            } else if (type == 1) {
                data[offset] = device.memory[physical + i];
            } else {
                device.memory[physical + i] = sent[offset];
            }
            hit = true;
        }
    }
    return hit;
}

}  // namespace takt::test
