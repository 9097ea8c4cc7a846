#include <utility>

#include "segment.hpp"

namespace takt::cli {

WireSegment::WireSegment(std::unique_ptr<daemon::BusEnd> end, std::vector<std::string> names)
    : end_{std::move(end)}, tool_{end_->link(), end_->clock()}, names_{std::move(names)} {
    tool_.scan();
}

const std::vector<fieldbus::ethercat::SegmentDevice>& WireSegment::devices() const {
    return tool_.devices();
}

std::string WireSegment::nameOf(std::size_t position) const {
    return position < names_.size() ? names_[position] : std::string{};
}

bool WireSegment::toState(std::size_t position, wire::AlState target) {
    return tool_.toState(position, target);
}

core::ObjectReply WireSegment::upload(std::size_t position, core::ObjectAddress address) {
    return tool_.upload(position, address);
}

core::ObjectReply WireSegment::download(std::size_t position, core::ObjectAddress address,
                                        const core::ObjectValue& value, bool /*force*/) {
    return tool_.download(position, address, value);
}

}  // namespace takt::cli
