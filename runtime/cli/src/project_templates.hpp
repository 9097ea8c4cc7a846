#pragma once

#include <string_view>

/// The files of a new project, as templates with {{placeholders}}.
namespace takt::cli::templates {

extern const std::string_view CMakeLists;
extern const std::string_view Program;
extern const std::string_view TraceTest;
extern const std::string_view CiFile;
extern const std::string_view Readme;
extern const std::string_view GitIgnore;

}  // namespace takt::cli::templates
