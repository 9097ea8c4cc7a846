#pragma once

#include <cstddef>
#include <cstdint>
#include <takt/fieldbus/fieldbus_params.hpp>
#include <takt/wire/frame.hpp>
#include <vector>

#include "logical_layout.hpp"

namespace takt::fieldbus::ethercat {

/// States of the network in which a datagram is sent, as a set.
inline constexpr std::uint8_t SentInPreOp = 1;
inline constexpr std::uint8_t SentInSafeOp = 2;
inline constexpr std::uint8_t SentInOp = 4;
inline constexpr std::uint8_t SentAlways = 7;

/// One datagram of the cycle, and where its data come from and go to.
struct PlannedDatagram {
    CyclicCommand::Kind kind{CyclicCommand::Kind::Other};
    wire::Command command{wire::Command::Nop};
    std::uint32_t address{0};
    std::uint16_t length{0};
    std::uint16_t frame{0};
    std::uint8_t states{SentAlways};
    // Process data only.
    std::uint16_t group{0};
    std::uint16_t expected{0};     ///< working counter
    std::uint16_t outputBytes{0};  ///< from `outputAt` of the image to the front of the datagram
    std::uint32_t outputAt{0};
    std::uint16_t inputFrom{0};  ///< in the datagram
    std::uint16_t inputBytes{0};
    std::uint32_t inputAt{0};
};

/// Datagrams that give their inputs together or not at all, and are counted as one.
struct PlannedGroup {
    std::uint16_t first{0};  ///< of `datagrams`
    std::uint16_t count{0};
    std::uint16_t expected{0};
};

/// One slave's share of the process image, in bytes.
struct PlannedShare {
    std::uint32_t outputAt{0};
    std::uint32_t outputBytes{0};
    std::uint32_t inputAt{0};
    std::uint32_t inputBytes{0};
    std::uint16_t outputGroup{0};
    std::uint16_t inputGroup{0};
};

/// Everything that goes out in a cycle beside the acyclic slice. Made once, from the master's own
/// layout or from a list of commands; what runs in the cycle does not know which.
struct CyclePlan {
    std::vector<PlannedDatagram> datagrams;  ///< in sending order
    std::vector<PlannedGroup> groups;
    std::vector<PlannedShare> slaves;
    std::vector<std::uint16_t> mailboxSlave;  ///< slave of each mailbox state bit, or NoSlave
    std::uint32_t outputBytes{0};             ///< of the process image
    std::uint32_t inputBytes{0};
    bool byState{false};  ///< some datagrams are not sent in every state

    static constexpr std::uint16_t NoSlave = 0xFFFF;
    [[nodiscard]] std::size_t frames() const noexcept {
        return datagrams.empty() ? 0 : datagrams.back().frame + std::size_t{1};
    }
    /// Bytes of the datagrams of one frame, headers included.
    [[nodiscard]] std::size_t bytesOf(std::size_t frame) const noexcept;
};

/// `layout`: of the same network.
[[nodiscard]] CyclePlan makePlan(const NetworkParams& network, const LogicalLayout& layout);

}  // namespace takt::fieldbus::ethercat
