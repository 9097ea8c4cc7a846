#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <takt/core/fixed_vector.hpp>
#include <takt/core/object_access.hpp>
#include <takt/fieldbus/ethercat/object_user.hpp>
#include <takt/wire/device_description.hpp>

#include "acyclic.hpp"
#include "al_walker.hpp"
#include "coe_client.hpp"
#include "command_runner.hpp"
#include "mailbox.hpp"
#include "slave_script.hpp"

namespace takt::fieldbus::ethercat {

/// Why a script stopped; the numbers that explain it.
struct ScriptFailure {
    enum class Kind : std::uint8_t {
        None,
        RegisterSilent,
        ObjectAborted,
        StateRefused,
        StateTimedOut,
        StateSilent,
        CommandUnanswered,  ///< a listed command got no reply or a wrong working counter
        CommandMismatch,    ///< what it read is not what the list wants
    };

    Kind kind{Kind::None};
    std::uint16_t address{0};  ///< register or object index
    std::uint8_t subindex{0};
    std::uint32_t abortCode{0};
    wire::AlState target{wire::AlState::None};
    AlReading seen{};
    std::uint32_t number{0};  ///< working counter or first bytes that a listed command brought
};

/// An optional object that the device refused.
struct ScriptNote {
    core::ObjectAddress address{};
    std::uint32_t abortCode{0};
};

/// Everything acyclic about one slave, one datagram at a time: scripts, AL status and clock reads,
/// mailbox.
class SlaveAgent final : public AcyclicMachine {
public:
    enum class ScriptState : std::uint8_t { Idle, Running, Done, Failed };

    SlaveAgent(const SlaveParams& params, std::uint16_t station, WorkSet& work, std::size_t number);
    SlaveAgent(const SlaveAgent&) = delete;  // its doors know where it is
    SlaveAgent& operator=(const SlaveAgent&) = delete;

    /// rt. Starts a script; it must outlive its run.
    void run(const Script& script) noexcept;
    [[nodiscard]] ScriptState scriptState() const noexcept { return scriptState_; }
    [[nodiscard]] const ScriptFailure& failure() const noexcept { return failure_; }
    /// The step at which the script stopped; nullptr when it did not.
    [[nodiscard]] const Step* failedStep() const noexcept;
    [[nodiscard]] const core::FixedVector<ScriptNote, 16>& notes() const noexcept { return notes_; }

    /// rt. Forgets mailbox counters and what was known of the slave's state.
    void reset() noexcept;
    /// rt. Have the AL status read.
    void wantStatus() noexcept;
    /// rt. Have register 0x092C read.
    void wantDifference() noexcept;
    /// rt. The state bit of the mailbox is set: fetch what lies there.
    void mailboxFull() noexcept;
    /// rt. Look once whether something lies in the mailbox.
    void lookIntoMailbox() noexcept;

    [[nodiscard]] const AlReading& al() const noexcept { return al_; }
    /// The slave answered the last time it was asked for its AL status.
    [[nodiscard]] bool answers() const noexcept { return answers_; }
    [[nodiscard]] bool statusPending() const noexcept { return statusWanted_; }
    /// Magnitude of 0x092C as last read; empty: the slave did not tell.
    [[nodiscard]] const std::optional<core::Duration>& difference() const noexcept {
        return difference_;
    }
    [[nodiscard]] bool differencePending() const noexcept { return differenceWanted_; }
    [[nodiscard]] std::uint16_t station() const noexcept { return station_; }
    [[nodiscard]] const EmergencyRecord& lastEmergency() const noexcept;
    [[nodiscard]] std::uint32_t emergencies() const noexcept;
    /// Outside the cycle. For values of any length while neither script nor user asks; null: the
    /// device has no objects.
    [[nodiscard]] CoeClient* objectsDirectly() noexcept { return coe_ ? &coe_->client : nullptr; }

    bool next(core::HostTime now, Request& request) noexcept override;
    void take(core::HostTime now, const Reply& reply) noexcept override;
    [[nodiscard]] bool busy() const noexcept override;

    /// rt. The dictionary for one of its users: each sees the replies to its own requests only.
    [[nodiscard]] core::ObjectAccess& objects(ObjectUser user) noexcept {
        return doors_[static_cast<std::size_t>(user)];
    }

private:
    class Door final : public core::ObjectAccess {
    public:
        explicit Door(SlaveAgent& agent) noexcept : agent_{agent} {}
        bool startRead(core::ObjectAddress address) noexcept override;
        bool startWrite(core::ObjectAddress address,
                        const core::ObjectValue& value) noexcept override;
        [[nodiscard]] core::ObjectReply reply() const noexcept override { return reply_; }
        void end(const core::ObjectReply& reply) noexcept { reply_ = reply; }

    private:
        template <typename Start>
        bool begin(const Start& start) noexcept;

        SlaveAgent& agent_;
        core::ObjectReply reply_{};
    };

    enum class Job : std::uint8_t { None, Status, Difference, Walk, Register, Command, Mailbox };

    struct Coe {
        Coe(const MailboxPlace& place, const wire::MailboxDescription& description)
            : mailbox{place},
              client{mailbox, description.requestTimeout, description.responseTimeout} {}
        Mailbox mailbox;
        CoeClient client;
    };

    void wake() noexcept { work_.set(number_); }
    bool nextOfScript(core::HostTime now, Request& request) noexcept;
    bool nextOfMailbox(core::HostTime now, Request& request) noexcept;
    void takeStatus(const Reply& reply) noexcept;
    void takeDifference(const Reply& reply) noexcept;
    void takeRegister(const Reply& reply) noexcept;
    void startCommandStep(const CommandStep& step) noexcept;
    void takeCommand(core::HostTime now, const Reply& reply) noexcept;
    void endCommandStep(const ListedCommand& command) noexcept;
    void afterMailbox() noexcept;
    void endStateStep() noexcept;
    void startObjectStep(const ObjectStep& step) noexcept;
    void endObjectStep(const ObjectStep& step) noexcept;
    void stepDone() noexcept;
    void fail(const ScriptFailure& failure) noexcept;
    [[nodiscard]] std::uint32_t whyNoObjects() const noexcept;

    const SlaveParams& params_;
    std::uint16_t station_;
    WorkSet& work_;
    std::size_t number_;
    std::optional<Coe> coe_;
    AlWalker walker_;
    CommandRunner runner_;
    AlReading al_{};
    bool answers_{true};
    std::optional<core::Duration> difference_;

    const Script* script_{nullptr};
    std::size_t position_{0};
    bool stepStarted_{false};
    std::uint8_t registerTries_{0};
    ScriptState scriptState_{ScriptState::Idle};
    ScriptFailure failure_{};
    core::FixedVector<ScriptNote, 16> notes_;

    Job job_{Job::None};
    bool statusWanted_{false};
    std::uint8_t statusTries_{0};
    bool differenceWanted_{false};
    std::uint8_t differenceTries_{0};
    std::array<Door, ObjectUsers> doors_{Door{*this}, Door{*this}};
    Door* asking_{nullptr};  ///< whose SDO is pending; null: that of the script, or none
};

}  // namespace takt::fieldbus::ethercat
