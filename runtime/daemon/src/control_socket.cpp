#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <takt/daemon/control_socket.hpp>

namespace takt::daemon {

namespace {

namespace fs = std::filesystem;

constexpr int Backlog = 8;

[[noreturn]] void refuse(const fs::path& path, const std::string& why) {
    throw std::runtime_error{fmt::format("control socket {}: {}", path.string(), why)};
}

fs::path temporaryFolder() {
    return fmt::format("/tmp/takt-{}", ::geteuid());
}

fs::path runtimeFolder() {
    // Before any thread exists, and only read.
    const char* const folder = std::getenv("XDG_RUNTIME_DIR");  // NOLINT(concurrency-mt-unsafe)
    if (folder == nullptr || folder[0] != '/') return {};
    return fs::path{folder} / "takt";
}

/// A folder in which nobody else can put a socket of the same name.
void makeFolder(const fs::path& folder) {
    constexpr mode_t OwnerOnly = 0700;
    if (::mkdir(folder.c_str(), OwnerOnly) != 0 && errno != EEXIST) {
        refuse(folder, std::strerror(errno));
    }
    struct stat info {};
    if (::lstat(folder.c_str(), &info) != 0) refuse(folder, std::strerror(errno));
    const bool ours = S_ISDIR(info.st_mode) && (info.st_uid == ::geteuid() || info.st_uid == 0);
    if (!ours || (info.st_mode & S_IWOTH) != 0) {
        refuse(
            folder,
            "not a folder of this user, or others may write to it; do: remove it or name another "
            "place with --socket");
    }
}

fs::path lockOf(const fs::path& socket) {
    return socket.string() + ".lock";
}

/// \return the locked file, -1 when another process has it
int lockFile(const fs::path& path) {
    constexpr mode_t OwnerAndGroup = 0660;
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, OwnerAndGroup);
    if (file < 0) refuse(path, std::strerror(errno));
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) return file;
    ::close(file);
    return -1;
}

bool isRunning(const fs::path& socket) {
    const int file = ::open(lockOf(socket).c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
    if (file < 0) return errno == EACCES;
    const bool taken = ::flock(file, LOCK_EX | LOCK_NB) != 0;
    ::close(file);
    return taken;
}

}  // namespace

fs::path controlFolder() {
    if (fs::path folder = runtimeFolder(); !folder.empty()) return folder;
    if (::access("/run/takt", W_OK) == 0) return "/run/takt";
    return temporaryFolder();
}

std::vector<fs::path> runningMachines() {
    std::vector<fs::path> sockets;
    for (const fs::path& folder : {runtimeFolder(), fs::path{"/run/takt"}, temporaryFolder()}) {
        std::error_code error;
        if (folder.empty()) continue;
        for (const auto& entry : fs::directory_iterator{folder, error}) {
            const bool live = entry.path().extension() == ".sock" && isRunning(entry.path());
            if (live) sockets.push_back(entry.path());
        }
    }
    std::sort(sockets.begin(), sockets.end());
    return sockets;
}

ControlSocket::ControlSocket(const fs::path& wanted, const std::string& machine) : path_{wanted} {
    if (wanted.empty()) {
        const fs::path folder = controlFolder();
        makeFolder(folder);
        path_ = folder / (machine + ".sock");
    }
    bool locked = tryLock();
    if (!locked && wanted.empty()) {
        path_.replace_filename(fmt::format("{}.{}.sock", machine, ::getpid()));
        locked = tryLock();
    }
    if (!locked) refuse(path_, "another takt is using it; do: name another with --socket");
    try {
        listen();
    } catch (...) {
        if (socket_ >= 0) ::close(socket_);
        ::close(lock_);
        throw;
    }
}

bool ControlSocket::tryLock() {
    lock_ = lockFile(lockOf(path_));
    return lock_ >= 0;
}

void ControlSocket::listen() {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string path = path_.string();
    if (path.size() >= sizeof(address.sun_path)) {
        refuse(path_,
               fmt::format("the path is longer than {} characters", sizeof(address.sun_path) - 1));
    }
    std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
    socket_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (socket_ < 0) refuse(path_, std::strerror(errno));
    // What lies there under our lock was left by a process that is gone; only a socket is removed.
    struct stat info {};
    if (::lstat(path.c_str(), &info) == 0 && S_ISSOCK(info.st_mode)) ::unlink(path.c_str());
    constexpr mode_t NotForOthers = 0117;
    const mode_t before = ::umask(NotForOthers);
    const int bound = ::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address));
    const int cause = errno;
    ::umask(before);
    if (bound != 0) refuse(path_, std::strerror(cause));
    if (::listen(socket_, Backlog) != 0) refuse(path_, std::strerror(errno));
}

ControlSocket::~ControlSocket() {
    ::unlink(path_.c_str());
    ::close(socket_);
    // The lock file stays: removing it would let two processes hold locks of the same name.
    ::close(lock_);
}

Peer peerOf(int connection) noexcept {
    ucred credentials{};
    socklen_t size = sizeof(credentials);
    if (::getsockopt(connection, SOL_SOCKET, SO_PEERCRED, &credentials, &size) != 0) return {};
    Peer peer{.pid = credentials.pid};
    std::array<gid_t, 256> groups{};
    size = sizeof(groups);
    if (::getsockopt(connection, SOL_SOCKET, SO_PEERGROUPS, groups.data(), &size) != 0) size = 0;
    peer.allowed = mayConnect(
        {credentials.uid, credentials.gid},
        std::span<const gid_t>{groups}.first(std::min(size / sizeof(gid_t), groups.size())),
        {::geteuid(), ::getegid()});
    return peer;
}

bool mayConnect(const Identity& other, std::span<const unsigned> groups,
                const Identity& own) noexcept {
    return other.user == own.user || other.user == 0 || other.group == own.group ||
           std::find(groups.begin(), groups.end(), own.group) != groups.end();
}

}  // namespace takt::daemon
