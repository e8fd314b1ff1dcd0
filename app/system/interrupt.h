#pragma once

namespace app {

/// From here on the first Ctrl-C (or SIGTERM) only sets a mark that the run looks at after each frame; the second one
/// ends the program at once. Files already in place stay whole either way.
void watchForInterrupt();

/// How many times the user asked to stop since watchForInterrupt().
int interruptsSeen();
bool stopWanted();

}  // namespace app
