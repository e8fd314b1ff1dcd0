#pragma once

#include <string>

namespace app {

/// The JSON schema (draft 7) of scene files, for editors and other programs: keys, units, ranges, words, values of what is left out and
/// what each means, from the declarations that the reader goes by.
std::string sceneSchema();

/// JSON schema of study files.
std::string studySchema();

}  // namespace app
