#pragma once

#include <string_view>

namespace app {

/// What this program was built of, and how. Every build looks whether build_info.cpp still says so (write_build_info.cmake).
struct BuildInfo {
    std::string_view commit;    ///< commit of git, with "+changes" behind it where files differ from it; "unknown" where there is no git
    std::string_view compiler;  ///< "GNU 12.2.0"
    std::string_view flags;     ///< flags of the compiler
};
extern const BuildInfo kBuildInfo;

}  // namespace app
