#include <cstdio>
#include <cstring>
#include <string>

#include "scenes.hpp"

/// Prints the routes of the first scenes, planned in either order.
int main(int argc, char** argv) {
    using namespace takt::planner::roadmap;
    constexpr std::size_t Count = 200;
    const bool backwards = argc > 1 && std::strcmp(argv[1], "backwards") == 0;
    std::vector<std::string> texts(Count);
    for (std::size_t i = 0; i < Count; ++i) {
        const std::size_t number = backwards ? Count - 1 - i : i;
        const test::Scene scene = test::randomScene(number + 1, 2 + number % 2);
        texts[number] = test::textOf(planRoute(scene.request(), Obstacles{scene.keepOuts}));
    }
    for (const std::string& text : texts) std::fputs(text.c_str(), stdout);
}
