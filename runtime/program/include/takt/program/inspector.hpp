#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace takt::program {

/// One value of a program that can be looked at. The program keeps the variable; it must outlive
/// the run.
struct Watch {
    std::string name;
    std::function<std::string()> text;  ///< the present value; outside the cycle
    std::function<double()> number;     ///< rt. the same as a number
    bool pin{false};                    ///< of a block
};

/// The one list of what a program wants seen:
/// `inspector.watch("step", step_); inspector.block("move", move_);`
class Inspector {
public:
    /// \pre `variable` lives as long as the program
    template <typename T>
    requires std::integral<T> || std::floating_point<T> || std::is_enum_v<T>
    void watch(std::string_view name, const T& variable) {
        watches_.push_back({std::string{name},
                            [&variable] {
                                if constexpr (std::is_enum_v<T>) {
                                    return std::to_string(
                                        static_cast<std::underlying_type_t<T>>(variable));
                                } else {
                                    return std::to_string(variable);
                                }
                            },
                            [&variable] { return static_cast<double>(variable); }});
    }

    /// The pins of a block that say how it is: "move.Busy", "move.Error", …
    /// \pre `block` lives as long as the program
    template <typename Block>
    void block(std::string_view name, const Block& block) {
        const auto pin = [&](std::string_view pinName, const auto& value) {
            watch(std::string{name} + "." + std::string{pinName}, value);
            watches_.back().pin = true;
        };
        if constexpr (requires { block.Enable; }) pin("Enable", block.Enable);
        if constexpr (requires { block.Execute; }) pin("Execute", block.Execute);
        if constexpr (requires { block.Status; }) pin("Status", block.Status);
        if constexpr (requires { block.Valid; }) pin("Valid", block.Valid);
        if constexpr (requires { block.Busy; }) pin("Busy", block.Busy);
        if constexpr (requires { block.Active; }) pin("Active", block.Active);
        if constexpr (requires { block.Done; }) pin("Done", block.Done);
        if constexpr (requires { block.CommandAborted; })
            pin("CommandAborted", block.CommandAborted);
        if constexpr (requires { block.Error; }) pin("Error", block.Error);
        if constexpr (requires { block.ErrorID; }) pin("ErrorID", block.ErrorID);
    }

    [[nodiscard]] const std::vector<Watch>& watches() const noexcept { return watches_; }

private:
    std::vector<Watch> watches_;
};

}  // namespace takt::program
