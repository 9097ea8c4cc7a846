#pragma once

#include <string>

namespace takt::test {

/// Machine file of the gantry sample.
extern const std::string Gantry;

/// A program library of these tests.
std::string programPath(const std::string& name);

/// The gantry's machine file with one text replaced, in a folder of its own.
std::string changedMachine(const std::string& name, const std::string& from, const std::string& to);

}  // namespace takt::test
