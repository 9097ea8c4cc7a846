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
};

/// The one list of what a program wants seen: `inspector.watch("step", step_);`
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

    [[nodiscard]] const std::vector<Watch>& watches() const noexcept { return watches_; }

private:
    std::vector<Watch> watches_;
};

}  // namespace takt::program
