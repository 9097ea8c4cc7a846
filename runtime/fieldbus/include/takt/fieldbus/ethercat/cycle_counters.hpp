#pragma once

#include <cstdint>

namespace takt::fieldbus::ethercat {

/// One process-data group: a datagram (two where LRW is not possible) and its working counters.
struct GroupCounters {
    std::uint16_t expected{0};  ///< sum over LWR and LRD where LRW is not possible
    std::uint16_t lastSeen{0};
    std::uint64_t wrong{0};  ///< replies with another working counter, from SAFEOP on
    std::uint64_t lost{0};   ///< cycles without a reply
};

/// What the cyclic phase has counted since bring-up.
struct CycleCounters {
    std::uint64_t cycles{0};
    std::uint64_t framesSent{0};
    std::uint64_t framesLost{0};       ///< no reply by the deadline
    std::uint64_t framesLate{0};       ///< reply to a frame of an earlier cycle; dropped
    std::uint64_t framesDuplicate{0};  ///< second reply to the same frame; dropped
    std::uint64_t framesMalformed{0};  ///< contradict what was sent; dropped
    std::uint64_t framesForeign{0};    ///< not EtherCAT, or passed no device; dropped
    std::uint64_t sendFailures{0};     ///< the link was down or refused the frames
    std::uint64_t workingCounterErrors{0};
    std::uint64_t emergencies{0};
};

}  // namespace takt::fieldbus::ethercat
