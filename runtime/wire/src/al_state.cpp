#include <array>
#include <takt/wire/al_state.hpp>

namespace takt::wire {

namespace {

template <typename Number>
struct Explanation {
    Number code;
    const char* text;
};

// ETG.1000.6 table 11, each with where to look.
constexpr std::array AlExplanations{
    Explanation<std::uint16_t>{0x0000, "no error"},
    Explanation<std::uint16_t>{0x0001, "unspecified error; look at the device's own display"},
    Explanation<std::uint16_t>{0x0002, "the device is out of memory"},
    Explanation<std::uint16_t>{0x0003,
                               "invalid device setup; modules do not fit the configuration"},
    Explanation<std::uint16_t>{0x0004, "invalid revision; compare ESI file and device"},
    Explanation<std::uint16_t>{0x0006, "EEPROM contents do not match the firmware"},
    Explanation<std::uint16_t>{0x0007, "firmware update failed"},
    Explanation<std::uint16_t>{0x0011, "invalid requested state change; a state was skipped"},
    Explanation<std::uint16_t>{0x0012, "unknown requested state"},
    Explanation<std::uint16_t>{0x0013, "bootstrap is not supported"},
    Explanation<std::uint16_t>{0x0014, "no valid firmware"},
    Explanation<std::uint16_t>{0x0015, "invalid mailbox configuration for BOOT; check SM0 and SM1"},
    Explanation<std::uint16_t>{
        0x0016, "invalid mailbox configuration for PREOP; check SM0 and SM1 against the ESI file"},
    Explanation<std::uint16_t>{0x0017, "invalid SyncManager configuration"},
    Explanation<std::uint16_t>{0x0018, "no valid inputs"},
    Explanation<std::uint16_t>{0x0019, "no valid outputs; process data must be cycling before OP"},
    Explanation<std::uint16_t>{
        0x001A,
        "synchronization error; frames and SYNC0 come in the wrong order or jitter too much"},
    Explanation<std::uint16_t>{0x001B, "SyncManager watchdog; process data stopped coming"},
    Explanation<std::uint16_t>{0x001C, "invalid SyncManager types"},
    Explanation<std::uint16_t>{
        0x001D, "invalid output configuration; SM2 length differs from the mapped outputs"},
    Explanation<std::uint16_t>{
        0x001E, "invalid input configuration; SM3 length differs from the mapped inputs"},
    Explanation<std::uint16_t>{0x001F, "invalid watchdog configuration"},
    Explanation<std::uint16_t>{0x0020, "the device needs a cold start"},
    Explanation<std::uint16_t>{0x0021, "the device needs INIT"},
    Explanation<std::uint16_t>{0x0022, "the device needs PREOP"},
    Explanation<std::uint16_t>{0x0023, "the device needs SAFEOP"},
    Explanation<std::uint16_t>{0x0024, "invalid input mapping; check 1A00h and following"},
    Explanation<std::uint16_t>{0x0025, "invalid output mapping; check 1600h and following"},
    Explanation<std::uint16_t>{0x0026, "inconsistent settings"},
    Explanation<std::uint16_t>{0x0027, "free run is not supported; use DC or SM synchronisation"},
    Explanation<std::uint16_t>{0x0028, "synchronisation is not supported"},
    Explanation<std::uint16_t>{0x0029, "free run needs three-buffer mode"},
    Explanation<std::uint16_t>{0x002A, "background watchdog"},
    Explanation<std::uint16_t>{0x002B, "no valid inputs and outputs"},
    Explanation<std::uint16_t>{0x002C, "fatal synchronisation error; SYNC0 is missing"},
    Explanation<std::uint16_t>{0x002D, "SYNC0 was not received in time"},
    Explanation<std::uint16_t>{0x002E, "cycle time too small"},
    Explanation<std::uint16_t>{
        0x0030, "invalid DC SYNC configuration; check AssignActivate and the cycle time"},
    Explanation<std::uint16_t>{0x0031, "invalid DC latch configuration"},
    Explanation<std::uint16_t>{0x0032, "PLL error; the device's clock is not locked"},
    Explanation<std::uint16_t>{0x0033, "DC SYNC input/output error"},
    Explanation<std::uint16_t>{0x0034, "DC SYNC time-out; too many SYNC0 pulses were missed"},
    Explanation<std::uint16_t>{0x0035, "invalid SYNC cycle time"},
    Explanation<std::uint16_t>{0x0036, "invalid SYNC0 cycle time; use one that the device allows"},
    Explanation<std::uint16_t>{0x0037, "invalid SYNC1 cycle time"},
    Explanation<std::uint16_t>{0x0042, "EoE mailbox error"},
    Explanation<std::uint16_t>{0x0043, "CoE mailbox error"},
    Explanation<std::uint16_t>{0x0044, "FoE mailbox error"},
    Explanation<std::uint16_t>{0x0050, "EEPROM not accessible; it must be handed to the device"},
    Explanation<std::uint16_t>{0x0051, "EEPROM error"},
    Explanation<std::uint16_t>{0x0060, "the device restarted by itself"},
    Explanation<std::uint16_t>{0x0061, "device identification value updated"},
    Explanation<std::uint16_t>{0x0070, "detected modules do not match the configured list"},
};

constexpr std::array AbortExplanations{
    Explanation<std::uint32_t>{0x05030000, "toggle bit not alternated"},
    Explanation<std::uint32_t>{0x05040000, "SDO protocol timed out"},
    Explanation<std::uint32_t>{0x05040001, "command specifier unknown"},
    Explanation<std::uint32_t>{0x05040005, "out of memory"},
    Explanation<std::uint32_t>{0x06010000, "unsupported access to an object"},
    Explanation<std::uint32_t>{0x06010001, "read of a write-only object"},
    Explanation<std::uint32_t>{0x06010002, "write to a read-only object"},
    Explanation<std::uint32_t>{0x06010003, "sub-index not writable while sub-index 0 is not zero"},
    Explanation<std::uint32_t>{0x06010004, "complete access not supported for this object"},
    Explanation<std::uint32_t>{0x06010005, "object longer than the mailbox"},
    Explanation<std::uint32_t>{0x06010006, "object is mapped to an RxPDO, download blocked"},
    Explanation<std::uint32_t>{0x06020000, "object does not exist"},
    Explanation<std::uint32_t>{0x06040041, "object cannot be mapped to a PDO"},
    Explanation<std::uint32_t>{0x06040042, "number and length of mapped objects exceed the PDO"},
    Explanation<std::uint32_t>{0x06040043, "general parameter incompatibility"},
    Explanation<std::uint32_t>{0x06040047, "general internal incompatibility"},
    Explanation<std::uint32_t>{0x06060000, "access failed because of a hardware error"},
    Explanation<std::uint32_t>{0x06070010, "data type or length does not match"},
    Explanation<std::uint32_t>{0x06070012, "data too long"},
    Explanation<std::uint32_t>{0x06070013, "data too short"},
    Explanation<std::uint32_t>{0x06090011, "sub-index does not exist"},
    Explanation<std::uint32_t>{0x06090030, "value out of range"},
    Explanation<std::uint32_t>{0x06090031, "value too high"},
    Explanation<std::uint32_t>{0x06090032, "value too low"},
    Explanation<std::uint32_t>{0x06090033, "module ident list does not match"},
    Explanation<std::uint32_t>{0x06090036, "maximum is less than minimum"},
    Explanation<std::uint32_t>{0x08000000, "general error"},
    Explanation<std::uint32_t>{0x08000020, "data cannot be stored"},
    Explanation<std::uint32_t>{0x08000021, "data cannot be stored because of local control"},
    Explanation<std::uint32_t>{0x08000022, "data cannot be stored in the present device state"},
    Explanation<std::uint32_t>{0x08000023, "no object dictionary"},
};

template <typename Table, typename Number>
const char* find(const Table& table, Number code, const char* otherwise) noexcept {
    for (const auto& row : table) {
        if (row.code == code) return row.text;
    }
    return otherwise;
}

}  // namespace

const char* name(AlState state) noexcept {
    switch (state) {
        case AlState::None:
            return "NONE";
        case AlState::Init:
            return "INIT";
        case AlState::PreOp:
            return "PREOP";
        case AlState::Boot:
            return "BOOT";
        case AlState::SafeOp:
            return "SAFEOP";
        case AlState::Op:
            return "OP";
    }
    return "?";
}

const char* explainAlStatus(std::uint16_t code) noexcept {
    return find(AlExplanations, code,
                code >= 0x8000 ? "vendor specific; see the device's manual"
                               : "not in the standard; see the device's manual");
}

const char* explainAbort(std::uint32_t code) noexcept {
    return find(AbortExplanations, code, "not in the standard; see the device's manual");
}

}  // namespace takt::wire
