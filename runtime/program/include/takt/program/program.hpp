#pragma once

#include <cstdint>
#include <takt/program/inspector.hpp>
#include <takt/program/machine.hpp>

namespace takt::program {

/// What a program answers each cycle.
enum class ProgramState : std::uint8_t {
    Running,   ///< call again next cycle
    Finished,  ///< done; it is not called again
    Failed,    ///< stop my axes on their path and end the run with exit code 3
};

/// A motion program: a class of the machine builder's, called once per bus cycle.
///
///     class Pick : public takt::Program {
///         void start(takt::Machine& m) override { x_ = m.axis("X"); }
///         takt::ProgramState cycle(takt::Machine& m) override { …call blocks… }
///     };
///     TAKT_PROGRAM(Pick)
///
/// `start` runs once while the machine is put together, before any frame is sent: ask for the axes
/// there, so that a wrong name refuses the machine. It may allocate. `cycle` runs inside the cycle
/// from the moment all devices are in OP: no allocation, no lock, no file, no endless loop; an
/// exception stops the program's axes on their path. A program never moves anything after `stop`.
class Program {
public:
    Program() = default;
    virtual ~Program() = default;
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    virtual void start(Machine& machine) { static_cast<void>(machine); }
    virtual ProgramState cycle(Machine& machine) = 0;
    /// The run ends or the program is taken off; called once, outside the cycle.
    virtual void stop() {}
    /// Lists what shall be seen from outside; called once after `start`.
    virtual void describe(Inspector& inspector) { static_cast<void>(inspector); }
};

}  // namespace takt::program
