#include <algorithm>
#include <takt/wire/device_description.hpp>

namespace takt::wire {

const ObjectDescription* DeviceDescription::findObject(std::uint16_t index) const noexcept {
    const auto found = std::lower_bound(objects.begin(), objects.end(), index,
                                        [](const ObjectDescription& object, std::uint16_t wanted) {
                                            return object.index < wanted;
                                        });
    return found != objects.end() && found->index == index ? &*found : nullptr;
}

const PdoDescription* DeviceDescription::findPdo(std::uint16_t index) const noexcept {
    for (const auto* list : {&rxPdos, &txPdos}) {
        for (const PdoDescription& pdo : *list) {
            if (pdo.index == index) return &pdo;
        }
    }
    return nullptr;
}

}  // namespace takt::wire
