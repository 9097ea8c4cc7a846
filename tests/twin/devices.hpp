#pragma once

#include <memory>
#include <string>
#include <takt/twin/twin_params.hpp>
#include <takt/wire/device_description.hpp>
#include <vector>

namespace takt::twin::test {

/// A servo drive as its ESI file would describe it: 9 bytes out, 11 bytes in.
std::shared_ptr<wire::DeviceDescription> servoDescription(const std::string& type);

/// `count` drives of a profile in a line, clocks and cables all different.
TwinParams lineOf(std::size_t count, const std::string& profile);

std::vector<std::shared_ptr<const wire::DeviceDescription>> descriptionsFor(
    const TwinParams& params);

}  // namespace takt::twin::test
