#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "remote.hpp"
#include "segment.hpp"

namespace takt::cli {

namespace {

using fieldbus::ethercat::SegmentDevice;

wire::AlState stateOf(const std::string& name) {
    constexpr std::array states{wire::AlState::Init, wire::AlState::PreOp, wire::AlState::Boot,
                                wire::AlState::SafeOp, wire::AlState::Op};
    const auto found = std::find_if(states.begin(), states.end(),
                                    [&name](auto state) { return name == wire::name(state); });
    return found == states.end() ? wire::AlState::None : *found;
}

SegmentDevice deviceOf(const daemon::DeviceReport& report) {
    SegmentDevice device;
    device.position = static_cast<std::uint16_t>(report.position);
    device.station = static_cast<std::uint16_t>(report.station);
    device.identity.vendor = static_cast<std::uint32_t>(report.vendor);
    device.identity.product = static_cast<std::uint32_t>(report.product);
    device.identity.revision = static_cast<std::uint32_t>(report.revision);
    device.order = report.type;
    device.name = report.device;
    device.state = stateOf(report.state);
    device.stateError = report.error;
    device.alStatusCode = static_cast<std::uint16_t>(report.alStatusCode);
    return device;
}

class MachineSegment final : public Segment {
public:
    MachineSegment(const std::filesystem::path& socket, const std::string& who)
        : remote_{{socket, false}, who} {
        reports_ = remote_.network().devices;
        for (const daemon::DeviceReport& report : reports_) devices_.push_back(deviceOf(report));
    }

    [[nodiscard]] const std::vector<SegmentDevice>& devices() const override { return devices_; }
    [[nodiscard]] std::string nameOf(std::size_t position) const override {
        return reports_[position].name;
    }
    [[nodiscard]] std::vector<std::filesystem::path> deviceFiles() const override {
        std::vector<std::filesystem::path> files;
        for (const daemon::DeviceReport& report : reports_) files.emplace_back(report.file);
        std::sort(files.begin(), files.end());
        files.erase(std::unique(files.begin(), files.end()), files.end());
        return files;
    }
    [[nodiscard]] bool inOperation() const noexcept override { return true; }
    bool toState(std::size_t /*position*/, wire::AlState /*target*/) override {
        throw std::runtime_error{
            "a running machine leads its devices itself; do: end it, then name the network with "
            "--interface IF"};
    }
    core::ObjectReply upload(std::size_t position, core::ObjectAddress address) override {
        return ask(requestFor("upload", position, address));
    }
    core::ObjectReply download(std::size_t position, core::ObjectAddress address,
                               const core::ObjectValue& value, bool force) override {
        daemon::ControlRequest request = requestFor("download", position, address);
        for (std::size_t i = 0; i < value.size; ++i)
            request.data += fmt::format("{:02X}", value.bytes[i]);
        request.force = force;
        return ask(request);
    }

private:
    [[nodiscard]] daemon::ControlRequest requestFor(const char* verb, std::size_t position,
                                                    core::ObjectAddress address) const {
        daemon::ControlRequest request;
        request.verb = verb;
        request.device = reports_[position].name;
        request.object = fmt::format("0x{:04X}:{}", address.index, address.subindex);
        return request;
    }
    core::ObjectReply ask(const daemon::ControlRequest& request) {
        const auto answer = remote_.ask(request);
        core::ObjectReply reply{
            core::ObjectState::Done, {}, static_cast<std::uint32_t>(answer->abortCode)};
        if (answer->kind == daemon::ReplyKind::Failed && answer->abortCode != 0) {
            reply.state = core::ObjectState::Failed;
            return reply;
        }
        if (answer->kind != daemon::ReplyKind::Done) throw std::runtime_error{answer->error};
        reply.value = bytesOf(answer->data);
        return reply;
    }
    static core::ObjectValue bytesOf(const std::string& digits) {
        core::ObjectValue value;
        value.size = static_cast<std::uint8_t>(std::min(digits.size() / 2, value.bytes.size()));
        for (std::size_t i = 0; i < value.size; ++i)
            value.bytes[i] =
                static_cast<std::uint8_t>(std::stoul(digits.substr(2 * i, 2), nullptr, 16));
        return value;
    }

    Remote remote_;
    std::vector<daemon::DeviceReport> reports_;
    std::vector<SegmentDevice> devices_;
};

}  // namespace

std::unique_ptr<Segment> segmentOfMachine(const std::filesystem::path& socket,
                                          const std::string& who) {
    return std::make_unique<MachineSegment>(socket, who);
}

}  // namespace takt::cli
