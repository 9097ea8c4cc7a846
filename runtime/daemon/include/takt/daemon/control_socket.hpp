#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace takt::daemon {

/// The folder of control sockets: $XDG_RUNTIME_DIR/takt, else /run/takt where it is ours to write,
/// else /tmp/takt-<uid>. May not exist yet.
[[nodiscard]] std::filesystem::path controlFolder();

/// Sockets of machines that run now, in the folders a takt of this user may have chosen.
[[nodiscard]] std::vector<std::filesystem::path> runningMachines();

/// The listening end of a machine's control socket. Belongs to one process at a time: a lock beside
/// it goes with the process, so that the socket of a killed one is taken over.
class ControlSocket {
public:
    /// \param wanted the path the user chose; empty: `<folder>/<machine>.sock`, or with the process
    /// id in
    ///        its name while another takt runs a machine of the same name
    /// \throw std::runtime_error naming path and cause
    ControlSocket(const std::filesystem::path& wanted, const std::string& machine);
    ~ControlSocket();
    ControlSocket(const ControlSocket&) = delete;
    ControlSocket& operator=(const ControlSocket&) = delete;

    [[nodiscard]] int descriptor() const noexcept { return socket_; }
    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

private:
    [[nodiscard]] bool tryLock();
    void listen();

    std::filesystem::path path_;
    int lock_{-1};
    int socket_{-1};
};

/// User and group of one end of a connection.
struct Identity {
    unsigned user{0};
    unsigned group{0};
};
/// \param groups further groups of the other end
[[nodiscard]] bool mayConnect(const Identity& other, std::span<const unsigned> groups,
                              const Identity& own) noexcept;

/// Who is at the other end of a connection.
struct Peer {
    int pid{0};
    bool allowed{false};  ///< this user, root, or a member of this process' group
};
[[nodiscard]] Peer peerOf(int connection) noexcept;

}  // namespace takt::daemon
