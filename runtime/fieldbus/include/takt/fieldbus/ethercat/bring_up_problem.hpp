#pragma once

#include <string>

namespace takt::fieldbus::ethercat {

/// One thing that keeps the network from the cyclic phase. `text` names the device and is one line.
struct BringUpProblem {
    std::string slave;   ///< name on the network; empty: the network as a whole
    std::string text;    ///< "slave 2 'z': expected vendor 0x…, found 0x…; check …"
    std::string origin;  ///< where the configuration says it, e.g. "machine.xml:12"
};

}  // namespace takt::fieldbus::ethercat
