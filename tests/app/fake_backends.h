#pragma once

#include "app/backends.h"

// A program with a toy in the place of the physics and another in the place of the renderer, so that everything around
// them can be tested in milliseconds.

namespace app::test {

/// What a toy scene file may say: lines "key: number". Variants a, b and c override one number each.
struct ToySettings {
    double duration = 0.05, every = 0.01, dt = 0.004;  ///< [s]
    double speed = 1.0;                                ///< of the one particle, along x [cm/s]
    int stepMilliseconds = 0;                          ///< that a step takes
    int drawMilliseconds = 0, writeMilliseconds = 0;
    int failAtStep = 0;  ///< the step that throws RunError; 0: none
    int shutAtStep = 0;  ///< the step after which its one source has to stop; 0: it has none
    double push =
        0.0;  ///< by liquid on an obstacle "wall" and by a fabric "sheet" on its pins: in step n n times that, along x [dyn]; 0: there are none
    int failAtDrawing = -1;  ///< the frame whose drawing throws
    int failAtWriting = -1;  ///< the frame whose file cannot be written
};

LoadedScene toySetup(const ToySettings& toy);
Backends toyBackends(const ToySettings& toy);

/// The same from files, for a whole program.
Backends toyBackendsFromFiles();

}  // namespace app::test
