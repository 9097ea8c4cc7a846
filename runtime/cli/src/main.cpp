#include <takt/cli/command_line.hpp>

int main(int argc, char** argv) {
    return takt::cli::commandLine(argc, argv);
}
