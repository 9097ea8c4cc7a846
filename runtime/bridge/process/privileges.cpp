#include "privileges.hpp"

#include <grp.h>
#include <sys/capability.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>

namespace takt::bridge {

namespace {

constexpr uid_t Nobody = 65534;

void must(bool done, const char* what) {
    if (!done) throw std::runtime_error{std::string{what} + ": " + std::strerror(errno)};
}

struct CapDeleter {
    void operator()(cap_t caps) const noexcept { cap_free(caps); }
};

void dropCapabilities() {
    const std::unique_ptr<std::remove_pointer_t<cap_t>, CapDeleter> none{cap_init()};
    must(none && cap_set_proc(none.get()) == 0, "giving up capabilities");
}

/// What a program that is executed could bring back; only where the right to take it away is there.
void emptyBoundingSet() {
    for (int cap = 0; cap_get_bound(cap) >= 0; ++cap) cap_drop_bound(cap);
    cap_reset_ambient();
}

void leaveRoot() {
    if (geteuid() != 0) return;
    must(setgroups(0, nullptr) == 0, "giving up the groups of root");
    must(setresgid(Nobody, Nobody, Nobody) == 0, "giving up the group of root");
    must(setresuid(Nobody, Nobody, Nobody) == 0, "giving up the user root");
}

}  // namespace

void becomeUnprivileged(pid_t parent) {
    emptyBoundingSet();
    leaveRoot();
    dropCapabilities();
    must(prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0, "giving up new privileges");
    // After the change of user, which forgets it.
    must(prctl(PR_SET_PDEATHSIG, SIGKILL) == 0, "following the parent");
    if (getppid() != parent) throw std::runtime_error{"the machine that started this is gone"};
}

}  // namespace takt::bridge
