#include "program_stock.hpp"

#include <fmt/format.h>

#include <exception>
#include <utility>

namespace takt::daemon {

namespace {

/// Of 65535 only programs count; the largest one is the operator's.
constexpr std::size_t PortNumbers = 0xFFFE;

std::vector<std::string> namesOf(const ProgramHost& host) {
    std::vector<std::string> names;
    for (const program::Watch& watch : host.watched()) names.push_back(watch.name);
    return names;
}

}  // namespace

ProgramStock::ProgramStock(std::span<const ProgramHost> programs,
                           const std::vector<ProgramFactory>& factories,
                           const config::MachineConfig& machine)
    : programs_{programs},
      factories_{factories},
      machine_{machine},
      retired_{Room * (programs.size() + 1)} {
    for (const ProgramHost& host : programs_) {
        fresh_.push_back(std::make_unique<Ring>(Room));
        watches_.push_back({namesOf(host)});
    }
}

ProgramStock::~ProgramStock() {
    clear();
    for (std::size_t i = 0; i < fresh_.size(); ++i) {
        while (ProgramHost* host = take(i)) delete host;
    }
}

std::vector<std::string> ProgramStock::prepare(std::size_t program) {
    const std::string& name = programs_[program].name();
    const auto failed = [&name](std::string_view why) {
        return std::vector<std::string>{fmt::format("program '{}': {}", name, why)};
    };
    try {
        program::LoadedProgram loaded = factories_[program]();
        if (!loaded.program) return failed(loaded.error);
        std::uint32_t instance = 0;
        {
            const std::lock_guard lock{mutex_};
            instance = static_cast<std::uint32_t>(watches_[program].size());
        }
        // Another number than all before it: an outcome of an old instance's command is not its.
        const std::size_t number = 1 + (program + programs_.size() * instance) % PortNumbers;
        auto host =
            std::make_unique<ProgramHost>(programs_[program], std::move(loaded.program),
                                          machine_.axes.size(), static_cast<std::uint16_t>(number));
        host->setInstance(instance);
        if (auto problems = host->start(machine_); !problems.empty()) return problems;
        {
            const std::lock_guard lock{mutex_};
            watches_[program].push_back(namesOf(*host));
        }
        if (!fresh_[program]->push(host.get())) return failed("too many resets at once");
        static_cast<void>(host.release());
        return {};
    } catch (const std::exception& error) {
        return failed(error.what());
    } catch (...) {
        return failed("its constructor threw");
    }
}

ProgramHost* ProgramStock::take(std::size_t program) noexcept {
    ProgramHost* host = nullptr;
    return fresh_[program]->pop(host) ? host : nullptr;
}

void ProgramStock::retire(ProgramHost* old) noexcept {
    // There is room for all that can be under way; what did not fit would only not be deleted.
    static_cast<void>(retired_.push(old));
}

void ProgramStock::clear() {
    ProgramHost* old = nullptr;
    while (retired_.pop(old)) {
        const std::unique_ptr<ProgramHost> owned{old};
        owned->stop();
    }
}

std::vector<std::string> ProgramStock::watchNames(std::size_t program,
                                                  std::uint32_t instance) const {
    const std::lock_guard lock{mutex_};
    const auto& known = watches_[program];
    return instance < known.size() ? known[instance] : std::vector<std::string>{};
}

}  // namespace takt::daemon
