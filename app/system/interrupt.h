#pragma once

namespace app {

/// Makes the first Ctrl-C (or SIGTERM) from now on set a mark only, which the run looks at after each frame; the second one
/// ends the program at once. Files already in place stay whole either way.
void watchForInterrupt();

/// How many times the user asked to stop since watchForInterrupt().
int interruptsSeen();
bool stopWanted();

}  // namespace app
