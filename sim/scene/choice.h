#pragma once

#include <span>

namespace sim {

/// One word a scene may say for a value of an enumeration. Each enumeration has a function choicesOf(E) beside its
/// describe() that lists them.
template <class E>
struct Choice {
    const char* word;
    E value;
};

/// One word of a list that switches something on.
struct NamedFlag {
    const char* word;
    bool* value;
};

}  // namespace sim
