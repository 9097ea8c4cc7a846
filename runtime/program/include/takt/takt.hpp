#pragma once

/// The one header of a motion program.

#include <takt/plcopen/plcopen.hpp>
#include <takt/program/entry.hpp>
#include <takt/program/program.hpp>

namespace takt {

using axis::AxisRef;
using axis::GroupRef;
using program::Inspector;
using program::Machine;
using program::Program;
using program::ProgramState;
using namespace plcopen;  // NOLINT(google-build-using-namespace): programs write takt::MC_Power

}  // namespace takt
