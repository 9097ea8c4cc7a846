#pragma once

#include <sys/types.h>

namespace takt::bridge {

/// Gives up for good whatever right the process was started with: capabilities, those of root,
/// those that another program could bring. It ends with its parent from now on.
/// \throw std::runtime_error when something could not be given up, or `parent` is gone already
void becomeUnprivileged(pid_t parent);

}  // namespace takt::bridge
