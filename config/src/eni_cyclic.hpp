#pragma once

#include <takt/config/eni_reader.hpp>

#include "esi_values.hpp"

namespace takt::config {

/// Logical addresses of the mailbox state bits, out of <Master>/<MailboxStates>.
struct MailboxStateArea {
    std::uint32_t start{0};
    std::uint32_t bits{0};
};

/// Reads <ProcessImage>.
void readEniImage(XmlElement config, EniNetwork& network, const EsiValues& values);

/// Reads <Cyclic>. \pre image and slaves have been read
void readEniCyclic(XmlElement config, const MailboxStateArea& mailboxStates, EniNetwork& network,
                   const EsiValues& values);

/// What the FMMUs of the init commands put where, against the cyclic commands and the slaves'
/// shares of the process image: a variable must stand for the bits that the device maps there.
void checkEniMapping(const EniNetwork& network, const EsiValues& values);

}  // namespace takt::config
