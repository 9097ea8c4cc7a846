#pragma once

#include <string>
#include <vector>

#include "takt_process.hpp"

namespace takt::test {

/// Empty where a user may make user and network namespaces; else how to allow them.
std::string namespacesForbidden();

/// Runs a scenario of segment.sh in namespaces of its own, in the folder `work`.
ProcessResult inNamespaces(const std::string& scenario, const std::string& work,
                           const std::vector<std::string>& more = {});

/// The lines of `text` that contain `part`.
std::vector<std::string> linesWith(const std::string& text, const std::string& part);

}  // namespace takt::test
