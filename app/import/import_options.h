#pragma once

namespace app {

/// Decisions that an import may take this way or that.
struct ImportOptions {
    bool strictFork = false;          ///< no picMethod means PIC, as the PolyPIC fork reads it, whatever `apic` says
    bool trustFrictionAngle = false;  ///< friction_angle, which libWetCloth does not read, counts
    bool roundSections = false;       ///< a missing biradius is the radius, not 0.018 cm
    bool vertexSolver = false;        ///< this program's own solver of fabric in place of the published one
    bool legacyThreadCount = true;    ///< halfThickness and fabricThreadCount of 2018 count
};

}  // namespace app
