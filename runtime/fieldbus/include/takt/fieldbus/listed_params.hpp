#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <takt/core/time.hpp>
#include <vector>

/// A network whose start-up and cycle are listed command by command, as an ENI file (ETG.2100) does
/// it, instead of being worked out by the master.
namespace takt::fieldbus {

/// The steps between two AL states that the master takes.
enum class Transition : std::uint8_t {
    InitToPreOp,
    PreOpToSafeOp,
    SafeOpToOp,
    OpToSafeOp,
    SafeOpToPreOp,
    PreOpToInit,
};
inline constexpr std::size_t TransitionCount = 6;

/// A set of transitions.
class Transitions {
public:
    constexpr Transitions() noexcept = default;
    constexpr void add(Transition transition) noexcept {
        bits_ = static_cast<std::uint8_t>(bits_ | 1U << static_cast<unsigned>(transition));
    }
    [[nodiscard]] constexpr bool has(Transition transition) const noexcept {
        return (bits_ & 1U << static_cast<unsigned>(transition)) != 0;
    }
    [[nodiscard]] constexpr bool empty() const noexcept { return bits_ == 0; }

private:
    std::uint8_t bits_{0};
};

/// What a listed read must bring: it is repeated until (received & mask) == data or time is over.
struct ListedValidation {
    std::vector<std::uint8_t> data;
    std::vector<std::uint8_t> mask;  ///< of the same length
    core::Duration timeout{0};
};

/// One datagram of a transition.
struct ListedCommand {
    Transitions transitions;
    std::uint8_t command{0};  ///< number of ETG.1000.4 table 9, 1 to 14
    std::uint16_t adp{0};     ///< low half of the address where it is logical
    std::uint16_t ado{0};
    std::vector<std::uint8_t> data;               ///< sent; its length is that of the datagram
    std::optional<std::uint16_t> workingCounter;  ///< empty: not checked
    std::uint32_t retries{0};                     ///< after a wrong working counter
    std::optional<ListedValidation> validation;
    bool beforeSlaves{false};  ///< of commands to all devices: before the devices' own
    std::string comment;
    std::string origin;  ///< "machine.eni.xml:31"
};

/// An object to be written by CoE in a transition, while the device is in the lower or, on the way
/// up from INIT, in the upper state.
struct ListedObject {
    Transitions transitions;
    std::uint16_t index{0};
    std::uint8_t subindex{0};
    bool completeAccess{false};
    std::vector<std::uint8_t> data;
    std::string origin;
};

/// Bits of the process image, seen from the master.
struct ListedRange {
    std::uint32_t firstBit{0};
    std::uint32_t bits{0};
};

struct ListedSlave {
    std::uint16_t station{0};
    std::vector<ListedCommand> commands;  ///< in file order
    std::vector<ListedObject> objects;
    std::optional<std::uint16_t> mailboxStateBit;  ///< inside the mailbox state area
    ListedRange outputs;
    ListedRange inputs;
};

/// One datagram of every cycle.
struct CyclicCommand {
    enum class Kind : std::uint8_t {
        ReferenceTime,  ///< hands the time of the reference clock round
        ProcessData,
        MailboxStates,
        AlStatus,
        Other,  ///< sent, its reply is looked at by nobody
    };

    Kind kind{Kind::Other};
    std::uint8_t command{0};
    std::uint32_t address{0};  ///< logical, or position/station in the low half
    std::uint16_t length{0};
    std::uint16_t workingCounter{0};  ///< of process data
    bool inPreOp{false};              ///< states in which it is sent
    bool inSafeOp{false};
    bool inOp{false};
    std::uint32_t inputOffset{0};  ///< bytes into the process image
    std::uint32_t outputOffset{0};
};

/// The part that concerns all devices.
struct ListedNetwork {
    std::vector<ListedCommand> commands;
    std::vector<std::vector<CyclicCommand>> frames;
    std::uint32_t outputBytes{0};  ///< of the process image
    std::uint32_t inputBytes{0};
};

}  // namespace takt::fieldbus
