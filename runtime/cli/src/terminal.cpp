#include "terminal.hpp"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <stdexcept>
#include <string_view>

namespace takt::cli {

namespace {

Key keyOf(std::string_view bytes) {
    if (bytes == "\033[D" || bytes == "\033OD" || bytes == "-" || bytes == "h") return Key::Left;
    if (bytes == "\033[C" || bytes == "\033OC" || bytes == "+" || bytes == "l") return Key::Right;
    if (bytes == "\033[A" || bytes == "\033OA" || bytes == "k") return Key::Up;
    if (bytes == "\033[B" || bytes == "\033OB" || bytes == "j") return Key::Down;
    if (bytes == " ") return Key::Space;
    if (bytes == "q" || bytes == "\003" || bytes == "\004" || bytes == "\033") return Key::Quit;
    return Key::Other;
}

}  // namespace

Terminal::Terminal() {
    if (::tcgetattr(STDIN_FILENO, &before_) != 0) {
        throw std::runtime_error{"jogging needs a terminal with keys"};
    }
    termios raw = before_;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO | ISIG);
    raw.c_cc[VMIN] = 0;
    raw.c_cc[VTIME] = 0;
    ::tcsetattr(STDIN_FILENO, TCSANOW, &raw);
}

Terminal::~Terminal() {
    ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_);
}

std::optional<Key> Terminal::key(std::chrono::milliseconds patience) {
    pollfd wait{STDIN_FILENO, POLLIN, 0};
    if (::poll(&wait, 1, static_cast<int>(patience.count())) <= 0) return std::nullopt;
    std::array<char, 64> buffer{};
    const ssize_t count = ::read(STDIN_FILENO, buffer.data(), buffer.size());
    if (count <= 0) return Key::Quit;
    const std::string_view bytes{buffer.data(), static_cast<std::size_t>(count)};
    // Keys that came together while nobody looked: a stop among them wins, else the first counts.
    if (bytes.find(' ') != std::string_view::npos) return Key::Space;
    if (bytes.find('\003') != std::string_view::npos) return Key::Quit;
    const std::size_t first = bytes[0] == '\033' ? std::size_t{3} : std::size_t{1};
    return keyOf(bytes.substr(0, first));
}

}  // namespace takt::cli
