#include <takt/axis/axis.hpp>

namespace takt::axis {

/// Stop category 1: the ramp first, then the power goes. Also for an axis whose MC_Power would let
/// go at once: a machine stop is not a reason to coast.
void Axis::machineStop() noexcept {
    if (!view_.machineStop) {
        view_.machineStop = true;
        view_.needsEnableEdge = true;
        stopByProgramLoss();
    }
    if (view_.powerRequested && isStopped()) requestPowerOff();
}

}  // namespace takt::axis
