#include "machine_files.hpp"

#include <gtest/gtest.h>

#include "takt_process.hpp"

namespace takt::test {

const std::string Gantry = std::string{TAKT_SOURCE_DIR} + "/samples/03_gantry/machine.xml";

std::string programPath(const std::string& name) {
    return std::string{TAKT_BINARY_DIR} + "/test_programs/" + name + ".so";
}

std::string changedMachine(const std::string& name, const std::string& from,
                           const std::string& to) {
    std::string text = readFile(Gantry);
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << "the base machine no longer has " << from;
    if (at != std::string::npos) text.replace(at, from.size(), to);
    for (std::size_t p = 0; (p = text.find("../devices/", p)) != std::string::npos;) {
        text.replace(p, 3, std::string{TAKT_SOURCE_DIR} + "/samples/");
    }
    const std::string file = freshFolder(name) + "/machine.xml";
    writeFile(file, text);
    return file;
}

}  // namespace takt::test
