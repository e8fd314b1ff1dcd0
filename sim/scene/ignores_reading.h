#pragma once

#include <initializer_list>
#include <string>

namespace sim {

/// What the declarations of settings say for their reader alone: nothing to who lists or writes them.
struct IgnoresReading {
    template <class Action>
    void whenReading(Action)
    {
    }
    void onlySupports(const char*, const char*, std::initializer_list<const char*>, const char*) {}
    void unsupported(const char*, const char*) {}
    void other(const char*, const char*) {}
    void required(const char*, const char*) {}
    void require(bool, const char*, const std::string&) {}
};

}  // namespace sim
