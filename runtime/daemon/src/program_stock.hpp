#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <takt/core/spsc_ring.hpp>
#include <vector>

#include "assembly.hpp"
#include "axes.hpp"
#include "program_host.hpp"

namespace takt::daemon {

/// Fresh instances of programs on their way into the cycle, and old ones on their way out.
///
///     auto problems = stock.prepare(program);      // one thread outside; runs the program's start
///     ProgramHost* fresh = stock.take(program);    // the cycle
///     host.exchange(*fresh, movers); stock.retire(fresh);
///     stock.clear();                               // one thread outside; runs the old one's stop
class ProgramStock {
public:
    static constexpr std::size_t Room = 64;  ///< instances under way, for each program

    /// All must outlive the stock.
    ProgramStock(std::span<const ProgramHost> programs,
                 const std::vector<ProgramFactory>& factories,
                 const config::MachineConfig& machine);
    ~ProgramStock();
    ProgramStock(const ProgramStock&) = delete;
    ProgramStock& operator=(const ProgramStock&) = delete;

    /// \return what is wrong, one sentence each; then there is no new instance
    [[nodiscard]] std::vector<std::string> prepare(std::size_t program);
    /// rt. Null: none is ready.
    [[nodiscard]] ProgramHost* take(std::size_t program) noexcept;
    /// rt. The instance is not used any more.
    void retire(ProgramHost* old) noexcept;
    /// Lets go of what was retired.
    void clear();

    /// The names of what an instance wants watched. Outside the cycle.
    [[nodiscard]] std::vector<std::string> watchNames(std::size_t program,
                                                      std::uint32_t instance) const;

private:
    using Ring = core::SpscRing<ProgramHost*>;

    std::span<const ProgramHost> programs_;
    const std::vector<ProgramFactory>& factories_;
    const config::MachineConfig& machine_;
    std::vector<std::unique_ptr<Ring>> fresh_;  ///< for each program
    Ring retired_;
    mutable std::mutex mutex_;  ///< of the names; never taken in the cycle
    std::vector<std::vector<std::vector<std::string>>> watches_;  ///< by program and instance
};

}  // namespace takt::daemon
