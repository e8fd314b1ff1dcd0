#pragma once

#include <fstream>
#include <string>

namespace app {

/// The most memory this process has held at once [MB = 10^6 bytes]; 0 where the system does not say.
inline double peakMemoryMegabytes()
{
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (word == "VmHWM:") {
            double kibibytes = 0.0;
            status >> kibibytes;
            return kibibytes * 1024.0 / 1.0e6;
        }
    return 0.0;
}

}  // namespace app
