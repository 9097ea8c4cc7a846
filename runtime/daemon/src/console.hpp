#pragma once

#include <string>
#include <string_view>

namespace takt::daemon {

/// Where a run speaks to a person: lines, and on a terminal one line that is written over. In a
/// pipe the progress is left out.
class Console {
public:
    explicit Console(bool quiet);

    void line(std::string_view text);
    void error(std::string_view text);
    void progress(std::string_view text);

private:
    void clearProgress();

    bool quiet_;
    bool terminal_;
    bool progressShown_{false};
};

}  // namespace takt::daemon
