#pragma once

#include <takt/config/eni_reader.hpp>

#include "esi_values.hpp"

namespace takt::config {

/// Fills in the description of a slave, its assigned PDOs and its DC settings from its <Slave>
/// element and its init commands. \pre slave.listed.commands and objects have been read
void readEniDevice(XmlElement element, EniSlave& slave, const EsiValues& values);

}  // namespace takt::config
