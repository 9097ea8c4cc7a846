#include "command_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include "object_text.hpp"

namespace takt::daemon {

namespace {

template <typename T>
bool parse(const std::string& word, T& value) {
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc{} && end == word.data() + word.size();
}

std::vector<std::string> wordsOf(const std::string& line) {
    std::istringstream text{line};
    std::vector<std::string> words;
    for (std::string word; text >> word;) words.push_back(word);
    return words;
}

/// "0x6065:0 E8030000 force" behind the device; `next` is then behind that.
std::string readObject(const std::vector<std::string>& words, std::size_t& next,
                       ControlCommand& command) {
    if (words.size() <= next || !parseObject(words[next++], command.object))
        return "expected: INDEX:SUBINDEX, for example 0x6065:0";
    if (command.order != Order::Download) return {};
    if (words.size() <= next || !parseBytes(words[next++], command.value))
        return "expected: one to eight bytes in hexadecimal, for example E8030000";
    command.force = words.size() > next && words[next] == "force";
    if (command.force) ++next;
    return {};
}

/// \return what is wrong with the line; empty when it is good
std::string readLine(const std::vector<std::string>& words, const ControlNames& names,
                     TakenCommand& taken) {
    if (words.size() < 2 || !parse(words[0], taken.cycle))
        return "expected: CYCLE ORDER [TARGET] [NUMBERS]";
    const auto order = orderOf(words[1]);
    if (!order) return fmt::format("there is no order '{}'", words[1]);
    taken.command.order = *order;
    std::size_t next = 2;
    if (const OrderTarget target = targetOf(*order); target != OrderTarget::None) {
        const auto& known = namesOf(target, names);
        if (words.size() <= next)
            return fmt::format("the target is missing; allowed: {}", fmt::join(known, ", "));
        const auto found = std::find(known.begin(), known.end(), words[next]);
        if (found == known.end()) {
            return fmt::format("there is no '{}'; allowed: {}", words[next],
                               fmt::join(known, ", "));
        }
        taken.command.target = static_cast<std::uint16_t>(found - known.begin());
        ++next;
    }
    if (*order == Order::Inch) {
        const bool good = words.size() >= next + 2 && parse(words[next], taken.command.distance) &&
                          parse(words[next + 1], taken.command.velocity) &&
                          std::isfinite(taken.command.distance) &&
                          std::isfinite(taken.command.velocity);
        if (!good) return "expected: distance and velocity";
        next += 2;
    }
    if (targetOf(*order) == OrderTarget::Device) {
        if (std::string wrong = readObject(words, next, taken.command); !wrong.empty())
            return wrong;
    }
    return words.size() == next ? std::string{} : fmt::format("'{}' is too much", words[next]);
}

}  // namespace

std::string formatCommand(const TakenCommand& taken, const ControlNames& names) {
    const ControlCommand& command = taken.command;
    std::string line = fmt::format("{} {}", taken.cycle, name(command.order));
    if (const OrderTarget target = targetOf(command.order); target != OrderTarget::None) {
        const auto& known = namesOf(target, names);
        line += " " + (command.target < known.size() ? known[command.target] : std::string{"?"});
    }
    if (command.order == Order::Inch)
        line += fmt::format(" {} {}", command.distance, command.velocity);
    if (targetOf(command.order) == OrderTarget::Device)
        line += fmt::format(" 0x{:04X}:{}", command.object.index, command.object.subindex);
    if (command.order == Order::Download)
        line += fmt::format(" {}{}", formatBytes(command.value), command.force ? " force" : "");
    return line + "\n";
}

std::vector<TakenCommand> readCommands(const std::filesystem::path& file, const ControlNames& names,
                                       std::vector<std::string>& problems) {
    std::vector<TakenCommand> commands;
    std::ifstream input{file};
    if (!input) {
        problems.push_back(fmt::format("{}: cannot be read", file.string()));
        return commands;
    }
    std::size_t number = 0;
    for (std::string line; std::getline(input, line);) {
        ++number;
        const auto words = wordsOf(line);
        if (words.empty() || words[0][0] == '#') continue;
        TakenCommand taken;
        std::string wrong = readLine(words, names, taken);
        const bool backwards =
            wrong.empty() && !commands.empty() && taken.cycle < commands.back().cycle;
        if (backwards)
            wrong =
                fmt::format("cycle {} comes after cycle {}", taken.cycle, commands.back().cycle);
        if (wrong.empty()) {
            commands.push_back(taken);
        } else {
            problems.push_back(fmt::format("{}:{}: {}", file.string(), number, wrong));
        }
    }
    return commands;
}

}  // namespace takt::daemon
