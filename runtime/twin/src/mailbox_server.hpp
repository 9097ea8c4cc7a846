#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <takt/core/fixed_vector.hpp>
#include <takt/wire/al_state.hpp>
#include <takt/wire/frame.hpp>

#include "coe_server.hpp"
#include "sync_managers.hpp"

namespace takt::twin {

/// What an emergency message tells (ETG.1000.6 clause 5.6.4).
struct Emergency {
    std::uint16_t code{0};
    std::uint8_t errorRegister{0};
    std::array<std::uint8_t, 5> data{};
};

/// The mailbox side of a device application (ETG.1000.6 clause 5.6.1): takes requests out of the
/// one SyncManager, puts answers into the other, keeps the last answer for a repeat request.
class MailboxServer {
public:
    MailboxServer(SyncManagers& syncManagers, CoeServer& coe, std::size_t outBox, std::size_t inBox)
        : syncManagers_{syncManagers}, coe_{coe}, outBox_{outBox}, inBox_{inBox} {}

    /// rt. Handles the request that lies in the box.
    void serve(wire::AlState state) noexcept;
    /// rt. The master has taken the last answer.
    void answerTaken() noexcept;
    /// rt. The master asks for the last answer again.
    void repeatLast() noexcept;
    /// rt. Sends a message that nobody asked for. Lost when too many wait.
    void send(const Emergency& emergency) noexcept;
    /// rt. Forgets everything, as at the way to PREOP.
    void reset() noexcept;

private:
    struct Message {
        std::array<std::uint8_t, wire::MaxDatagramData> bytes{};
        std::size_t size{0};
    };

    void handle(std::span<const std::uint8_t> request, wire::AlState state) noexcept;
    void handleCoe(std::span<const std::uint8_t> body, wire::AlState state) noexcept;
    void reply(std::uint8_t type, std::size_t length) noexcept;
    void replyError(std::uint16_t detail) noexcept;
    void post() noexcept;

    SyncManagers& syncManagers_;
    CoeServer& coe_;
    std::size_t outBox_;
    std::size_t inBox_;
    std::uint8_t lastRequest_{0};  ///< counter of the request before; 0 = none
    std::uint8_t counter_{0};      ///< of our own messages, 1 to 7
    std::uint16_t address_{0};     ///< of the originator, echoed
    Message building_;
    Message last_;  ///< the one in the box, or the last that was taken
    core::FixedVector<Message, 4> waiting_;
};

}  // namespace takt::twin
