#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <takt/core/time.hpp>
#include <takt/wire/mailbox.hpp>
#include <vector>

#include "acyclic.hpp"

namespace takt::fieldbus::ethercat {

struct MailboxPlace {
    std::uint8_t outManager{0};  ///< SyncManager number, master to device
    std::uint8_t inManager{1};
    std::uint16_t outStart{0};
    std::uint16_t outSize{0};
    std::uint16_t inStart{0};
    std::uint16_t inSize{0};
};

/// A message taken out of the input box; valid until the next one is read.
struct MailboxMessage {
    wire::mbx::Type type{wire::mbx::Type::Error};
    std::span<const std::uint8_t> body{};  ///< behind the six header bytes
};

/// The mailbox of one slave (ETG.1000.4 clause 6.6): posts one message at a time, fetches what the
/// slave has put out, repeats what was lost on the way. It knows nothing of the protocols inside.
class Mailbox {
public:
    explicit Mailbox(const MailboxPlace& place);

    /// rt. Forgets counters and messages, as both sides do in INIT.
    void reset() noexcept;
    /// rt. Room for the body of a message to post. \pre !posting()
    [[nodiscard]] std::span<std::uint8_t> body() noexcept;
    /// rt. Posts the first `length` bytes of body(). \pre !posting()
    void post(wire::mbx::Type type, std::size_t length) noexcept;
    /// rt. The posted message has not been taken by the slave yet.
    [[nodiscard]] bool posting() const noexcept { return posting_; }
    /// rt. Gives up a message that the slave does not take.
    void withdraw() noexcept { posting_ = false; }
    /// rt. Looks for an answer until told otherwise.
    void expect(bool answer) noexcept { expecting_ = answer; }
    /// rt. Something may lie in the input box: look once.
    void look() noexcept;
    /// rt. The input box is known to be full.
    void fetch() noexcept;

    bool next(core::HostTime now, std::uint16_t station, Request& request) noexcept;
    /// rt. \return true when `message` was filled
    bool take(core::HostTime now, const Reply& reply, MailboxMessage& message) noexcept;
    [[nodiscard]] bool busy() const noexcept {
        return posting_ || expecting_ || lookOnce_ || fetching();
    }

private:
    enum class Phase : std::uint8_t { Idle, Post, Look, Fetch, AskRepeat, AwaitRepeat };

    [[nodiscard]] bool fetching() const noexcept {
        return phase_ == Phase::Fetch || phase_ == Phase::AskRepeat || phase_ == Phase::AwaitRepeat;
    }
    void settle() noexcept;
    bool takeFetched(const Reply& reply, MailboxMessage& message) noexcept;
    void takeRepeat(core::HostTime now, const Reply& reply) noexcept;

    MailboxPlace place_;
    std::vector<std::uint8_t> out_;
    std::vector<std::uint8_t> in_;
    Phase phase_{Phase::Idle};
    Phase asked_{Phase::Idle};  ///< what the datagram on its way is for
    bool posting_{false};
    bool expecting_{false};
    bool lookOnce_{false};
    bool outTurn_{true};  ///< posting and looking take turns while the output box is full
    std::uint8_t outCounter_{0};
    std::uint8_t inCounter_{0};
    std::uint8_t toggle_{0};
    std::uint8_t repeatTries_{0};
    std::uint8_t activate_{1};
    core::HostTime lookAt_{};
};

}  // namespace takt::fieldbus::ethercat
