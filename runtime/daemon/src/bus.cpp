#include "bus.hpp"

#include <utility>

namespace takt::daemon {

Bus::Bus(const config::MachineConfig& machine, std::unique_ptr<BusEnd> end,
         record::PcapngWriter* capture)
    : end_{std::move(end)} {
    wire::Link* link = &end_->link();
    if (capture != nullptr) {
        tapped_ = std::make_unique<TappedLink>(*link, *capture);
        link = tapped_.get();
    }
    master_ = std::make_unique<fieldbus::ethercat::Master>(machine.network, *link, end_->clock());
}

}  // namespace takt::daemon
