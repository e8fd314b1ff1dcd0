#pragma once

#include <span>

namespace sim {

/// One word a scene may say for a value of an enumeration. Each enumeration has a function choicesOf(E) beside its
/// visitFields() that lists them.
template <class E>
struct Choice {
    const char* word;
    E value;
};

/// A number in whose place a scene may say a word.
struct NumberOrWord {
    double& number;
    const char* word;
    bool& isWord;  ///< the word stands there
};

/// One word of a list that switches something on.
struct NamedFlag {
    const char* word;
    bool* value;
};

}  // namespace sim
