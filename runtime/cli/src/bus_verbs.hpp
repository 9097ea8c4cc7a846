#pragma once

#include <string>

#include "tool_bus.hpp"

/// The commands that look at a network and at single devices. Each returns the exit code of the
/// process: 0, or 2 with one line that says what is wrong.
namespace takt::cli {

/// `takt scan`: who is there, and which device file describes it.
int scan(const BusOptions& options);

/// `takt slaves`: one line for each device with its state.
int slaves(const BusOptions& options);

struct StatesOptions {
    BusOptions bus;
    std::string state;  ///< INIT, PREOP, SAFEOP or OP; empty: only show
    std::string slave;  ///< position or name; empty: all
};

/// `takt states`: shows the states of the devices, or leads them to one, with what an AL status
/// code means.
int states(const StatesOptions& options);

struct ObjectOptions {
    BusOptions bus;
    std::string slave;   ///< position or name
    std::string object;  ///< "0x6064" or "0x1018:1"
    std::string type;    ///< "uint16"; empty: as the device file says
    std::string value;   ///< download only
    bool force{false};   ///< download only: also while a program of the running machine runs
};

/// `takt upload`: reads an object of a device.
int upload(const ObjectOptions& options);
/// `takt download`: writes an object of a device.
int download(const ObjectOptions& options);

}  // namespace takt::cli
