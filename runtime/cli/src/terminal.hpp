#pragma once

#include <termios.h>

#include <chrono>
#include <optional>

namespace takt::cli {

/// A key as a person means it.
enum class Key : char { Other, Left, Right, Up, Down, Space, Quit };

/// The terminal with keys delivered at once and without echo, for the lifetime of the object; ^C
/// comes as Key::Quit.
class Terminal {
public:
    /// \throw std::runtime_error when stdin is no terminal
    Terminal();
    ~Terminal();
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;

    /// Waits at most `patience` for a key. \return Quit when the terminal is closed
    [[nodiscard]] std::optional<Key> key(std::chrono::milliseconds patience);

private:
    termios before_{};
};

}  // namespace takt::cli
