#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace takt::test {

struct SeenReply {
    std::string kind;  ///< "accepted", "refused", …
    std::string why;
};

struct SeenAxis {
    std::uint64_t cycle{0};
    std::string state;
    double actual{0.0};
    bool powered{false};
};

/// A participant of its own in this process: hears a machine and commands it, as anybody could who
/// has the IDL file.
class DdsClient {
public:
    /// \param number how it calls itself; other numbers are other clients
    DdsClient(unsigned domain, std::string machine, std::uint64_t number);
    ~DdsClient();
    DdsClient(const DdsClient&) = delete;
    DdsClient& operator=(const DdsClient&) = delete;

    /// Takes what has come since the last call.
    void listen();

    /// Samples of the machine's status so far, from whichever bridge, and the writer of the last.
    [[nodiscard]] std::uint64_t machineSamples() const { return machineSamples_; }
    [[nodiscard]] std::uint64_t lastWriter() const { return lastWriter_; }
    [[nodiscard]] bool operating() const { return operating_; }
    [[nodiscard]] const std::map<std::string, SeenAxis>& axes() const { return axes_; }
    [[nodiscard]] const std::map<std::uint64_t, std::string>& events() const { return events_; }
    [[nodiscard]] bool heardOf(const std::string& text) const;

    /// A bridge takes commands and answers.
    [[nodiscard]] bool mayCommand() const;
    /// \return the number of the request
    std::uint64_t send(const std::string& order, const std::string& axis = {},
                       double distance = 0.0, double velocity = 0.0);
    /// All answers to a request so far.
    [[nodiscard]] std::vector<SeenReply> replies(std::uint64_t request) const;
    /// Listens until an answer is there that is not "accepted". \return it, or empty when none came
    std::optional<SeenReply> answer(std::uint64_t request, bool alive);

private:
    using Entity = std::int32_t;

    void createReaders();
    void createCommandDoor();
    template <typename Sample, typename Take>
    void take(Entity reader, Take take);

    std::string machine_;
    std::uint64_t number_;
    Entity domain_{0};
    Entity participant_{0};
    Entity machineReader_{0};
    Entity axisReader_{0};
    Entity eventReader_{0};
    Entity replyReader_{0};
    Entity commandWriter_{0};
    std::uint64_t lastRequest_{0};
    std::uint64_t machineSamples_{0};
    std::uint64_t lastWriter_{0};
    bool operating_{false};
    std::map<std::string, SeenAxis> axes_;
    std::map<std::uint64_t, std::string> events_;
    std::map<std::uint64_t, std::vector<SeenReply>> replies_;
};

}  // namespace takt::test
