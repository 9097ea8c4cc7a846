/// Asks for an axis that no machine has.
#include <takt/takt.hpp>

namespace {

class UnknownAxis : public takt::Program {
public:
    void start(takt::Machine& machine) override { axis_ = machine.axis("Q"); }
    takt::ProgramState cycle(takt::Machine&) override { return takt::ProgramState::Finished; }

private:
    takt::AxisRef axis_;
};

}  // namespace

TAKT_PROGRAM(UnknownAxis)
