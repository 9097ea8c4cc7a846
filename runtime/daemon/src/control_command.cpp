#include "control_command.hpp"

#include <array>

namespace takt::daemon {

namespace {

struct OrderInfo {
    std::string_view name;
    OrderTarget target;
};

/// In the order of the enumeration.
constexpr std::array<OrderInfo, OrderCount> Orders{{
    {"heartbeat", OrderTarget::None},
    {"leave", OrderTarget::None},
    {"power-on", OrderTarget::Axis},
    {"power-off", OrderTarget::Axis},
    {"reset", OrderTarget::Axis},
    {"home", OrderTarget::Axis},
    {"inch", OrderTarget::Axis},
    {"halt", OrderTarget::Axis},
    {"stop", OrderTarget::None},
    {"reset-stop", OrderTarget::None},
    {"program-start", OrderTarget::Program},
    {"program-stop", OrderTarget::Program},
    {"program-reset", OrderTarget::Program},
    {"upload", OrderTarget::Device},
    {"download", OrderTarget::Device},
}};

}  // namespace

std::string_view name(Order order) noexcept {
    return Orders[static_cast<std::size_t>(order)].name;
}

std::optional<Order> orderOf(std::string_view name) noexcept {
    for (std::size_t i = 0; i < Orders.size(); ++i) {
        if (Orders[i].name == name) return static_cast<Order>(i);
    }
    return std::nullopt;
}

OrderTarget targetOf(Order order) noexcept {
    return Orders[static_cast<std::size_t>(order)].target;
}

}  // namespace takt::daemon
